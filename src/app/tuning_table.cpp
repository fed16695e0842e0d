#include "app/tuning_table.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include "core/errors.h"

namespace squall::app {

namespace {

constexpr const char* k_kind = "squall tuning table";  // of any version
constexpr const char* k_first_line = "squall tuning table 1";
constexpr std::uintmax_t k_most_bytes = 1 << 20;

using Entries = std::map<std::string, harness::WorkChoice>;

/// A choice as text, and back; nothing if a word or a value is not one that store() writes.
std::string text_of(const harness::WorkChoice& choice) {
  return fmt::format("{} {} {} {}", to_string(choice.simd), choice.work.group, choice.work.parts, choice.work.chunks);
}

std::optional<harness::WorkChoice> choice_from(const std::string& text) {
  std::istringstream words(text);
  std::string simd;
  harness::WorkChoice choice;
  if (!(words >> simd >> choice.work.group >> choice.work.parts >> choice.work.chunks)) return std::nullopt;
  try {
    choice.simd = simd_from_text(simd);
    check(choice.work);
  } catch (const InputError&) {
    return std::nullopt;
  }
  return text_of(choice) == text ? std::optional(choice) : std::nullopt;
}

/// Everything in the file, or nothing: a file with one wrong line is damaged.
Entries read(const std::string& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return {};
  const auto size = std::filesystem::file_size(path, error);
  if (error || size > k_most_bytes) return {};
  std::ifstream file(path);
  std::string line;
  if (!std::getline(file, line) || line != k_first_line) return {};
  Entries entries;
  while (std::getline(file, line)) {
    const auto tab = line.rfind('\t');
    if (tab == std::string::npos) return {};
    const auto choice = choice_from(line.substr(tab + 1));
    if (!choice) return {};
    entries[line.substr(0, tab)] = *choice;
  }
  return entries;
}

/// Something that is not ours to replace: a scene, say, named by mistake, or a device.
bool is_other_file(const std::string& path) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) return false;
  if (!std::filesystem::is_regular_file(status)) return true;
  std::ifstream file(path);
  std::string line;
  return std::getline(file, line) && line.rfind(k_kind, 0) != 0;
}

std::string one_line(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return c < ' ' || c == 0x7f; }, ' ');
  return text;
}

}  // namespace

std::string TuningTable::default_path() {
  const char* cache = std::getenv("XDG_CACHE_HOME");
  if (cache != nullptr && *cache == '/') return std::string(cache) + "/squall/tuning.tsv";
  const char* home = std::getenv("HOME");
  return home != nullptr && *home != '\0' ? std::string(home) + "/.cache/squall/tuning.tsv" : "";
}

bool TuningTable::is_there() const { return !read(path_).empty(); }

std::optional<harness::WorkChoice> TuningTable::find(const std::string& key) const {
  const Entries entries = read(path_);
  const auto found = entries.find(key);
  return found == entries.end() ? std::nullopt : std::optional(found->second);
}

void TuningTable::store(const std::string& key, const harness::WorkChoice& choice) const {
  const auto problem = [&](const std::string& why) {
    return InputError(fmt::format("{}: cannot write the tuning table: {}", path_, why));
  };
  if (is_other_file(path_)) throw problem("there is another file of this name; remove it or name another by --tuning");
  Entries entries = read(path_);
  entries[key] = choice;
  std::error_code error;
  const auto folder = std::filesystem::path(path_).parent_path();
  if (!folder.empty()) std::filesystem::create_directories(folder, error);
  // Written beside it and moved into place: another run sees the old table or the new one.
  const std::string draft = fmt::format("{}.{}", path_, getpid());
  {
    std::ofstream file(draft);
    file << k_first_line << "\n";
    for (const auto& [entry_key, entry] : entries) file << entry_key << "\t" << text_of(entry) << "\n";
    file.close();
    if (!file) error = std::make_error_code(std::errc::io_error);
  }
  if (!error) std::filesystem::rename(draft, path_, error);
  if (!error) return;
  const std::string why = error.message();
  std::filesystem::remove(draft, error);
  throw problem(why);
}

std::string tuning_key(const DeviceInfo& device, const Scene& scene, const Settings& settings, std::size_t particles) {
  const auto size_class = std::bit_width(std::max<std::size_t>(particles, 1)) - 1;
  return one_line(fmt::format("{} | {} | {} | threads {} | {}{}{}{} | simd {} | 2^{} particles", device.name,
                              device.platform, device.driver, settings.threads, to_string(settings.pressure),
                              scene.fluid.viscosity_m2_s ? " viscosity" : "", scene.boxes.empty() ? "" : " boxes",
                              scene.rains.empty() ? "" : " rain", to_string(settings.simd), size_class));
}

}  // namespace squall::app
