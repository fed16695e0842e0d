#include <fmt/format.h>

#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include "core/errors.h"
#include "core/frame_plan.h"
#include "harness/validation/formulas.h"

/// Linear waves in a box of length L and depth h whose container moves along x: the surface eta = sum over odd n of
/// b_n cos(k_n x), x from the left wall, k_n = n pi/L, with b_n'' + omega_n^2 b_n = 4 a tanh(k_n h)/(n pi), omega_n^2 =
/// g k_n tanh(k_n h), a the container's acceleration (Faltinsen 1978; Ibrahim 2005, ch. 1). Moments of eta give the
/// centre of mass, x_cm = L/2 - (2 L/h) sum b_n/(n pi)^2.
namespace squall::harness {

namespace {

constexpr double k_pi = std::numbers::pi;
constexpr int k_modes = 40;  ///< odd ones: their sum is b_n/n^2, so what is left out is below 1e-4 of it
constexpr double k_step_s = 2e-4;
constexpr double k_longest_s = 100.0;  ///< 160 MB of history

struct Tank {
  double length, depth, gravity;

  double wave_number(int mode) const { return mode * k_pi / length; }
  double omega(int mode) const { return std::sqrt(gravity * wave_number(mode) * std::tanh(wave_number(mode) * depth)); }
};

Tank tank_of(const FormulaRequest& request) {
  const Tank tank{parameter_or(request, "length_m", request.scene.container_size().x()),
                  parameter_or(request, "depth_m", rest_depth(request.scene)), request.scene.gravity_m_s2.norm()};
  if (!(tank.length > 0.0 && tank.depth > 0.0 && tank.gravity > 0.0))
    throw InputError(fmt::format("sloshing needs length, depth and gravity above 0; they are {} m, {} m, {} m/s^2",
                                 tank.length, tank.depth, tank.gravity));
  return tank;
}

/// Amplitudes of all modes on a fine grid of times, grown as far as they are asked for.
class Modes {
 public:
  using Amplitudes = std::array<double, k_modes>;

  Modes(const Scene& scene, const Tank& tank) : scene_(scene), tank_(tank), history_(1, Amplitudes{}) {}

  Amplitudes at(double time_s) {
    if (!(time_s <= k_longest_s))
      throw InputError(fmt::format("formula sloshing is asked for {} s; it goes up to {} s", time_s, k_longest_s));
    const auto index = static_cast<std::size_t>(std::max(0.0, time_s) / k_step_s);
    while (history_.size() < index + 2) grow();
    const double share = std::max(0.0, time_s) / k_step_s - static_cast<double>(index);
    Amplitudes result{};
    for (std::size_t m = 0; m < result.size(); ++m)
      result[m] = history_[index][m] + share * (history_[index + 1][m] - history_[index][m]);
    return result;
  }

 private:
  /// Over a step of constant push each mode is an exact rotation about its rest position.
  void grow() {
    const double begin = k_step_s * static_cast<double>(history_.size() - 1);
    const double acceleration =
        (container_velocity(scene_, begin + k_step_s) - container_velocity(scene_, begin)).x() / k_step_s;
    Amplitudes next{};
    for (std::size_t m = 0; m < next.size(); ++m) {
      const int n = 2 * static_cast<int>(m) + 1;
      const double omega = tank_.omega(n);
      const double push = 4.0 * acceleration * std::tanh(tank_.wave_number(n) * tank_.depth) / (n * k_pi);
      const double rest = push / (omega * omega), from = history_.back()[m] - rest, rate = rates_[m];
      const double c = std::cos(omega * k_step_s), s = std::sin(omega * k_step_s);
      next[m] = rest + from * c + rate / omega * s;
      rates_[m] = rate * c - from * omega * s;
    }
    history_.push_back(next);
  }

  Scene scene_;
  Tank tank_;
  std::vector<Amplitudes> history_;
  Amplitudes rates_{};
};

}  // namespace

Curve make_sloshing(const FormulaRequest& request) {
  const Tank tank = tank_of(request);
  const auto modes = std::make_shared<Modes>(request.scene, tank);
  if (request.quantity == "x_cm_m")
    return [=](double t) {
      const auto b = modes->at(t);
      double sum = 0.0;
      for (int m = 0; m < k_modes; ++m) {
        const double n_pi = (2 * m + 1) * k_pi;
        sum += b[static_cast<std::size_t>(m)] / (n_pi * n_pi);
      }
      return 0.5 * tank.length - 2.0 * tank.length / tank.depth * sum;
    };
  const Scene::Gauge* gauge = gauge_of(request);
  if (gauge == nullptr || gauge->kind != "level") refuse_quantity(request, "sloshing", "x_cm_m or a level gauge");
  const double x = gauge->position_m.x() - request.scene.container.min_m.x();
  return [=](double t) {
    const auto b = modes->at(t);
    double level = tank.depth;
    for (int m = 0; m < k_modes; ++m)
      level += b[static_cast<std::size_t>(m)] * std::cos(tank.wave_number(2 * m + 1) * x);
    return level;
  };
}

Curve make_sloshing_period(const FormulaRequest& request) {
  const Tank tank = tank_of(request);
  const double mode = parameter_or(request, "mode", 1.0);
  if (!(mode >= 1.0 && mode <= 1000.0 && mode == std::floor(mode)))
    throw InputError(fmt::format("mode = {} of formula sloshing_period must be a whole number from 1 to 1000", mode));
  const double period = 2.0 * k_pi / tank.omega(static_cast<int>(mode));
  return [=](double) { return period; };
}

}  // namespace squall::harness
