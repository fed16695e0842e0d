#pragma once

#include <array>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "bench_support/cases.h"
#include "bench_support/work_model.h"

namespace squall::bench {

/// One way to run a case.
struct Variant {
  std::string name;  ///< of rows: "omp/avx2/threads:2"
  std::string backend;
  Settings settings;
  Walk walk;
  int threads = 1;
  bool strict = true;  ///< must end in the bits of all the others
};

/// What the machine can do with the means of a variant, within a working set [bytes], right now.
using BoundsSource = std::function<Bounds(const Variant& variant, std::size_t working_set)>;

/// Rows about solvers, registered with Google Benchmark. Each repetition restores the case's state, measures the
/// bounds, advances one frame and checks what came out; the row's time is that of one sub-step.
class SolverRows {
 public:
  SolverRows(Cases& cases, BoundsSource bounds) : cases_(cases), bounds_(std::move(bounds)) {}

  /// Whole steps, without profiling.
  void add_step(Pressure pressure, Size size, const Variant& variant);
  /// Sort, density and forces. The rows share their profiled frames: the n-th repetition of each is about the n-th.
  void add_stages(Pressure pressure, Size size, const Variant& variant);

  bool failed() const { return failed_; }

 private:
  /// A frame: seconds per sub-step by Stage.
  struct Sample {
    std::array<double, 4> seconds{};
    Bounds bounds;
    int substeps = 0;
    double readback_s = 0.0;  ///< of the frame
    double readback_bytes = 0.0, copied_bytes = 0.0;
    std::string error;
  };
  struct Row {
    Pressure pressure;
    Size size;
    Variant variant;
    Stage stage;
    /// Case and variant: rows of the same means differ by stage alone.
    std::string means() const { return case_name(pressure, size) + "/" + variant.name; }
    std::string name() const { return std::string(to_string(stage)) + "/" + means(); }
  };
  void add_row(Pressure pressure, Size size, const Variant& variant, Stage stage);
  Sample take_sample(const Row& row);
  Sample measure(const Row& row, bool profile);
  Solver& solver_for(const Row& row, bool profile);
  const WorkOf& work_for(const Row& row);

  Cases& cases_;
  BoundsSource bounds_;
  bool failed_ = false;
  std::map<std::string, std::unique_ptr<Solver>> solvers_;  ///< kept: a new one's memory is not in place yet
  std::map<std::string, WorkOf> works_;
  std::map<std::string, std::vector<Sample>> profiled_;
  std::map<std::string, std::size_t> taken_;  ///< of profiled samples, by row
};

}  // namespace squall::bench
