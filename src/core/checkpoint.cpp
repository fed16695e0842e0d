#include "core/checkpoint.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "core/checkpoint_layout.h"
#include "core/mix.h"
#include "core/scene_keys.h"
#include "core/state_hash.h"

namespace squall {

namespace checkpoint_layout {

std::uint64_t checksum(std::string_view bytes) {
  std::uint64_t sum = mix64(bytes.size());
  Taker words(bytes);
  for (std::size_t word = 0; word < bytes.size() / 8; ++word) sum = mix64(sum ^ words.take<std::uint64_t>());
  std::uint64_t tail = 0;
  for (std::size_t i = 0; i < bytes.size() % 8; ++i)
    tail |= std::uint64_t{static_cast<unsigned char>(bytes[bytes.size() / 8 * 8 + i])} << (8 * i);
  return mix64(sum ^ tail);
}

}  // namespace checkpoint_layout

namespace {

using namespace checkpoint_layout;

// Far beyond any scene, and small enough that sizes made of them cannot overflow.
constexpr std::uint64_t k_most_rains = 1 << 16;
constexpr std::uint64_t k_longest_text = 1 << 28;
constexpr std::uint64_t k_last_frame = std::uint64_t{1} << 53;  // frames times seconds are doubles
constexpr std::uint32_t k_last_id = std::uint32_t{1} << 31;     // leaves as many for rain to come
constexpr double k_longest_step_s = 10.0;                       // a frame at the lowest rate there is
constexpr double k_largest_magnitude = 1e30;                    // of speeds, accelerations and energies

bool is_single(double value) {
  return std::bit_cast<std::uint64_t>(static_cast<double>(static_cast<float>(value))) ==
         std::bit_cast<std::uint64_t>(value);
}

bool is_single(const Particles& particles) {
  const auto all_axes = [](const Eigen::Vector3d& v) {
    return is_single(v.x()) && is_single(v.y()) && is_single(v.z());
  };
  return std::all_of(particles.positions.begin(), particles.positions.end(), all_axes) &&
         std::all_of(particles.velocities.begin(), particles.velocities.end(), all_axes) &&
         std::all_of(particles.pressures.begin(), particles.pressures.end(),
                     [](double pressure) { return is_single(pressure); });
}

template <class Number>
void put_particles(std::string& bytes, const Particles& particles) {
  for (const std::uint32_t id : particles.ids) put(bytes, id);
  for (const auto* vectors : {&particles.positions, &particles.velocities})
    for (const Eigen::Vector3d& vector : *vectors)
      for (int axis = 0; axis < 3; ++axis) put(bytes, static_cast<Number>(vector[axis]));
  for (std::size_t i = 0; i < particles.size(); ++i)
    put(bytes, particles.pressures.empty() ? Number{0} : static_cast<Number>(particles.pressures[i]));
}

template <class Number>
Particles take_particles(Taker& taker, std::size_t count) {
  Particles particles;
  particles.ids.resize(count);
  particles.positions.resize(count);
  particles.velocities.resize(count);
  particles.pressures.resize(count);
  for (auto& id : particles.ids) id = taker.take<std::uint32_t>();
  for (auto* vectors : {&particles.positions, &particles.velocities})
    for (Eigen::Vector3d& vector : *vectors)
      for (int axis = 0; axis < 3; ++axis) vector[axis] = static_cast<double>(taker.take<Number>());
  for (auto& pressure : particles.pressures) pressure = static_cast<double>(taker.take<Number>());
  return particles;
}

/// Reads what encode_checkpoint() wrote, and trusts none of it.
class Decoder {
 public:
  Decoder(std::string_view bytes, const std::string& path) : bytes_(bytes), path_(path), taker_(bytes) {}

