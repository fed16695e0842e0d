#pragma once

#include <rapidcheck.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <ostream>
#include <vector>

#include "core/scene.h"

/// Random scenes. A recipe is what is drawn: small integers, mostly counts of spacings, so that what fails shrinks to a
/// small scene with round numbers. scene_of() makes a valid scene of any recipe.
namespace squall::test {

using Cells = std::array<int, 3>;  ///< in spacings, x y z

struct BlockRecipe {
  Cells low{}, size{};
  Cells velocity{};    ///< tenths of m/s
  int held_ms = 0;     ///< 0: not held
  bool shaken = true;  ///< off the container's lattice, by a quarter of a spacing
};

struct BoxRecipe {
  Cells low{}, size{};
  int until_ms = 0;  ///< 0: for good
};

struct RainRecipe {
  int per_frame = 0;  ///< 0: none
  int wind = 0;       ///< m/s, along x
  int most = 0;       ///< drops
};

struct MotionRecipe {
  Cells displacement{};  ///< tenths of a spacing
  int start_ms = 0;
  int duration_ms = 0;  ///< 0: no motion
};

struct Recipe {
  Cells size{};    ///< of the container
  int origin = 0;  ///< of the container, metres, on every axis
  bool open_top = false;
  int ratio_tenths = 20;      ///< H/dx
  int viscosity_decade = -7;  ///< m^2/s, as a power of ten; -7: none
  int xsph_tenths = 0;        ///< dfsph
  Pressure pressure = Pressure::wcsph;
  std::vector<BlockRecipe> blocks;
  std::vector<BoxRecipe> boxes;
  RainRecipe rain;
  MotionRecipe motion;
  int frames = 0;
};

inline constexpr double k_recipe_spacing = 0.0625;  ///< m; exact in binary, so that printed scenes are round
inline constexpr double k_recipe_frame_rate = 60.0;

inline Eigen::Vector3d metres(const Cells& cells) {
  return Eigen::Vector3d(cells[0], cells[1], cells[2]) * k_recipe_spacing;
}

/// Whether the insides of two cuboids meet.
template <class A, class B>
bool meet(const A& a, const B& b) {
  return (a.min_m.array() < b.max_m.array()).all() && (b.min_m.array() < a.max_m.array()).all();
}

/// `low` moved and `size` cut so that the cuboid lies within the container.
template <class Entry>
void place(const Recipe& recipe, const Cells& low, const Cells& size, double off, Entry& entry) {
  for (int axis = 0; axis < 3; ++axis) {
    const int room = recipe.size[static_cast<std::size_t>(axis)];
    const int from = std::min(low[static_cast<std::size_t>(axis)], room - 1);
    const int to = std::min(from + size[static_cast<std::size_t>(axis)], room);
    entry.min_m[axis] = recipe.origin + from * k_recipe_spacing;
    entry.max_m[axis] = recipe.origin + to * k_recipe_spacing;
    if (to < room) {  // off the lattice where there is room beyond
      entry.min_m[axis] += off;
      entry.max_m[axis] += off;
    }
  }
}

inline void add_blocks(const Recipe& recipe, Scene& scene) {
  for (const BlockRecipe& drawn : recipe.blocks) {
    Scene::Block block;
    place(recipe, drawn.low, drawn.size, drawn.shaken ? 0.25 * k_recipe_spacing : 0.0, block);
    block.velocity_m_s = 0.1 * Eigen::Vector3d(drawn.velocity[0], drawn.velocity[1], drawn.velocity[2]);
    if (drawn.held_ms > 0) block.held_until_s = 1e-3 * drawn.held_ms;
    const bool taken = std::any_of(scene.blocks.begin(), scene.blocks.end(),
                                   [&](const Scene::Block& other) { return meet(block, other); });
    if (!taken) scene.blocks.push_back(block);
  }
}

inline void add_boxes(const Recipe& recipe, Scene& scene) {
  for (const BoxRecipe& drawn : recipe.boxes) {
    Scene::SolidBox box;
    place(recipe, drawn.low, drawn.size, 0.0, box);
    if (drawn.until_ms > 0) box.until_s = 1e-3 * drawn.until_ms;
    scene.boxes.push_back(box);
  }
}

inline void add_rain(const Recipe& recipe, Scene& scene) {
  if (recipe.rain.per_frame == 0 || !recipe.open_top) return;
  Scene::Rain rain;
  rain.particles_per_s = recipe.rain.per_frame * k_recipe_frame_rate;
  rain.area_min_m = {scene.container.min_m.x(), scene.container.min_m.z()};
  rain.area_max_m = {scene.container.max_m.x(), scene.container.max_m.z()};
  rain.height_m = scene.container.max_m.y();
  rain.wind_m_s.x() = recipe.rain.wind;
  rain.max_particles = recipe.rain.most;
  scene.rains.push_back(rain);
}

inline void add_motion(const Recipe& recipe, Scene& scene) {
  if (recipe.motion.duration_ms == 0) return;
  Scene::Motion motion;
  motion.start_s = 1e-3 * recipe.motion.start_ms;
  motion.duration_s = 1e-3 * recipe.motion.duration_ms;
  motion.displacement_m = 0.1 * metres(recipe.motion.displacement);
  scene.container.motions.push_back(motion);
}

/// Blocks that would overlap an earlier one are left out, and rain where there is a lid.
inline Scene scene_of(const Recipe& recipe) {
  Scene scene;
  scene.name = "random";
  scene.time.duration_s = 1.0;
  scene.time.frame_rate_hz = k_recipe_frame_rate;
  scene.fluid.spacing_m = k_recipe_spacing;
  scene.fluid.support_ratio = 0.1 * recipe.ratio_tenths;
  if (recipe.viscosity_decade > -7) scene.fluid.viscosity_m2_s = std::pow(10.0, recipe.viscosity_decade);
  scene.solver.pressure = recipe.pressure;
  if (recipe.pressure == Pressure::dfsph) scene.solver.xsph = 0.1 * recipe.xsph_tenths;
  scene.container.min_m.setConstant(recipe.origin);
  scene.container.max_m = scene.container.min_m + metres(recipe.size);
  scene.container.open_top = recipe.open_top;
  add_blocks(recipe, scene);
  add_boxes(recipe, scene);
  add_rain(recipe, scene);
  add_motion(recipe, scene);
  return scene;
}

/// A counterexample is shown as the scene file it is.
inline void showValue(const Recipe& recipe, std::ostream& out) {
  out << "\n# " << recipe.frames << " frames\n" << print_scene(scene_of(recipe));
}

inline rc::Gen<Cells> cells(int low, int high) { return rc::gen::container<Cells>(rc::gen::inRange(low, high + 1)); }

inline rc::Gen<int> number(int low, int high) { return rc::gen::inRange(low, high + 1); }

}  // namespace squall::test

