#pragma once

#include <cstdint>

#include "core/frame_plan.h"
#include "core/particles.h"
#include "core/scene.h"

namespace squall {

inline constexpr double k_standard_gravity = 9.80665;  ///< m/s^2: what terminal speeds are measured under

/// Terminal speed [m/s] of a drop in still air: v = 9.65 - 10.3 exp(-0.6 D), D in mm, [0.5, 8] (Atlas, Srivastava,
/// Sekhon 1973, Rev. Geophys. 11:1); within 2 % of Gunn & Kinzer 1949.
double terminal_speed(double drop_diameter_mm);

/// Particles per second that a rain emits: as given, or its mm/h over its area in particles of dx^3.
double particles_per_second(const Scene& scene, const Scene::Rain& rain);

/// Drops of a rain due by the start of frame `frame`: floor(rate frame / frame_rate), counted from the frame start_s
/// falls into to the one stop_s falls into, in integers; at most max_particles.
std::int64_t drops_due(const Scene& scene, const Scene::Rain& rain, std::uint64_t frame);

/// The drops that join at the start of frame clock.frame: a pure function of (seed, rain, drop number). Positions
/// relative to the container; velocities half a previous sub-step behind, as the leap-frog needs them. Advances
/// clock.rained and next_id.
Particles release_drops(const Scene& scene, std::uint64_t seed, Clock& clock);

}  // namespace squall
