#include "core/toml_section.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/errors.h"
#include "core/nearest_name.h"

namespace squall {
namespace {

/// Unique per key: a section's text holds no newline.
std::string place_name(const scene_keys::SectionName& section, const std::string& key) {
  return section.text() + "\n" + key;
}

bool is_before(const toml::source_position& a, const toml::source_position& b) {
  return a.line != b.line ? a.line < b.line : a.column < b.column;
}

}  // namespace

void Places::note(const scene_keys::SectionName& section, const std::string& key,
                  const toml::source_position& position) {
  positions_[place_name(section, key)] = position;
}

std::string Places::operator()(const scene_keys::SectionName& section, const std::string& key) const {
  for (const std::string& name : {place_name(section, key), place_name(section, "")})
    if (const auto found = positions_.find(name); found != positions_.end())
      return path_ + ":" + std::to_string(found->second.line) + ":" + std::to_string(found->second.column) + ": ";
  return path_ + ": ";
}

void Places::fail(const toml::source_position& position, const std::string& what) const {
  throw InputError(path_ + ":" + std::to_string(position.line) + ":" + std::to_string(position.column) + ": " + what);
}

void refuse_unknown_keys(const toml::table& table, const std::string& where, const std::vector<std::string>& names,
                         const Places& places) {
  // A table iterates by name; the first mistake in the file is the one to report.
  const toml::key* first = nullptr;
  for (auto&& [key, node] : table) {
    const bool known = std::find(names.begin(), names.end(), key.str()) != names.end();
    if (!known && (first == nullptr || is_before(key.source().begin, first->source().begin))) first = &key;
  }
  if (first == nullptr) return;
  const std::string name(first->str());
  places.fail(first->source().begin,
              "unknown key '" + name + "' in " + where + "; did you mean '" + nearest_name(name, names) + "'?");
}

std::string type_text(const toml::node& node) {
  switch (node.type()) {
    case toml::node_type::table:
      return "a table";
    case toml::node_type::array:
      return node.is_array_of_tables() ? "an array of tables" : "an array";
    case toml::node_type::string:
      return "a string";
    case toml::node_type::integer:
      return "an integer";
    case toml::node_type::floating_point:
      return "a number";
    case toml::node_type::boolean:
      return "a boolean";
    default:
      return "a date or time";
  }
}

const toml::node* KeyReader::find(const char* key, bool required) {
  const toml::node* node = table_.get(key);
  if (node != nullptr) {
    places_.note(section_, key, node->source().begin);
  } else if (required) {
    throw InputError(places_(section_, "") + "key " + key + " is missing in " + section_.text());
  }
  return node;
}

void KeyReader::fail_type(const char* key, const toml::node& node, const std::string& wanted) const {
  places_.fail(node.source().begin,
               std::string(key) + " in " + section_.text() + " must be " + wanted + ", not " + type_text(node));
}

void KeyReader::read(const char* key, const toml::node& node, double& value) const {
  if (const auto* integer = node.as_integer()) {
    value = static_cast<double>(integer->get());
    return;
  }
  const auto* number = node.as_floating_point();
  if (number == nullptr) fail_type(key, node, "a number");
  if (!std::isfinite(number->get()))
    places_.fail(node.source().begin, std::string(key) + " = " + scene_keys::number_text(number->get()) + " in " +
                                          section_.text() + " must be a finite number");
  value = number->get() + 0.0;  // -0 becomes 0: scenes that mean the same are the same
}

void KeyReader::read(const char* key, const toml::node& node, std::int64_t& value) const {
  const auto* integer = node.as_integer();
  if (integer == nullptr) fail_type(key, node, "an integer");
  value = integer->get();
}

void KeyReader::read(const char* key, const toml::node& node, int& value) const {
  std::int64_t wide = 0;
  read(key, node, wide);
  if (wide < std::numeric_limits<int>::min() || wide > std::numeric_limits<int>::max())
    places_.fail(node.source().begin,
                 std::string(key) + " = " + std::to_string(wide) + " in " + section_.text() + " is out of range");
  value = static_cast<int>(wide);
}

void KeyReader::read(const char* key, const toml::node& node, bool& value) const {
  const auto* boolean = node.as_boolean();
  if (boolean == nullptr) fail_type(key, node, "true or false");
  value = boolean->get();
}

void KeyReader::read(const char* key, const toml::node& node, std::string& value) const {
  const auto* text = node.as_string();
  if (text == nullptr) fail_type(key, node, "a string");
  value = text->get();
}

void KeyReader::read(const char* key, const toml::node& node, Pressure& value) const {
  std::string text;
  read(key, node, text);
  try {
    value = pressure_from_text(text);
  } catch (const InputError& error) {
    places_.fail(node.source().begin, error.what());
  }
}

}  // namespace squall