namespace rc {

template <>
struct Arbitrary<squall::test::BlockRecipe> {
  static Gen<squall::test::BlockRecipe> arbitrary() {
    using namespace squall::test;
    return gen::build<BlockRecipe>(gen::set(&BlockRecipe::low, cells(0, 8)), gen::set(&BlockRecipe::size, cells(1, 8)),
                                   gen::set(&BlockRecipe::velocity, cells(-20, 20)),
                                   gen::set(&BlockRecipe::held_ms, gen::oneOf(gen::just(0), number(0, 60))),
                                   gen::set(&BlockRecipe::shaken));
  }
};

template <>
struct Arbitrary<squall::test::BoxRecipe> {
  static Gen<squall::test::BoxRecipe> arbitrary() {
    using namespace squall::test;
    return gen::build<BoxRecipe>(gen::set(&BoxRecipe::low, cells(0, 10)), gen::set(&BoxRecipe::size, cells(1, 4)),
                                 gen::set(&BoxRecipe::until_ms, gen::oneOf(gen::just(0), number(0, 60))));
  }
};

template <>
struct Arbitrary<squall::test::RainRecipe> {
  static Gen<squall::test::RainRecipe> arbitrary() {
    using namespace squall::test;
    return gen::build<RainRecipe>(gen::set(&RainRecipe::per_frame, number(0, 9)),
                                  gen::set(&RainRecipe::wind, number(-5, 5)),
                                  gen::set(&RainRecipe::most, number(0, 50)));
  }
};

template <>
struct Arbitrary<squall::test::MotionRecipe> {
  static Gen<squall::test::MotionRecipe> arbitrary() {
    using namespace squall::test;
    return gen::build<MotionRecipe>(gen::set(&MotionRecipe::displacement, cells(-20, 20)),
                                    gen::set(&MotionRecipe::start_ms, number(0, 60)),
                                    gen::set(&MotionRecipe::duration_ms, gen::oneOf(gen::just(0), number(50, 500))));
  }
};

template <>
struct Arbitrary<squall::test::Recipe> {
  static Gen<squall::test::Recipe> arbitrary() {
    using namespace squall;
    using namespace squall::test;
    const auto few = [](auto gen, int most) {
      return gen::mapcat(number(0, most), [gen](int count) {
        return gen::container<std::vector<typename decltype(gen)::ValueType>>(static_cast<std::size_t>(count), gen);
      });
    };
    return gen::build<Recipe>(
        gen::set(&Recipe::size, cells(3, 12)), gen::set(&Recipe::origin, gen::element(0, 0, -3, 500)),
        gen::set(&Recipe::open_top), gen::set(&Recipe::ratio_tenths, gen::element(20, 20, 16, 22)),
        gen::set(&Recipe::viscosity_decade, gen::element(-7, -3, -5, -1)),
        gen::set(&Recipe::xsph_tenths, gen::element(0, 0, 1)),
        gen::set(&Recipe::pressure, gen::element(Pressure::wcsph, Pressure::mueller, Pressure::dfsph)),
        gen::set(&Recipe::blocks, few(gen::arbitrary<BlockRecipe>(), 3)),
        gen::set(&Recipe::boxes, few(gen::arbitrary<BoxRecipe>(), 2)), gen::set(&Recipe::rain),
        gen::set(&Recipe::motion), gen::set(&Recipe::frames, number(1, 6)));
  }
};

}  // namespace rc
