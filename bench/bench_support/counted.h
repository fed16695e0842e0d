#pragma once

namespace squall::bench {

/// How often a formula uses each kind of instruction.
struct Operations {
  double add = 0, multiply = 0, fma = 0, square_root = 0, divide = 0;

  double flops() const { return add + multiply + 2 * fma + square_root + divide; }
  friend bool operator==(const Operations&, const Operations&) = default;
  Operations& operator+=(const Operations& other) {
    add += other.add;
    multiply += other.multiply;
    fma += other.fma;
    square_root += other.square_root;
    divide += other.divide;
    return *this;
  }
  friend Operations operator*(double times, Operations operations) {
    return {times * operations.add, times * operations.multiply, times * operations.fma, times * operations.square_root,
            times * operations.divide};
  }
  friend Operations operator+(Operations a, const Operations& b) { return a += b; }
};

/// A number that only counts what is done to it: the formulas of kernels/ are run on it, so that the model of their
/// work is the formulas themselves. Signs and max0 are not counted: they are no floating-point arithmetic, or come for
/// free.
class Counted {
 public:
  explicit Counted(Operations* tally) : tally_(tally) {}
  explicit Counted(int) {}    ///< a constant
  explicit Counted(float) {}  ///< likewise

  friend Counted operator+(Counted a, Counted b) { return count(&Operations::add, a, b); }
  friend Counted operator-(Counted a, Counted b) { return count(&Operations::add, a, b); }
  friend Counted operator*(Counted a, Counted b) { return count(&Operations::multiply, a, b); }
  friend Counted operator/(Counted a, Counted b) { return count(&Operations::divide, a, b); }
  friend Counted operator-(Counted a) { return a; }
  friend Counted fma(Counted a, Counted b, Counted c) { return count(&Operations::fma, a, b, c); }
  friend Counted nfma(Counted a, Counted b, Counted c) { return count(&Operations::fma, a, b, c); }
  friend Counted fms(Counted a, Counted b, Counted c) { return count(&Operations::fma, a, b, c); }
  friend Counted sqrt(Counted a) { return count(&Operations::square_root, a, a); }
  friend Counted max0(Counted a) { return a; }

 private:
  static Counted count(double Operations::*kind, Counted a, Counted b, Counted c = Counted(0)) {
    Operations* tally = a.tally_ ? a.tally_ : b.tally_ ? b.tally_ : c.tally_;
    if (tally) tally->*kind += 1;  // what is made of constants alone is made once
    return Counted(tally);
  }
  Operations* tally_ = nullptr;
};

}  // namespace squall::bench
