#include "harness/delivered.h"

#include <fmt/format.h>

namespace squall::harness {

Delivered::Delivered(const PositionsView& view) : frame_(view.frame), error_bound_(view.error_bound()) {
  positions_.reserve(view.count);
  for (std::size_t i = 0; i < view.count; ++i) positions_.push_back(view.position(i));
}

std::string Delivered::problem(const Particles& particles) const {
  if (positions_.size() != particles.size())
    return fmt::format("{} positions for {} particles", positions_.size(), particles.size());
  for (std::size_t i = 0; i < positions_.size(); ++i) {
    // A double state is delivered rounded to single precision.
    const Eigen::Vector3f state = particles.positions[i].cast<float>();
    const Eigen::Vector3f error = (positions_[i] - state).cwiseAbs();
    if (!(error.array() <= error_bound_.array()).all())
      return fmt::format("particle {} is off by {:.3g} m, where {:.3g} m are allowed,", particles.ids[i],
                         error.maxCoeff(), error_bound_.maxCoeff());
  }
  return "";
}

}  // namespace squall::harness