  Checkpoint decode() {
    check_preamble();
    check_sizes();
    Checkpoint checkpoint;
    checkpoint.pressure = static_cast<Pressure>(one_of("pressure solver", 3));
    checkpoint.precision = static_cast<Precision>(one_of("precision", 2));
    checkpoint.seed = taker_.take<std::uint64_t>();
    take_clock(checkpoint.state.clock);
    checkpoint.energy_in_j = number("energy", -k_largest_magnitude, k_largest_magnitude);
    for (std::uint64_t rain = 0; rain < rains_; ++rain)
      checkpoint.state.clock.rained.push_back(integer<std::int64_t>("drops", 0, std::int64_t{1} << 31));
    checkpoint.scene_text = taker_.take_text(text_);
    const auto count = static_cast<std::size_t>(particles_);
    checkpoint.state.particles =
        number_bytes_ == 4 ? take_particles<float>(taker_, count) : take_particles<double>(taker_, count);
    check_ids(checkpoint.state);
    return checkpoint;
  }

 private:
  [[noreturn]] void fail(const std::string& what) const { throw InputError(path_ + ": " + what); }

  /// The only part that all versions share.
  void check_preamble() {
    if (bytes_.empty()) fail("is empty; a run that was killed leaves its last whole checkpoint, not this");
    if (!bytes_.starts_with(k_magic.substr(0, bytes_.size())))
      fail("is no squall checkpoint; --restart takes a file that --checkpoint wrote");
    if (bytes_.size() < k_preamble_bytes) fail_cut("at least " + std::to_string(k_preamble_bytes));
    taker_.take_text(k_magic.size());
    const auto version = taker_.take<std::uint32_t>();
    if (version != k_checkpoint_version)
      fail("is a checkpoint of version " + std::to_string(version) + "; this squall reads version " +
           std::to_string(k_checkpoint_version) + ": use the squall that wrote it, or start over");
    number_bytes_ = taker_.take<std::uint32_t>();
    const auto length = taker_.take<std::uint64_t>();
    if (bytes_.size() < length) fail_cut(std::to_string(length));
    if (bytes_.size() > length)
      fail("has " + std::to_string(bytes_.size()) + " bytes where a checkpoint of " + std::to_string(length) +
           " should end; something was added to it");
    if (length < k_header_bytes + k_checksum_bytes)
      fail("is damaged: its length, " + std::to_string(length) + " bytes, is too short for its header");
  }

  [[noreturn]] void fail_cut(const std::string& expected) const {
    fail("is cut off: it has " + std::to_string(bytes_.size()) + " of " + expected + " bytes; use another checkpoint");
  }

  /// Before anything is believed or allocated: the checksum, and that the counts make the length.
  void check_sizes() {
    const std::string_view content = bytes_.substr(0, bytes_.size() - k_checksum_bytes);
    const auto stored = Taker(bytes_.substr(content.size())).take<std::uint64_t>();
    if (const auto found = checksum(content); found != stored)
      fail("is damaged: its checksum is " + hash_text(stored) + ", its content gives " + hash_text(found) +
           "; use another checkpoint");
    if (number_bytes_ != 4 && number_bytes_ != 8)
      fail("is damaged: numbers of " + std::to_string(number_bytes_) + " bytes; there are 4 and 8");
    particles_ = integer<std::uint64_t>("particles", 0, scene_keys::k_max_particles);
    rains_ = integer<std::uint32_t>("rains", 0, k_most_rains);
    text_ = integer<std::uint32_t>("bytes of scene", 0, k_longest_text);
    const std::uint64_t expected = file_bytes(particles_, rains_, text_, number_bytes_);
    if (expected != bytes_.size())
      fail("is damaged: " + std::to_string(particles_) + " particles, " + std::to_string(rains_) + " rains and " +
           std::to_string(text_) + " bytes of scene need " + std::to_string(expected) + " bytes, it has " +
           std::to_string(bytes_.size()));
  }

