#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "core/particles.h"
#include "core/settings.h"

namespace squall {

/// A scene as written in its TOML file (schema 1; docs/scenes.md): SI units, world coordinates. Member names are the
/// file's keys. Every value has passed validate().
struct Scene {
  struct Time {
    double duration_s = 0.0;
    double frame_rate_hz = 60.0;
  };
  struct Fluid {
    double spacing_m = 0.0;      ///< dx, [1e-4, 10]
    double support_ratio = 2.0;  ///< H/dx, [1.2, 4]
    double rest_density_kg_m3 = 1000.0;
    std::optional<double> viscosity_m2_s;
    std::optional<double> surface_tension_n_m;
  };
  struct Solver {
    std::optional<Pressure> pressure;  ///< only to force one
    double density_tolerance = 1e-3;
    double divergence_tolerance = 1e-3;
    int max_iterations = 100;
    double dt_max_s = 0.005;
    double cfl = 0.4;
    double xsph = 0.0;
    double stiffness_m2_s2 = 400.0;
    std::optional<double> speed_of_sound_m_s;  ///< default 10 sqrt(g D)
    double artificial_viscosity = 0.1;
    bool negative_pressure = false;  ///< mueller only: keeps p < 0 (the 2016 report does)
  };
  struct Motion {  ///< of the container; exactly one of displacement and acceleration
    double start_s = 0.0;
    double duration_s = 0.0;
    std::optional<Eigen::Vector3d> displacement_m;     ///< minimum jerk from rest to rest
    std::optional<Eigen::Vector3d> acceleration_m_s2;  ///< constant over the span
  };
  struct Container {
    Eigen::Vector3d min_m = Eigen::Vector3d::Zero();
    Eigen::Vector3d max_m = Eigen::Vector3d::Zero();
    bool open_top = false;
    std::vector<Motion> motions;
  };
  struct SolidBox {
    Eigen::Vector3d min_m, max_m;
    std::optional<double> until_s;  ///< vanishes then
  };
  struct Block {
    Eigen::Vector3d min_m, max_m;
    Eigen::Vector3d velocity_m_s = Eigen::Vector3d::Zero();
    std::optional<double> held_until_s;
  };
  struct ParticleFile {
    std::string file;     ///< as written, relative to the scene file
    Particles particles;  ///< as read, world coordinates; ids are set by initial_particles()
  };
  struct Rain {
    std::optional<double> rate_mm_h;  ///< exactly one of the two rates
    std::optional<double> particles_per_s;
    double drop_diameter_mm = 3.0;           ///< [0.5, 8]; terminal speed and drag only
    Eigen::Vector2d area_min_m, area_max_m;  ///< x and z
    double height_m = 0.0;                   ///< world y of the release, not below the container's top
    Eigen::Vector3d wind_m_s = Eigen::Vector3d::Zero();
    double start_s = 0.0;
    double stop_s = std::numeric_limits<double>::infinity();
    std::int64_t max_particles = 0;
  };
  struct Gauge {
    std::string name;                                      ///< unique; a column of gauges.csv
    Eigen::Vector3d position_m = Eigen::Vector3d::Zero();  ///< at the start: gauges move with the container
    std::string kind;                                      ///< "level", "pressure" or "velocity"
  };

  std::string name;  ///< the file's stem
  Time time;
  Fluid fluid;
  Solver solver;
  Eigen::Vector3d gravity_m_s2{0.0, -9.81, 0.0};
  Container container;
  std::vector<SolidBox> boxes;
  std::vector<Block> blocks;
  std::vector<ParticleFile> particle_files;
  std::vector<Rain> rains;
  std::vector<Gauge> gauges;

  double support_radius() const { return fluid.spacing_m * fluid.support_ratio; }                 ///< H [m]
  double particle_volume() const { return fluid.spacing_m * fluid.spacing_m * fluid.spacing_m; }  ///< dx^3 [m^3]
  double particle_mass() const { return fluid.rest_density_kg_m3 * particle_volume(); }  ///< m = rho0 dx^3 [kg]
  Eigen::Vector3d container_size() const { return container.max_m - container.min_m; }   ///< [m]
  double fluid_depth() const;    ///< D [m]: top of the highest block above the floor, or the container's height
  double fastest_start() const;  ///< largest start velocity of a block or a particle of a file [m/s]
  /// Speed [m/s] the water will reach, > 0: sqrt(g D), that of a fall through half its depth D and of long waves on it;
  /// without gravity that of the fastest start; 1 m/s where nothing moves.
  double reached_speed() const;
  /// c [m/s], > 0: as given, or 10 sqrt(g D); without gravity ten times the fastest start, or 10 m/s if nothing moves.
  double speed_of_sound() const;
};

/// H/dx above which particles come to lie in pairs: the cubic spline pushes hardest at H/3 and less where two are
/// closer still (measured: docs/scenes.md).
inline constexpr double k_pairing_ratio = 2.1;
/// Largest H/dx of dfsph: beyond it pairs gain energy until the water flies apart (measured: docs/scenes.md).
inline constexpr double k_largest_dfsph_ratio = 2.2;

/// Why a pressure solver cannot run a scene's support ratio; empty if it can.
std::string ratio_problem(const Scene& scene, Pressure pressure);

/// Reads a scene file. Throws InputError with file:line:column for what cannot be read, an unknown key (with the
/// nearest valid name), a wrong type, a value out of range (with value and range), a domain without room, a support
/// ratio that its pressure solver cannot run. `instead`: the solver that it will be run with, whatever it says.
Scene load_scene(const std::string& path, std::optional<Pressure> instead = std::nullopt);

/// The same from text; `path` names it in messages and is what particle files are relative to.
Scene parse_scene(const std::string& text, const std::string& path, std::optional<Pressure> instead = std::nullopt);

/// Gives the text of a file; throws InputError if it cannot.
using FileReader = std::function<std::string(const std::string& path)>;

/// The same, with particle files from `read`: for scenes that lie in no folder.
Scene parse_scene(const std::string& text, const std::string& path, const FileReader& read,
                  std::optional<Pressure> instead = std::nullopt);

/// The whole scene, defaults included, as a scene file that load_scene reads back to an equal scene.
std::string print_scene(const Scene& scene);

/// Throws InputError for values that no file position belongs to (a scene built or changed by a program).
void validate(const Scene& scene);

/// Changes the spacing to (shortest edge of the first block)/n (of the container's base, if there is no block) with the
/// n whose particle count is nearest to `particles`, max_particles of rain included; rain keeps its mass per second.
/// Returns the count that resulted.
std::int64_t scale_to_particles(Scene& scene, std::int64_t particles);

/// The particles at the start, ids 0, 1, ... in scene order (blocks, x fastest, then y, z; then particle files),
/// relative to the container. Lattice points of a block that lie inside a box are left out. Throws InputError if two
/// blocks overlap.
Particles initial_particles(const Scene& scene);

/// Initial particles plus what rain may add: the room a solver needs.
std::int64_t particle_capacity(const Scene& scene);

/// What the scene says, however it was written: print_scene() with the particles of a file named by what they are.
std::string identity_text(const Scene& scene);

/// Order-free identity of what the scene says, 16 hex digits: equal for files that mean the same.
std::string scene_hash(const Scene& scene);

}  // namespace squall
