#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <string_view>

#include "core/mix.h"
#include "core/scene.h"
#include "core/scene_keys.h"
#include "core/state_hash.h"

namespace squall {
namespace scene_keys {

std::string number_text(double value) {
  std::array<char, 32> buffer;
  const auto [end, error] = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  return {buffer.data(), end};
}

}  // namespace scene_keys

namespace {

using scene_keys::SectionName;

/// In TOML a number without point or exponent is an integer; the keys are floats, so they are written as such.
std::string float_text(double value) {
  std::string text = scene_keys::number_text(value);
  if (text.find_first_of(".en") == std::string::npos) text += ".0";
  return text;
}

std::string quoted(const std::string& text) {
  constexpr std::string_view k_digits = "0123456789ABCDEF";
  std::string result = "\"";
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      result += '\\';
      result += c;
    } else if (code < 0x20 || code == 0x7f) {
      result += "\\u00";
      result += k_digits[code >> 4];
      result += k_digits[code & 15];
    } else {
      result += c;
    }
  }
  return result + "\"";
}

template <int size>
std::string value_text(const Eigen::Matrix<double, size, 1>& vector) {
  std::string text = "[";
  for (int axis = 0; axis < size; ++axis) text += (axis == 0 ? "" : ", ") + float_text(vector[axis]);
  return text + "]";
}
std::string value_text(double value) { return float_text(value); }
std::string value_text(std::int64_t value) { return std::to_string(value); }
std::string value_text(int value) { return std::to_string(value); }
std::string value_text(bool value) { return value ? "true" : "false"; }
std::string value_text(const std::string& value) { return quoted(value); }
std::string value_text(Pressure value) { return quoted(to_string(value)); }

/// Writes the keys of a section; what is not set (an empty optional, an end that never comes) is left out.
class KeyPrinter {
 public:
  explicit KeyPrinter(std::string& text) : text_(text) {}

  template <class Value>
  void operator()(const char* key, const Value& value, scene_keys::KeyRule) {
    print(key, value_text(value));
  }
  template <class Value>
  void operator()(const char* key, const std::optional<Value>& value, scene_keys::KeyRule rule) {
    if (value) (*this)(key, *value, rule);
  }
  void operator()(const char* key, double value, scene_keys::KeyRule) {
    if (std::isfinite(value)) print(key, value_text(value));
  }

 private:
  void print(const char* key, const std::string& value) { text_ += std::string(key) + " = " + value + "\n"; }

  std::string& text_;
};

std::string header_text(const SectionName& section) {
  return section.index == 0 ? "[" + section.table + "]" : "[[" + section.table + "]]";
}

std::uint64_t text_hash(std::string_view text) {
  std::uint64_t hash = 0xcbf29ce484222325u;  // FNV-1a
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
  return mix64(hash);
}

std::uint64_t particles_hash(const Particles& particles) {
  std::uint64_t hash = mix64(particles.positions.size());
  for (std::size_t i = 0; i < particles.positions.size(); ++i)
    for (const Eigen::Vector3d* vector : {&particles.positions[i], &particles.velocities[i]})
      for (int axis = 0; axis < 3; ++axis) hash = mix64(hash ^ std::bit_cast<std::uint64_t>((*vector)[axis]));
  return hash;
}

}  // namespace

std::string print_scene(const Scene& scene) {
  std::string text = "schema = 1\n";
  scene_keys::visit_sections(scene, [&](const SectionName& name, const auto& section) {
    text += "\n" + header_text(name) + "\n";
    scene_keys::visit_keys(section, KeyPrinter(text));
  });
  return text;
}

std::string identity_text(const Scene& scene) {
  // A particle file counts by what is in it, not by where it lies.
  Scene nameless = scene;
  for (Scene::ParticleFile& particle_file : nameless.particle_files)
    particle_file.file = hash_text(particles_hash(particle_file.particles));
  return print_scene(nameless);
}

std::string scene_hash(const Scene& scene) { return hash_text(text_hash(identity_text(scene))); }

}  // namespace squall
