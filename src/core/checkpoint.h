#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "core/scene.h"
#include "core/settings.h"
#include "core/solver.h"

namespace squall {

/// A run between two frames: what another process, on any backend, needs to go on to the same bits. The container's
/// phase, what is held and what rains follow from the frame's number and the scene.
struct Checkpoint {
  std::string scene_text;  ///< checkpoint_scene_text() of the scene it was saved from
  Pressure pressure = Settings{}.pressure;
  Precision precision = Precision::single_precision;  ///< that the state was computed in
  std::uint64_t seed = 1;                             ///< of the rain
  double energy_in_j = 0.0;  ///< of all particles brought in since the start, which energy drift is measured against
  State state;
};

inline constexpr std::uint32_t k_checkpoint_version = 1;

/// What decides the water of a scene, as text: its keys with every default, the pressure solver, and particles of files
/// by what they are. Left out is what only decides how long and where it is measured: duration_s and gauges.
std::string checkpoint_scene_text(const Scene& scene, Pressure pressure);

/// The bytes of a checkpoint file (docs/checkpoint.md): little-endian on every machine, the same bytes for the same
/// checkpoint. Throws InputError for a state from within a frame.
std::string encode_checkpoint(const Checkpoint& checkpoint);

/// The other way round: a pure function of the bytes. Throws InputError that begins with `path` and says what is wrong
/// for bytes that are no checkpoint, of another version, cut off, damaged, or hold a value no run can have. Allocates
/// no more than the bytes pay for.
Checkpoint decode_checkpoint(std::string_view bytes, const std::string& path);

/// Throws InputError that begins with `path` and names the first key that differs if the checkpoint was not saved from
/// this scene with these settings. Precision and backend may differ.
void check_origin(const Checkpoint& checkpoint, const Scene& scene, const Settings& settings, const std::string& path);

/// Largest size [bytes] of a checkpoint of this scene with so many bytes per number (4, or 8 for double precision).
std::uint64_t largest_checkpoint(const Scene& scene, Pressure pressure, int number_bytes);

}  // namespace squall
