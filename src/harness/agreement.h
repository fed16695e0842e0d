#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "harness/row.h"
#include "harness/run.h"

namespace squall::harness {

/// Whether the runs of a comparison are the same water.
struct Agreement {
  /// All single-precision strict runs had the same state hash after every frame that at least two of them did, and none
  /// ended in a wrong state where another did not; empty if there was no such frame.
  std::optional<bool> bitwise;
  bool agree = true;                                    ///< false sets the exit code
  std::optional<std::uint64_t> first_difference_frame;  ///< index, from 0
  std::optional<Difference> difference;                 ///< between the two runs, after that frame
  std::string verdict;                                  ///< one sentence
};

/// Largest differences between two states, particle by particle; empty if they are equal. A particle that only one of
/// them has, or that is not finite, counts as infinitely far away.
std::optional<Difference> difference_between(const Particles& a, const Particles& b, double spacing);

/// Compares runs in lock-step. Strict single-precision runs must match bit by bit. Runs on devices that promise no bits
/// are held to a tolerance after the first frame, before chaos (25 1/s in a dam break, docs/physics.md) takes over:
/// each of n sub-steps may add a few roundings of a coordinate as large as the container. The reference backend never
/// takes part. A run that stops early is compared up to and including its last frame; a device that fails leaves no
/// state, so it is named but is no disagreement.
class AgreementCheck {
 public:
  /// Call after each frame of the runs, from the first on; runs that have stopped may stay in the list.
  void after_round(const std::vector<const Run*>& runs);
  Agreement result() const;

 private:
  void compare_bits(const std::vector<const Run*>& strict);
  void compare_failures(const std::vector<const Run*>& strict);
  void compare_by_tolerance(const Run& expected, const Run& run);

  Agreement agreement_;
  std::string first_label_, second_label_;
  std::string failed_in_one_, out_of_tolerance_, stopped_;  ///< parts of the verdict
  std::size_t strict_runs_ = 0, tolerant_runs_ = 0;         ///< most that were compared at once
  int rounds_ = 0;
  int frames_compared_ = 0;  ///< with at least two strict runs
};

/// Largest distance in spacings that rounding explains after one frame of `substeps` sub-steps.
double rounding_tolerance_dx(const Scene& scene, int substeps);

}  // namespace squall::harness
