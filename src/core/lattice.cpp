#include <cmath>
#include <numbers>

#include "core/frame_plan.h"
#include "sph_formulas.h"
#include "walls.h"

namespace squall {

namespace {

/// W at distance r with unit support.
double kernel_value(int shape, double r) {
  constexpr double pi = std::numbers::pi;
  const double u = max0(1.0 - r);
  if (shape == SQUALL_POLY6) return 315.0 / (64.0 * pi) * poly6_value(max0(1.0 - r * r));
  if (shape == SQUALL_SPIKY) return 15.0 / pi * spiky_value(u);
  if (shape == SQUALL_BELL) return 315.0 / (8192.0 * pi) * bell_value(bell_left(r * r, 1.0));
  return 8.0 / pi * cubic_value(u, max0(1.0 - 2.0 * r));
}

/// V0 sum W over the lattice points of spacing dx = 1/support_ratio whose layer along the first axis is at least
/// `first_layer`.
double half_lattice_sum(int shape, double support_ratio, int first_layer) {
  const double dx = 1.0 / support_ratio;
  const int reach = static_cast<int>(std::ceil(support_ratio));
  double sum = 0.0;
  for (int i = first_layer; i <= reach; ++i)
    for (int j = -reach; j <= reach; ++j)
      for (int k = -reach; k <= reach; ++k) sum += kernel_value(shape, dx * std::sqrt(double(i * i + j * j + k * k)));
  return sum * dx * dx * dx;
}

Params<double> wall_fractions() {
  Params<double> p{};
  p.thirtieth = 1.0 / 30.0;
  p.fifth = 0.2;
  p.two_hundred_fifty_sixth = 1.0 / 256.0;
  p.one_half = 0.5;
  return p;
}

}  // namespace

double lattice_sum(int kernel_shape, double support_ratio) {
  return half_lattice_sum(kernel_shape, support_ratio, -static_cast<int>(std::ceil(support_ratio)));
}

double wall_shift(int kernel_shape, double support_ratio) {
  const Params<double> p = wall_fractions();
  const double fluid = half_lattice_sum(kernel_shape, support_ratio, 0) / lattice_sum(kernel_shape, support_ratio);
  // Density of the first layer falls with the shift; find where it is 1.
  double low = -0.5, high = support_ratio;
  for (int step = 0; step < 100; ++step) {
    const double shift = 0.5 * (low + high);
    const double q = (0.5 + shift) / support_ratio;
    (fluid + wall_share(&p, kernel_shape, q) > 1.0 ? low : high) = shift;
  }
  return 0.5 * (low + high);
}

}  // namespace squall
