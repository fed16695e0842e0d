#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

// toml++ is private to core.
#include <toml++/toml.h>

#include "core/scene_keys.h"

namespace squall {

/// Where the sections and keys of a file were written.
class Places {
 public:
  explicit Places(std::string path) : path_(std::move(path)) {}

  /// An empty key notes the section itself.
  void note(const scene_keys::SectionName& section, const std::string& key, const toml::source_position& position);

  /// "file:line:column: " of a key, or of its section if the key is not written, or of the file.
  std::string operator()(const scene_keys::SectionName& section, const std::string& key) const;

  /// Throws InputError that begins with file:line:column.
  [[noreturn]] void fail(const toml::source_position& position, const std::string& what) const;

 private:
  std::string path_;
  std::map<std::string, toml::source_position> positions_;
};

/// Throws InputError for a key that is none of `names`, naming the nearest.
void refuse_unknown_keys(const toml::table& table, const std::string& where, const std::vector<std::string>& names,
                         const Places& places);

/// "an integer", "a string", ...: for messages about wrong types.
std::string type_text(const toml::node& node);

/// Reads the keys of one table into a section of the scene and notes where they are. Throws InputError for a missing
/// key or a wrong type.
class KeyReader {
 public:
  KeyReader(const toml::table& table, scene_keys::SectionName section, Places& places)
      : table_(table), section_(std::move(section)), places_(places) {}

  template <class Value>
  void operator()(const char* key, Value& value, scene_keys::KeyRule rule) {
    if (const toml::node* node = find(key, rule.required)) read(key, *node, value);
  }
  template <class Value>
  void operator()(const char* key, std::optional<Value>& value, scene_keys::KeyRule rule) {
    if (const toml::node* node = find(key, rule.required)) read(key, *node, value.emplace());
  }

 private:
  const toml::node* find(const char* key, bool required);
  [[noreturn]] void fail_type(const char* key, const toml::node& node, const std::string& wanted) const;

  void read(const char* key, const toml::node& node, double& value) const;
  void read(const char* key, const toml::node& node, std::int64_t& value) const;
  void read(const char* key, const toml::node& node, int& value) const;
  void read(const char* key, const toml::node& node, bool& value) const;
  void read(const char* key, const toml::node& node, std::string& value) const;
  void read(const char* key, const toml::node& node, Pressure& value) const;
  template <int size>
  void read(const char* key, const toml::node& node, Eigen::Matrix<double, size, 1>& value) const {
    const toml::array* array = node.as_array();
    if (array == nullptr) fail_type(key, node, "an array of " + std::to_string(size) + " numbers");
    if (array->size() != static_cast<std::size_t>(size))
      places_.fail(node.source().begin, std::string(key) + " in " + section_.text() + " must have " +
                                            std::to_string(size) + " numbers, not " + std::to_string(array->size()));
    for (int axis = 0; axis < size; ++axis) read(key, (*array)[static_cast<std::size_t>(axis)], value[axis]);
  }

  const toml::table& table_;
  scene_keys::SectionName section_;
  Places& places_;
};

}  // namespace squall
