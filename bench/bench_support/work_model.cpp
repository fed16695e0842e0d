#include "bench_support/work_model.h"

#include <algorithm>
#include <iterator>
#include <utility>
#include <vector>

#include "grid.h"
#include "sph_formulas.h"

namespace squall::bench {

namespace {

constexpr double k_record = 32, k_id = 4, k_key = 4, k_float = 4, k_entry = 4, k_counter = 4;  // bytes
constexpr double k_coordinates = 3 * k_float;  // of a particle, once more beside its record

struct Apart {
  Counted x, y, z;
};

/// Three differences of coordinates.
Apart difference(Counted a, Counted b) { return {a - b, a - b, a - b}; }

/// Records in canonical order, and where each cell begins.
struct Sorted {
  std::vector<Eigen::Vector3f> positions;
  std::vector<int> cell_start;
};

Sorted sort_by_cell(const Params<float>& p, const Particles& particles) {
  std::vector<int> cells(particles.size());
  Sorted sorted;
  sorted.cell_start.assign(static_cast<std::size_t>(p.cell_count) + 2, 0);
  const auto is_active = [&](std::size_t i) { return !is_lost(static_cast<float>(particles.positions[i].x())); };
  for (std::size_t i = 0; i < particles.size(); ++i) {
    const Eigen::Vector3f x = particles.positions[i].cast<float>();
    cells[i] = is_active(i) ? cell_of(&p, x.x(), x.y(), x.z()) : p.cell_count;
    ++sorted.cell_start[static_cast<std::size_t>(cells[i]) + 1];
  }
  for (std::size_t c = 1; c < sorted.cell_start.size(); ++c) sorted.cell_start[c] += sorted.cell_start[c - 1];
  std::vector<int> next = sorted.cell_start;
  sorted.positions.resize(particles.size());
  for (std::size_t i = 0; i < particles.size(); ++i)
    sorted.positions[static_cast<std::size_t>(next[static_cast<std::size_t>(cells[i])]++)] =
        particles.positions[i].cast<float>();
  return sorted;
}

/// The box around the particles of a block.
struct BlockBox {
  Eigen::Vector3f low, high;
  float squared_distance(const Eigen::Vector3f& x) const { return (x - x.cwiseMax(low).cwiseMin(high)).squaredNorm(); }
};

/// Up to `lanes` particles [begin, end) of a row of cells.
struct Block {
  int begin, end, row, lanes;
};

/// Adds up one block; candidates and entries once each, not yet by lanes.
void count_block(const Params<float>& p, const Sorted& sorted, const Block& block, PairSlots& slots) {
  const auto [begin, end, row, lanes] = block;
  const auto at = [&](int i) -> const Eigen::Vector3f& { return sorted.positions[static_cast<std::size_t>(i)]; };
  BlockBox box{at(begin), at(begin)};
  for (int i = begin + 1; i < end; ++i) box = {box.low.cwiseMin(at(i)), box.high.cwiseMax(at(i))};
  const int low = cell_coordinate(at(begin).x(), p.inverse_edge_x, p.cells_x) - k_x_fineness;
  const int high = cell_coordinate(at(end - 1).x(), p.inverse_edge_x, p.cells_x) + k_x_fineness;
  const int first_x = std::max(low, 0), last_x = std::min(high, p.cells_x - 1);
  const int cell_y = row % p.cells_y, cell_z = row / p.cells_y;
  for (int z = std::max(cell_z - 1, 0); z <= std::min(cell_z + 1, p.cells_z - 1); ++z)
    for (int y = std::max(cell_y - 1, 0); y <= std::min(cell_y + 1, p.cells_y - 1); ++y) {
      const int cell = (z * p.cells_y + y) * p.cells_x;
      const int from = sorted.cell_start[static_cast<std::size_t>(cell + first_x)];
      const int to = sorted.cell_start[static_cast<std::size_t>(cell + last_x + 1)];
      slots.candidates += to - from;
      const int vectors = (to - from + lanes - 1) / lanes;  // the last one partly empty
      slots.culled += vectors * lanes;
      for (int j = from; j < to; ++j) {
        if (!(box.squared_distance(at(j)) < p.list_squared)) continue;
        slots.boxed += 1;
        bool hit = false;
        for (int i = begin; i < end && !hit; ++i) hit = (at(i) - at(j)).squaredNorm() < p.list_squared;
        slots.entries += hit ? 1 : 0;
      }
    }
}

bool keeps_list(const WorkOf& of) { return of.walk.way == Way::box_and_list; }

double list_bytes(const WorkOf& of) { return keeps_list(of) ? k_entry * of.slots.entries : 0; }

/// Where particles are sorted anew: to read a record and write its key, and to clear each thread's counters.
double key_bytes(const WorkOf& of) { return of.particles * (k_record + k_key) + of.cells * k_counter * of.threads; }

Work sort_work(const WorkOf& of) {
  Work work;
  const double scatter = 2 * k_record + 2 * k_id + k_key;        // read both and the key, write both
  const double per_cell = k_counter * (3.0 * of.threads + 1.0);  // sum, read and write each thread's counters
  work.bytes = of.particles * scatter + of.cells * per_cell;
  work.bytes += keeps_list(of) ? of.particles * k_coordinates : key_bytes(of);
  return work;
}

Work density_work(const WorkOf& of) {
  Work work;
  const double tests = keeps_list(of) ? of.slots.culled : of.slots.candidates;
  const double pairs = keeps_list(of) ? of.slots.boxed : of.slots.listed;
  work.operations = of.particles * (tests * candidate_test() + pairs * density_pair(of.pressure));
  work.useful = of.particles * (of.neighbours_mean + 1) * density_pair(of.pressure);
  const double pressure = of.pressure == Pressure::mueller ? k_float : 0;
  const double coordinates = keeps_list(of) ? k_coordinates : 0;
  // Two terms go back into the record's line.
  work.bytes = of.particles * (2 * k_record + coordinates + k_float + pressure + list_bytes(of));
  return work;
}

Work force_work(const WorkOf& of) {
  Work work;
  const Operations pair = force_pair(of.pressure, of.viscous);
  work.operations = of.particles * of.slots.listed * pair;
  if (!keeps_list(of)) work.operations += of.particles * of.slots.candidates * candidate_test();
  work.useful = of.particles * (of.neighbours_mean + 1) * pair;
  const double own = of.pressure == Pressure::mueller ? 2 * k_float : 0;
  work.bytes = of.particles * (2 * k_record + own + list_bytes(of));
  // The next sort's keys: written as the particles move, and the counters cleared.
  if (keeps_list(of)) work.bytes += of.particles * k_key + of.cells * k_counter * of.threads;
  return work;
}

}  // namespace

const char* to_string(Stage stage) {
  switch (stage) {
    case Stage::sort:
      return "sort";
    case Stage::density:
      return "density";
    case Stage::forces:
      return "forces";
    case Stage::step:
      return "step";
  }
  return "?";
}

Operations candidate_test() {
  Operations tally;
  const Counted value(&tally);
  const Apart way = difference(value, value);
  squared_length(way.x, way.y, way.z);
  return tally;
}

Operations density_pair(Pressure pressure) {
  Operations tally;
  const Counted value(&tally);
  const Apart way = difference(value, value);
  Counted term(0);
  if (pressure == Pressure::wcsph) {
    const Counted r = sqrt(squared_length(way.x, way.y, way.z));
    term = cubic_value(remaining_support(r, value), remaining_support(r, value));
  } else {
    term = poly6_value(squared_support_left(way.x, way.y, way.z, value));
  }
  value + term;
  return tally;
}

Operations force_pair(Pressure pressure, bool viscous) {
  Operations tally;
  const Counted value(&tally);
  const Apart way = difference(value, value);
  const Counted r2 = squared_length(way.x, way.y, way.z);
  const Counted r = sqrt(r2);
  const auto add_scaled = [&](Counted s, const Apart& by) {
    fma(s, by.x, value), fma(s, by.y, value), fma(s, by.z, value);
  };
  if (pressure == Pressure::wcsph) {
    const Counted slope = cubic_slope(remaining_support(r, value), remaining_support(r, value));
    const Apart speed = difference(value, value);
    const Counted receding = dot_product(way.x, way.y, way.z, speed.x, speed.y, speed.z);
    Counted shear = value * max0(-receding);
    if (viscous) shear = nfma(value, receding, shear);
    add_scaled(wcsph_pair(r, r2, slope, value + value, value + value, shear, value, value), way);
  } else {
    const Counted u = remaining_support(r, value);
    add_scaled(mueller_pair(r, u, value, value, value, value), way);
    if (viscous) add_scaled(viscosity_laplacian(u) * value, difference(value, value));
  }
  return tally;
}

PairSlots count_pair_slots(const Params<float>& p, const Particles& particles, int lanes, int samples) {
  const Sorted sorted = sort_by_cell(p, particles);
  const int rows = p.cells_y * p.cells_z;
  const auto row_begin = [&](int row) { return sorted.cell_start[static_cast<std::size_t>(row * p.cells_x)]; };
  std::vector<Block> blocks;
  for (int row = 0; row < rows; ++row)
    for (int begin = row_begin(row); begin < row_begin(row + 1); begin += lanes)
      blocks.push_back({begin, std::min(begin + lanes, row_begin(row + 1)), row, lanes});
  const std::size_t stride = std::max<std::size_t>(blocks.size() / static_cast<std::size_t>(std::max(samples, 1)), 1);
  PairSlots slots;
  double counted = 0;
  for (std::size_t b = 0; b < blocks.size(); b += stride) {
    count_block(p, sorted, blocks[b], slots);
    counted += blocks[b].end - blocks[b].begin;
  }
  if (counted == 0) return {};
  slots.entries /= counted;
  slots.culled /= counted;
  slots.candidates *= lanes / counted;
  slots.boxed *= lanes / counted;
  slots.listed = lanes * slots.entries;
  return slots;
}

Work work_of(Stage stage, const WorkOf& of) {
  Work work;
  if (stage == Stage::sort) work = sort_work(of);
  if (stage == Stage::density) work = density_work(of);
  if (stage == Stage::forces) work = force_work(of);
  work.pairs = of.particles * of.neighbours_mean;
  return work;
}

std::size_t working_set(const WorkOf& of) {
  const double coordinates = keeps_list(of) ? k_coordinates : 0;
  const double per_particle = 2 * k_record + 2 * k_id + k_key + coordinates + k_float + list_bytes(of);
  return static_cast<std::size_t>(of.particles * per_particle + of.cells * k_counter * (of.threads + 1.0));
}

LeastTime least_time(const Operations& operations, double bytes, const Bounds& bounds) {
  const double products = operations.multiply + operations.fma;
  const std::pair<double, const char*> needs[] = {
      {operations.fma / bounds.rate(Operation::fma), "fma"},
      {products / bounds.rate(Operation::multiply), "fma and mul"},
      {operations.add / bounds.rate(Operation::add), "add"},
      {(products + operations.add) / bounds.rate(Operation::mixed), "mul+add"},
      {operations.square_root / bounds.rate(Operation::square_root) +
           operations.divide / bounds.rate(Operation::divide),
       "sqrt+div"},
      {bytes / bounds.bytes, "memory"}};
  const auto longest = std::max_element(std::begin(needs), std::end(needs),
                                        [](const auto& a, const auto& b) { return a.first < b.first; });
  return {longest->first, longest->second};
}

}  // namespace squall::bench
