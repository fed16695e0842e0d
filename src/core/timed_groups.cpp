#include <algorithm>
#include <limits>

#include "core/fill.h"
#include "core/frame_plan.h"
#include "core/smoothing_kernels.h"
#include "core/timed_groups.h"

namespace squall {

namespace {

/// Faces of a solid box as a wall of the fluid: shifted inwards, but never by more than a quarter of its thickness.
void shifted_faces(const Box<double>& box, double shift, double* low, double* high) {
  for (int axis = 0; axis < 3; ++axis) {
    const double inset = std::min(shift, 0.25 * (box.solid_max[axis] - box.solid_min[axis]));
    low[axis] = box.solid_min[axis] + inset;
    high[axis] = box.solid_max[axis] - inset;
  }
}

double end_of(const std::optional<double>& until_s) {
  return until_s.value_or(std::numeric_limits<double>::infinity());
}

}  // namespace

std::vector<std::size_t> boxes_by_end(const Scene& scene) {
  std::vector<std::size_t> order(scene.boxes.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return end_of(scene.boxes[a].until_s) > end_of(scene.boxes[b].until_s);
  });
  return order;
}

std::vector<Box<double>> make_boxes(const Scene& scene, Pressure pressure) {
  const double dx = scene.fluid.spacing_m;
  const double density_shift = dx * wall_shift(density_kernel(pressure), scene.fluid.support_ratio);
  const double force_shift = dx * wall_shift(force_kernel(pressure), scene.fluid.support_ratio);
  std::vector<Box<double>> boxes;
  for (const std::size_t index : boxes_by_end(scene)) {
    Box<double> box{};
    for (int axis = 0; axis < 3; ++axis) {
      box.solid_min[axis] = scene.boxes[index].min_m[axis] - scene.container.min_m[axis];
      box.solid_max[axis] = scene.boxes[index].max_m[axis] - scene.container.min_m[axis];
    }
    shifted_faces(box, density_shift, box.density_min, box.density_max);
    shifted_faces(box, force_shift, box.force_min, box.force_max);
    boxes.push_back(box);
  }
  return boxes;
}

std::vector<double> box_ends(const Scene& scene) {
  std::vector<double> ends;
  for (const std::size_t index : boxes_by_end(scene)) ends.push_back(end_of(scene.boxes[index].until_s));
  return ends;
}

namespace {

std::vector<std::size_t> held_blocks_by_end(const Scene& scene) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < scene.blocks.size(); ++i)
    if (scene.blocks[i].held_until_s) order.push_back(i);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return *scene.blocks[a].held_until_s > *scene.blocks[b].held_until_s;
  });
  return order;
}

}  // namespace

std::vector<HeldGroup> make_held_groups(const Scene& scene) {
  std::vector<HeldGroup> by_block;  // initial_particles() numbers the blocks' particles in their order
  std::uint32_t next_id = 0;
  for (const auto& block : scene.blocks) {
    const auto count = static_cast<std::uint32_t>(block_points(scene, block));
    by_block.push_back({next_id, next_id + count});
    next_id += count;
  }
  std::vector<HeldGroup> groups;
  for (const std::size_t index : held_blocks_by_end(scene)) groups.push_back(by_block[index]);
  return groups;
}

std::vector<double> held_ends(const Scene& scene) {
  std::vector<double> ends;
  for (const std::size_t index : held_blocks_by_end(scene)) ends.push_back(*scene.blocks[index].held_until_s);
  return ends;
}

}  // namespace squall