  void take_clock(Clock& clock) {
    clock.frame = integer<std::uint64_t>("frames", 0, k_last_frame);
    clock.previous_substeps = integer<std::int32_t>("sub-steps", 0, k_max_substeps);
    clock.next_id = integer<std::uint32_t>("next id", 0, k_last_id);
    clock.previous_dt = number("time step", 0.0, k_longest_step_s);
    clock.max_speed = number("largest speed", 0.0, k_largest_magnitude);
    clock.max_acceleration = number("largest acceleration", 0.0, k_largest_magnitude);
  }

  void check_ids(const State& state) const {
    for (const std::uint32_t id : state.particles.ids)
      if (id >= state.clock.next_id)
        fail("is damaged: it has a particle " + std::to_string(id) + ", though the next to come is " +
             std::to_string(state.clock.next_id));
  }

  std::uint32_t one_of(const char* what, std::uint32_t count) { return integer<std::uint32_t>(what, 0, count - 1); }
  template <class Integer, class Limit>
  Integer integer(const char* what, Integer least, Limit most) {
    const auto value = taker_.take<Integer>();
    if (value < least || value > static_cast<Integer>(most)) fail_value(what, std::to_string(value));
    return value;
  }
  double number(const char* what, double least, double most) {
    const auto value = taker_.take<double>();
    if (!(value >= least && value <= most)) fail_value(what, scene_keys::number_text(value));
    return value;
  }
  [[noreturn]] void fail_value(const char* what, const std::string& value) const {
    fail(std::string("is damaged: no run has ") + what + " = " + value);
  }

  std::string_view bytes_;
  const std::string& path_;
  Taker taker_;
  std::uint32_t number_bytes_ = 0;
  std::uint64_t particles_ = 0, rains_ = 0, text_ = 0;
};

}  // namespace

std::string encode_checkpoint(const Checkpoint& checkpoint) {
  const Particles& particles = checkpoint.state.particles;
  const Clock& clock = checkpoint.state.clock;
  if (clock.substep != 0)
    throw InputError("a checkpoint holds a run between two frames, and sub-step " + std::to_string(clock.substep) +
                     " of one is done; advance() to its end first");
  const std::uint32_t number_bytes = is_single(particles) ? 4 : 8;
  const std::uint64_t length =
      file_bytes(particles.size(), clock.rained.size(), checkpoint.scene_text.size(), number_bytes);
  std::string bytes;
  bytes.reserve(length);
  bytes += k_magic;
  put(bytes, k_checkpoint_version);
  put(bytes, number_bytes);
  put(bytes, length);
  put(bytes, std::uint64_t{particles.size()});
  put(bytes, static_cast<std::uint32_t>(clock.rained.size()));
  put(bytes, static_cast<std::uint32_t>(checkpoint.scene_text.size()));
  put(bytes, static_cast<std::uint32_t>(checkpoint.pressure));
  put(bytes, static_cast<std::uint32_t>(checkpoint.precision));
  put(bytes, checkpoint.seed);
  put(bytes, clock.frame);
  put(bytes, static_cast<std::int32_t>(clock.previous_substeps));
  put(bytes, clock.next_id);
  put(bytes, clock.previous_dt);
  put(bytes, clock.max_speed);
  put(bytes, clock.max_acceleration);
  put(bytes, checkpoint.energy_in_j);
  for (const std::int64_t drops : clock.rained) put(bytes, drops);
  bytes += checkpoint.scene_text;
  if (number_bytes == 4)
    put_particles<float>(bytes, particles);
  else
    put_particles<double>(bytes, particles);
  put(bytes, checksum(bytes));
  return bytes;
}

Checkpoint decode_checkpoint(std::string_view bytes, const std::string& path) { return Decoder(bytes, path).decode(); }

std::uint64_t largest_checkpoint(const Scene& scene, Pressure pressure, int number_bytes) {
  return file_bytes(static_cast<std::uint64_t>(particle_capacity(scene)), scene.rains.size(),
                    checkpoint_scene_text(scene, pressure).size(), static_cast<std::uint64_t>(number_bytes));
}

}  // namespace squall
