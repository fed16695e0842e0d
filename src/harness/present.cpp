#include "harness/present.h"

#include <algorithm>

#include "core/frame_plan.h"
#include "grid.h"

namespace squall::harness {

/// make_held_groups lists those held longest first.
Present::Present(const Scene& scene, double time_s) : held_(make_held_groups(scene)) {
  const auto held = std::count_if(scene.blocks.begin(), scene.blocks.end(),
                                  [&](const auto& block) { return block.held_until_s.value_or(0.0) > time_s; });
  held_.resize(std::min(held_.size(), static_cast<std::size_t>(held)));
}

bool Present::is_held(std::uint32_t id) const {
  return std::any_of(held_.begin(), held_.end(),
                     [&](const HeldGroup& group) { return id >= group.first_id && id < group.end_id; });
}

bool Present::is_free(const Particles& particles, std::size_t i) const {
  return !is_lost(particles.positions[i].x()) && !is_held(particles.ids[i]);
}

}  // namespace squall::harness
