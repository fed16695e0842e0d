#pragma once

#include <cstdint>
#include <string>

#include "bench_support/bounds.h"
#include "bench_support/counted.h"
#include "core/frame_plan.h"
#include "core/particles.h"
#include "core/settings.h"

namespace squall::bench {

/// Parts of a sub-step that every backend reports.
enum class Stage { sort, density, forces, step };
inline constexpr Stage k_stages[] = {Stage::sort, Stage::density, Stage::forces};
const char* to_string(Stage stage);

/// What a test of a candidate and each pair within reach of a block cost.
Operations candidate_test();
Operations density_pair(Pressure pressure);
Operations force_pair(Pressure pressure, bool viscous);

/// How many pairs the passes of a backend look at in a state, per particle. A block is up to `lanes` consecutive
/// particles of a row of cells in canonical order; its candidates lie in nine ranges of others. A slot is one lane's
/// work on one of them.
struct PairSlots {
  double candidates = 0.0;  ///< slots if each of the block's lanes looks at every candidate
  double culled = 0.0;      ///< slots if each lane holds a candidate against the block's box, range by range
  double boxed = 0.0;       ///< slots of candidates within reach of the box
  double listed = 0.0;      ///< slots of candidates within reach of any lane
  double entries = 0.0;     ///< candidates within reach of any lane, once per block
};
/// Blocks are sampled evenly, about `samples` of them. The particles need not be sorted.
PairSlots count_pair_slots(const Params<float>& params, const Particles& particles, int lanes, int samples);

/// How a backend goes about its pairs, and when about its keys.
enum class Way {
  box_and_list,    ///< omp: density visits what is within reach of the block's box and lists what is within reach of a
                   ///< lane; forces visit the list, and note the keys of the next sort
  every_candidate  ///< opencl: density and forces test every candidate in every lane; the sort finds its keys
};
struct Walk {
  int lanes = 1;
  Way way = Way::box_and_list;
};

/// What a stage of one sub-step has to do. Arithmetic of the pairs alone: what is done once per particle is less than a
/// fiftieth of it.
struct Work {
  Operations operations;
  double bytes = 0.0;  ///< read or written, each array once per pass
  Operations useful;   ///< for the pairs within H alone
  double pairs = 0.0;  ///< within H, self left out
};

struct WorkOf {
  Pressure pressure;
  bool viscous = false;
  Walk walk;
  double particles = 0.0;        ///< active
  double neighbours_mean = 0.0;  ///< within H, self left out
  double cells = 0.0;
  int threads = 1;
  PairSlots slots;
};
Work work_of(Stage stage, const WorkOf& of);

/// Bytes that a sub-step touches: what decides which cache it lives in.
std::size_t working_set(const WorkOf& of);

/// The least time [s] the machine needs for the work, and what needs it.
struct LeastTime {
  double seconds = 0.0;
  std::string bound_by;
};
LeastTime least_time(const Operations& operations, double bytes, const Bounds& bounds);

}  // namespace squall::bench
