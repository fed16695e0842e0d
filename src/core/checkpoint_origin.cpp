#include <algorithm>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "core/checkpoint.h"

namespace squall {

namespace {

/// The keys of a printed scene in their order, "[fluid] spacing_m", and of the second block "[[block]] 2 min_m", and
/// what they are set to.
struct Entries {
  std::vector<std::string> keys;
  std::map<std::string, std::string> values;

  std::string value(const std::string& key) const {
    const auto found = values.find(key);
    return found == values.end() ? "not set" : found->second;
  }
};

Entries entries_of(std::string_view text) {
  Entries entries;
  std::string section, header;
  for (int repeats = 0; !text.empty();) {
    const std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(text.size(), line.size() + 1));
    if (line.starts_with('[')) {
      repeats = header == line ? repeats + 1 : 1;
      header = line;
      section = header + " " + (repeats > 1 ? std::to_string(repeats) + " " : "");
    } else if (const auto equals = line.find(" = "); equals != std::string_view::npos) {
      entries.keys.push_back(section + std::string(line.substr(0, equals)));
      entries.values.emplace(entries.keys.back(), line.substr(equals + 3));
    }
  }
  return entries;
}

/// "[fluid] spacing_m is 0.05 there and 0.04 here": the first key of either that differs.
std::string first_difference(std::string_view there, std::string_view here) {
  const Entries saved = entries_of(there), given = entries_of(here);
  for (const auto* keys : {&saved.keys, &given.keys})
    for (const std::string& key : *keys)
      if (saved.value(key) != given.value(key))
        return key + " is " + saved.value(key) + " there and " + given.value(key) + " here";
  return "their keys come in another order";
}

}  // namespace

std::string checkpoint_scene_text(const Scene& scene, Pressure pressure) {
  Scene water = scene;
  water.time.duration_s = 0.0;
  water.gauges.clear();
  water.solver.pressure = pressure;
  return identity_text(water);
}

void check_origin(const Checkpoint& checkpoint, const Scene& scene, const Settings& settings, const std::string& path) {
  const auto refuse = [&](const std::string& difference, const std::string& cure) {
    throw InputError(path + ": was saved from another run: " + difference + "; " + cure);
  };
  if (checkpoint.pressure != settings.pressure)
    refuse(std::string("pressure solver ") + to_string(checkpoint.pressure) + " there and " +
               to_string(settings.pressure) + " here",
           std::string("add --pressure ") + to_string(checkpoint.pressure));
  const std::string here = checkpoint_scene_text(scene, settings.pressure);
  if (checkpoint.scene_text != here)
    refuse(first_difference(checkpoint.scene_text, here),
           "give the scene, --particles and --dt-max that it was saved with");
  if (checkpoint.seed != settings.seed && !scene.rains.empty())
    refuse("seed " + std::to_string(checkpoint.seed) + " there and " + std::to_string(settings.seed) + " here",
           "add --seed " + std::to_string(checkpoint.seed));
}

}  // namespace squall
