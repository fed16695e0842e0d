#pragma once

#include <Eigen/Core>

#include <cstdint>
#include <string>
#include <vector>

#include "core/particles.h"
#include "core/positions_view.h"

namespace squall::harness {

/// A copy of positions that a solver delivered, to be held against a state.
class Delivered {
 public:
  explicit Delivered(const PositionsView& view);

  std::uint64_t frame() const { return frame_; }  ///< PositionsView::frame

  /// What differs from the state by more than the view's error bound allows; empty if nothing does.
  std::string problem(const Particles& particles) const;

 private:
  std::uint64_t frame_;
  Eigen::Vector3f error_bound_;  ///< m
  std::vector<Eigen::Vector3f> positions_;
};

}  // namespace squall::harness
