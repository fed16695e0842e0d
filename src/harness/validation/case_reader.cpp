#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "core/errors.h"
#include "harness/validation/case.h"
#include "harness/validation/check_reader.h"
#include "harness/validation/table_reader.h"

namespace squall::harness {

namespace {

class CaseReader {
 public:
  CaseReader(const std::string& text, const std::string& path, const FileReader& read)
      : path_(path), files_{path, read}, root_(parse(text, path)), places_(path) {}

  Case read() {
    if (root_.contains("container"))
      places_.fail({1, 1},
                   "this is a scene, not a case; write a case file that names it (scene = \"...\") and what to expect, "
                   "or give a table with --expected FILE (docs/validation.md)");
    TableReader reader(root_, {k_whole_case}, places_);
    check_schema(reader);
    Case result;
    result.name = std::filesystem::path(path_).stem().string();
    reader.required("title", result.title);
    reader.required("source", result.source);
    read_scene(reader, result);
    read_solvers(reader, result);
    read_run(reader, result);
    read_checks(reader, result);
    reader.done();
    return result;
  }

 private:
  static toml::table parse(const std::string& text, const std::string& path) {
    try {
      return toml::parse(std::string_view(text), std::string_view(path));
    } catch (const toml::parse_error& error) {
      Places(path).fail(error.source().begin, "not valid TOML: " + std::string(error.description()));
    }
  }

  void check_schema(TableReader& reader) {
    std::int64_t schema = 0;
    reader.required("schema", schema);
    if (schema != 1)
      reader.fail("schema", fmt::format("schema = {} is not known; this version reads schema 1", schema));
  }

  void read_scene(TableReader& reader, Case& result) {
    std::string file;
    reader.required("scene", file);
    const std::string path = files_.beside(file);
    std::string text;
    try {
      text = files_.read(path);
    } catch (const InputError& error) {
      reader.fail("scene", error.what());
    }
    result.scene = parse_scene(text, path, files_.read);
    set_defaults(result);
  }

  static void read_solvers(TableReader& reader, Case& result) {
    const auto names = names_in(reader, "solvers");
    if (reader.has("solvers")) result.solvers.clear();
    for (const auto& name : names) {
      const Pressure pressure = pressure_at(reader, name);
      if (std::count(result.solvers.begin(), result.solvers.end(), pressure) > 0)
        reader.fail_at(*name.node, name.text + " is listed twice in solvers");
      if (const std::string problem = ratio_problem(result.scene, pressure); !problem.empty())
        reader.fail_at(*name.node, problem);
      result.solvers.push_back(pressure);
    }
    if (reader.has("solvers") && result.solvers.empty()) reader.fail("solvers", "solvers is empty; name at least one");
  }

  static Pressure pressure_at(const TableReader& reader, const Name& name) {
    try {
      return pressure_from_text(name.text);
    } catch (const InputError& error) {
      reader.fail_at(*name.node, error.what());
    }
  }

  void read_run(TableReader& reader, Case& result) {
    const int most = most_samples(result.scene);
    const toml::node* node = reader.node("run");
    if (node == nullptr) return;
    if (!node->is_table()) reader.fail("run", "run must be a table, [run], not " + type_text(*node));
    TableReader run = reader.inner(*node->as_table(), {"run"});
    run.optional("particles", result.particles);
    run.optional("quick_particles", result.quick_particles);
    run.number("duration_s", result.duration_s, 1e-3, 1e6);
    run.optional("samples_per_frame", result.samples_per_frame);
    run.done();
    for (const auto& [key, count] :
         {std::pair{"particles", result.particles}, std::pair{"quick_particles", result.quick_particles}})
      if (count && (*count < 1 || *count > scene_keys::k_max_particles))
        run.fail(key,
                 fmt::format("{} = {} is out of range; allowed is 1 to {}", key, *count, scene_keys::k_max_particles));
    if (result.samples_per_frame < 1 || result.samples_per_frame > most)
      run.fail("samples_per_frame",
               fmt::format("samples_per_frame = {} is out of range; allowed is 1 to {} (at most 1000 samples a second)",
                           result.samples_per_frame, most));
    if ((result.particles || result.quick_particles) && !result.scene.particle_files.empty())
      run.fail(result.particles ? "particles" : "quick_particles",
               "a scene with particles from a file cannot be scaled");
  }

  void read_checks(TableReader& reader, Case& result) {
    const toml::node* node = reader.node("check");
    if (node == nullptr || node->as_array() == nullptr || node->as_array()->empty())
      reader.fail("check", "a case needs at least one [[check]]");
    std::size_t index = 0;
    for (const auto& entry : *node->as_array()) {
      if (!entry.is_table()) reader.fail_at(entry, "check must be an array of tables, [[check]]");
      TableReader check = reader.inner(*entry.as_table(), {"check", ++index});
      result.checks.push_back(read_check(check, result, files_));
      check.done();
    }
  }

  std::string path_;
  CaseFiles files_;
  toml::table root_;
  Places places_;
};

}  // namespace

Case parse_case(const std::string& text, const std::string& path, const FileReader& read) {
  return CaseReader(text, path, read).read();
}

}  // namespace squall::harness
