#pragma once

#include <utility>

#include "core/scene.h"

namespace squall::test {

/// A closed tank without anything in it: 0.8 x 0.6 x 0.4 m, dx = 0.05 m, H = 0.1 m.
inline Scene empty_tank() {
  Scene scene;
  scene.name = "tank";
  scene.time.duration_s = 10;
  scene.time.frame_rate_hz = 60;
  scene.fluid.spacing_m = 0.05;
  scene.fluid.viscosity_m2_s = 1e-3;
  scene.container.min_m = {0, 0, 0};
  scene.container.max_m = {0.8, 0.6, 0.4};
  return scene;
}

/// The same with water over the whole floor, `layers` deep.
inline Scene filled_tank(int layers) {
  Scene scene = empty_tank();
  Scene::Block block;
  block.min_m = scene.container.min_m;
  block.max_m = scene.container.max_m;
  block.max_m.y() = layers * scene.fluid.spacing_m;
  scene.blocks.push_back(block);
  return scene;
}

/// The same with these particles (world coordinates) and no others.
inline Scene tank_with(Particles particles) {
  Scene scene = empty_tank();
  scene.particle_files.push_back({"particles.csv", std::move(particles)});
  return scene;
}

/// Rain over the middle of the tank, from just above it.
inline Scene::Rain rain_over_tank(double particles_per_s) {
  Scene::Rain rain;
  rain.particles_per_s = particles_per_s;
  rain.area_min_m = {0.1, 0.1};
  rain.area_max_m = {0.7, 0.3};
  rain.height_m = 0.65;
  rain.max_particles = 1000;
  return rain;
}

}  // namespace squall::test
