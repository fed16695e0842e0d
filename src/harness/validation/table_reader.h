#pragma once

#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/toml_section.h"

/// How tables of a case file are read; private to the harness.
namespace squall::harness {

/// What the file as a whole is called in messages.
inline constexpr const char* k_whole_case = "the case";

/// One table of the file: reads keys, and refuses those that nobody asked for.
class TableReader {
 public:
  TableReader(const toml::table& table, scene_keys::SectionName name, Places& places)
      : table_(table), name_(std::move(name)), places_(places), keys_(table, name_, places) {
    places_.note(name_, "", table.source().begin);
  }

  template <class Value>
  void required(const char* key, Value& value) {
    known_.insert(key);
    keys_(key, value, scene_keys::KeyRule{true, 0.0, 0.0});
  }
  template <class Value>
  void optional(const char* key, Value& value) {
    known_.insert(key);
    keys_(key, value, scene_keys::KeyRule{});
  }
  /// A number with its range, ends included.
  void number(const char* key, std::optional<double>& value, double low, double high) {
    optional(key, value);
    if (value) check(key, *value, low, high);
  }
  void number(const char* key, double& value, double low, double high) {
    optional(key, value);
    check(key, value, low, high);
  }
  bool has(const char* key) const { return table_.contains(key); }
  const toml::node* node(const char* key) {
    known_.insert(key);
    return table_.get(key);
  }
  /// A table inside this one.
  TableReader inner(const toml::table& table, scene_keys::SectionName name) const {
    return {table, std::move(name), places_};
  }
  void done() const { refuse_unknown_keys(table_, text(), {known_.begin(), known_.end()}, places_); }
  [[noreturn]] void fail(const char* key, const std::string& what) const {
    const toml::node* node = table_.get(key);
    places_.fail(node != nullptr ? node->source().begin : table_.source().begin, what);
  }
  [[noreturn]] void fail_at(const toml::node& node, const std::string& what) const {
    places_.fail(node.source().begin, what);
  }
  std::string text() const { return name_.table == k_whole_case ? k_whole_case : name_.text(); }

 private:
  void check(const char* key, double value, double low, double high) const {
    if (value < low || value > high)
      fail(key, fmt::format("{} = {} in {} is out of range; allowed is {} to {}", key, value, text(), low, high));
  }

  const toml::table& table_;
  scene_keys::SectionName name_;
  Places& places_;
  KeyReader keys_;
  std::set<std::string> known_;
};

/// Names as texts, where each stands in the file.
struct Name {
  std::string text;
  const toml::node* node = nullptr;
};

inline std::vector<Name> names_in(TableReader& reader, const char* key) {
  std::vector<Name> names;
  const toml::node* node = reader.node(key);
  if (node == nullptr) return names;
  const toml::array* array = node->as_array();
  if (array == nullptr) reader.fail(key, fmt::format("{} must be an array of names, not {}", key, type_text(*node)));
  for (const auto& entry : *array) {
    const auto* text = entry.as_string();
    if (text == nullptr) reader.fail_at(entry, fmt::format("{} holds {}; it holds names", key, type_text(entry)));
    names.push_back({text->get(), &entry});
  }
  return names;
}

/// A finite number, whole or not.
inline std::optional<double> number_of(const toml::node& node) {
  if (const auto* integer = node.as_integer()) return static_cast<double>(integer->get());
  const auto* number = node.as_floating_point();
  return number != nullptr && std::isfinite(number->get()) ? std::optional(number->get()) : std::nullopt;
}

}  // namespace squall::harness
