#include "app/earlier_results.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "core/errors.h"
#include "core/text_file.h"

namespace squall::app {

namespace {

namespace fs = std::filesystem;
using harness::Json;

/// Empty if there is none, or none that anybody could read.
Json json_in(const fs::path& file) {
  std::error_code error;
  if (!fs::is_regular_file(file, error)) return nullptr;
  return Json::parse(read_text_file(file.string()), nullptr, false);
}

std::string text_at(const Json& json, const char* key) {
  const auto found = json.find(key);
  return found != json.end() && found->is_string() ? found->get<std::string>() : "?";
}

Subject scene_subject(const Json& scene) {
  const std::string hash = text_at(scene, "hash");
  const auto particles = scene.find("particles");
  return {hash, fmt::format("scene {} ({} particles, hash {})", text_at(scene, "name"),
                            particles != scene.end() ? particles->dump() : "?", hash)};
}

/// What results of squall say that they are about; of other files nothing that is known.
std::vector<Subject> subjects_in(const Json& json) {
  if (json.is_null() || json.is_discarded()) return {};
  if (!json.is_object()) return {{"", "something else"}};
  if (const auto cases = json.find("cases"); cases != json.end() && cases->is_array()) {
    std::vector<Subject> subjects;
    for (const auto& one : *cases)
      if (one.is_object())
        subjects.push_back(subject_of(text_at(one, "name"), text_at(one, "scene"), text_at(one, "scene_hash")));
    return subjects;
  }
  if (const auto scene = json.find("scene"); scene != json.end() && scene->is_object()) return {scene_subject(*scene)};
  return {{"", "something else"}};
}

/// The first run that a study kept says what it is of; without a whole one there is none to lose.
std::vector<Subject> subjects_of_runs(const fs::path& file) {
  std::error_code error;
  if (!fs::is_regular_file(file, error)) return {};
  const std::string text = read_text_file(file.string());
  const Json first = Json::parse(text.substr(0, text.find('\n')), nullptr, false);
  if (first.is_discarded()) return {};
  const auto study = first.is_object() ? first.find("study") : first.end();
  if (study == first.end() || !study->is_object()) return {{"", "something else"}};
  return {scene_subject(*study)};
}

std::string list_of(const std::vector<Subject>& subjects) {
  std::vector<std::string> texts;
  for (const auto& subject : subjects) texts.push_back(subject.text);
  return fmt::format("{}", fmt::join(texts, ", "));
}

[[noreturn]] void refuse(const std::string& folder, const std::string& their_command,
                         const std::vector<Subject>& theirs, const std::string& my_command,
                         const std::vector<Subject>& mine) {
  throw InputError(fmt::format(
      "{}: holds what `squall {}` found of {}, which `squall {}` of {} would replace; name another --out, or "
      "move what lies there away",
      folder, their_command, list_of(theirs), my_command, list_of(mine)));
}

}  // namespace

Subject subject_of(const harness::SceneInfo& scene) {
  return scene_subject({{"name", scene.name}, {"hash", scene.hash}, {"particles", scene.particles}});
}

Subject subject_of(const std::string& case_name, const std::string& scene_name, const std::string& scene_hash) {
  const std::string text = fmt::format("case {} (scene {}, hash {})", case_name, scene_name, scene_hash);
  return {text, text};
}

void refuse_other_study(const std::string& folder, const Subject& theirs, const Subject& mine) {
  if (theirs.id != mine.id) refuse(folder, "study", {theirs}, "study", {mine});
}

void refuse_other_results(const std::string& folder, const std::string& command, const std::vector<Subject>& mine) {
  for (const std::string other : {"study", "sweep", "validate"}) {
    auto theirs = subjects_in(json_in(fs::path(folder) / (other + ".json")));
    if (theirs.empty() && other == "study") theirs = subjects_of_runs(fs::path(folder) / k_runs_file);
    if (other == command)
      std::erase_if(theirs, [&](const Subject& subject) {
        return std::any_of(mine.begin(), mine.end(), [&](const Subject& own) { return own.id == subject.id; });
      });
    if (!theirs.empty()) refuse(folder, other, theirs, command, mine);
  }
}

}  // namespace squall::app
