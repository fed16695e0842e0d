#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "core/solver.h"

namespace squall::harness {

/// Hash of everything that continues a run: particles in their order with all their numbers, and the clock. Equal
/// hashes mean that two runs are the same to the last bit, now and from now on.
std::uint64_t exact_hash(const State& state);

/// In what two states of one scene differ.
struct StateDifference {
  std::uint32_t particle = 0;    ///< lowest id that differs
  std::string what;              ///< of that particle: "position", "velocity", "pressure", "place in the order", ...
  std::size_t particles = 0;     ///< how many differ
  double max_position_dx = 0.0;  ///< in spacings; infinite for a particle that only one of them has
  double max_velocity = 0.0;     ///< m/s
};

/// Compares bit by bit, particle by particle, and their order. Empty if equal.
std::optional<StateDifference> compare_states(const State& a, const State& b, double spacing);

/// Where two runs part.
struct FirstDifference {
  std::uint64_t frame = 0;  ///< index, from 0
  int substep = 0;          ///< of that frame, from 0
  StateDifference state;    ///< after that sub-step
  /// False: from the state before the frame both do the same now. Then the run depends on what its state does not hold:
  /// a race, or memory that was not written. `state` is the difference after the whole frame.
  bool found_again = true;
};

/// Restores both to the state before a frame whose end differs, and goes through its sub-steps side by side. Empty if
/// the frame ends equally now.
std::optional<FirstDifference> locate_difference(Solver& a, Solver& b, const State& before);

}  // namespace squall::harness
