#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "bench_support/work_model.h"
#include "core/solver.h"

namespace squall::bench {

/// How much time a benchmark may take: smoke only shows that everything runs.
enum class Effort { smoke, quick, full };

/// How many particles: a column of 2 n^3, each split into k^3 once the column is collapsing. Of a particle at rest on a
/// wall, more than two layers of parts would come to lie in one place: k is 1 or 2.
struct Size {
  int layers, split;
  std::int64_t particles() const { return std::int64_t{2} * layers * layers * layers * split * split * split; }
};
/// 11,664, 93,312 and, with full effort, 1,024,000.
std::vector<Size> sizes_for(Effort effort);

/// A state to measure: scenes/collapse.toml 0.2 s after its start, where the front runs along the floor, and what one
/// frame from there must give.
struct Case {
  Scene scene;
  Pressure pressure = Pressure::wcsph;
  Size size{};
  State state;
  std::uint64_t end_hash = 0;  ///< after one frame
  std::int64_t active = 0;
  double neighbours_mean = 0.0;
  double density_error_mean = 0.0;
  Params<float> params{};
};

/// Names a case in rows: "wcsph/11664".
std::string case_name(Pressure pressure, Size size);

/// Splits every particle into k^3 on a lattice of spacing/k around it, kept `margin` inside the container. Ids count
/// from 0.
Particles split_particles(const Particles& particles, int k, double spacing, const Eigen::Vector3d& container,
                          double margin);

/// Makes cases when they are first asked for and keeps them.
class Cases {
 public:
  explicit Cases(Effort effort) : effort_(effort) {}
  const Case& get(Pressure pressure, Size size);
  Effort effort() const { return effort_; }

 private:
  Effort effort_;
  std::map<std::pair<Pressure, std::int64_t>, std::unique_ptr<Case>> cases_;
};

}  // namespace squall::bench
