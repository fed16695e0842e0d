#pragma once

#include <cstddef>
#include <vector>

#include "core/particles.h"
#include "core/scene.h"
#include "params.h"

namespace squall::harness {

/// Which particles of a state are water that moves: neither lost nor held in a block at that moment.
class Present {
 public:
  /// `time_s` [s] from the start.
  Present(const Scene& scene, double time_s);

  bool is_held(std::uint32_t id) const;
  /// Moves: neither held nor lost.
  bool is_free(const Particles& particles, std::size_t i) const;

 private:
  std::vector<HeldGroup> held_;
};

}  // namespace squall::harness
