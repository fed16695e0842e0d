#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/csv.h"
#include "core/errors.h"
#include "core/scene.h"
#include "core/scene_keys.h"
#include "core/text_file.h"
#include "core/toml_section.h"

namespace squall {
namespace {

using scene_keys::SectionName;

constexpr std::int64_t k_schema = 1;

toml::table parse_toml(const std::string& text, const std::string& path) {
  try {
    return toml::parse(std::string_view(text), std::string_view(path));
  } catch (const toml::parse_error& error) {
    Places(path).fail(error.source().begin, "not valid TOML: " + std::string(error.description()));
  }
}

template <class Section>
std::vector<std::string> key_names(Section& section) {
  std::vector<std::string> names;
  scene_keys::visit_keys(section, [&](const char* key, auto&, scene_keys::KeyRule) { names.emplace_back(key); });
  return names;
}

class SceneReader {
 public:
  SceneReader(const std::string& text, const std::string& path)
      : path_(path), root_(parse_toml(text, path)), places_(path) {}

  Scene read() {
    check_schema();
    refuse_unknown_keys(
        root_, "the scene",
        {"schema", "time", "fluid", "solver", "gravity", "container", "box", "block", "particles", "rain", "gauge"},
        places_);
    Scene scene;
    scene.name = std::filesystem::path(path_).stem().string();
    read_table("time", scene.time);
    read_table("fluid", scene.fluid);
    if (root_.contains("solver")) read_table("solver", scene.solver);
    if (root_.contains("gravity")) read_table("gravity", scene.gravity_m_s2);
    const toml::table& container = read_table("container", scene.container, {"motion"});
    read_list(container, "motion", "container.motion", scene.container.motions);
    read_list(root_, "box", "box", scene.boxes);
    read_list(root_, "block", "block", scene.blocks);
    read_list(root_, "particles", "particles", scene.particle_files);
    read_list(root_, "rain", "rain", scene.rains);
    read_list(root_, "gauge", "gauge", scene.gauges);
    return scene;
  }

  const Places& places() const { return places_; }

  /// Particle files lie relative to the scene file.
  void read_particle_files(Scene& scene, const FileReader& read_file) const {
    const std::filesystem::path folder = std::filesystem::path(path_).parent_path();
    for (std::size_t i = 0; i < scene.particle_files.size(); ++i) {
      Scene::ParticleFile& particle_file = scene.particle_files[i];
      const std::string path = (folder / particle_file.file).string();
      std::string text;
      try {
        text = read_file(path);
      } catch (const InputError& error) {
        throw InputError(places_(SectionName{"particles", i + 1}, "file") + error.what());
      }
      particle_file.particles = parse_particle_csv(text, path);
    }
  }

 private:
  void check_schema() const {
    const toml::node* schema = root_.get("schema");
    if (schema == nullptr) places_.fail({1, 1}, "schema is missing; write schema = 1 at the top");
    const auto* number = schema->as_integer();
    if (number == nullptr) places_.fail(schema->source().begin, "schema must be an integer, not " + type_text(*schema));
    if (number->get() != k_schema)
      places_.fail(schema->source().begin,
                   "schema = " + std::to_string(number->get()) + " is not known; this version reads schema 1");
  }

  template <class Section>
  const toml::table& read_table(const char* key, Section& section, const std::vector<std::string>& more_names = {}) {
    const toml::node* node = root_.get(key);
    if (node == nullptr) places_.fail({1, 1}, "table [" + std::string(key) + "] is missing");
    const toml::table* table = node->as_table();
    if (table == nullptr)
      places_.fail(node->source().begin, std::string(key) + " must be a table, [" + key + "], not " + type_text(*node));
    read_section(*table, SectionName{key}, section, more_names);
    return *table;
  }

  template <class Section>
  void read_list(const toml::table& parent, const char* key, const char* table_name, std::vector<Section>& list) {
    const toml::node* node = parent.get(key);
    if (node == nullptr) return;
    const std::string wanted = std::string(key) + " must be an array of tables, [[" + table_name + "]], not ";
    const toml::array* array = node->as_array();
    if (array == nullptr) places_.fail(node->source().begin, wanted + type_text(*node));
    for (const toml::node& entry : *array) {
      const toml::table* table = entry.as_table();
      if (table == nullptr) places_.fail(entry.source().begin, wanted + "an array that holds " + type_text(entry));
      Section& section = list.emplace_back();
      read_section(*table, SectionName{table_name, list.size()}, section);
    }
  }

  template <class Section>
  void read_section(const toml::table& table, const SectionName& name, Section& section,
                    const std::vector<std::string>& more_names = {}) {
    places_.note(name, "", table.source().begin);
    std::vector<std::string> names = key_names(section);
    names.insert(names.end(), more_names.begin(), more_names.end());
    refuse_unknown_keys(table, name.text(), names, places_);
    scene_keys::visit_keys(section, KeyReader(table, name, places_));
  }

  std::string path_;
  toml::table root_;
  Places places_;
};

}  // namespace

Scene parse_scene(const std::string& text, const std::string& path, std::optional<Pressure> instead) {
  return parse_scene(text, path, read_text_file, instead);
}

Scene parse_scene(const std::string& text, const std::string& path, const FileReader& read,
                  std::optional<Pressure> instead) {
  SceneReader reader(text, path);
  Scene scene = reader.read();
  reader.read_particle_files(scene, read);
  scene_keys::check_scene(scene, reader.places());
  if (const auto pressure = instead ? instead : scene.solver.pressure)
    if (const std::string problem = ratio_problem(scene, *pressure); !problem.empty())
      throw InputError(reader.places()(scene_keys::SectionName{"fluid"}, "support_ratio") + problem);
  return scene;
}

Scene load_scene(const std::string& path, std::optional<Pressure> instead) {
  return parse_scene(read_text_file(path), path, instead);
}

}  // namespace squall
