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
  /// All strict runs in single precision had the same state hash after every frame that at least two of them did, and
  /// none ended in a wrong state where another did not; those in double precision likewise, among themselves. Empty if
  /// there was no such frame.
  std::optional<bool> bitwise;
  bool agree = true;                                    ///< false sets the exit code
  std::optional<std::uint64_t> first_difference_frame;  ///< index, from 0
  std::optional<Difference> difference;                 ///< between the two runs, after that frame
  std::string verdict;                                  ///< one sentence
};

/// Largest differences between two states, particle by particle; empty if they are equal. A particle that only one of
/// them has, or that is not finite, counts as infinitely far away.
std::optional<Difference> difference_between(const Particles& a, const Particles& b, double spacing);

/// Compares runs in lock-step, each with those of its own precision. Strict runs must match bit by bit. Runs on devices
/// that promise no bits are held to a tolerance after the first frame, before chaos (25 1/s in a dam break,
/// docs/physics.md) takes over: each of n sub-steps may add a few roundings of a coordinate as large as the container.
/// The reference backend never takes part. A run that stops early is compared up to and including its last frame; a
/// device that fails leaves no state, so it is named but is no disagreement.
class AgreementCheck {
 public:
  /// Call after each frame of the runs, from the first on; runs that have stopped may stay in the list.
  void after_round(const std::vector<const Run*>& runs);
  Agreement result() const;

 private:
  /// The strict runs of one precision.
  struct Strict {
    std::optional<bool> bitwise;  ///< as in Agreement
    std::size_t runs = 0;         ///< most that were compared at once
    int frames = 0;               ///< with at least two of them
  };

  void compare_precision(Precision precision, const std::vector<const Run*>& runs, Strict& found);
  void compare_bits(const std::vector<const Run*>& strict, Strict& found);
  void compare_failures(const std::vector<const Run*>& strict, Strict& found);
  void compare_by_tolerance(const Run& expected, const Run& run);
  std::string same_bits_text() const;

  Agreement agreement_;
  Strict single_, double_;
  std::string first_label_, second_label_;
  std::string failed_in_one_, out_of_tolerance_, stopped_;  ///< parts of the verdict
  std::size_t tolerant_runs_ = 0;                           ///< that were compared
  int rounds_ = 0;
};

/// Largest distance in spacings that rounding explains after one frame of `substeps` sub-steps.
double rounding_tolerance_dx(const Scene& scene, int substeps, Precision precision);

}  // namespace squall::harness
