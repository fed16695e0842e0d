#include "app/builtin_cases.h"

#include <filesystem>

#include "core/errors.h"

namespace squall::app {

namespace {

const std::string k_ending = ".toml";

std::string embedded_text(const std::string& path) {
  const auto& files = embedded_case_files();
  const auto found = files.find(std::filesystem::path(path).lexically_normal().string());
  if (found == files.end()) throw InputError(path + ": no such file comes with squall");
  return found->second;
}

}  // namespace

std::vector<std::string> builtin_case_names() {
  std::vector<std::string> names;
  for (const auto& [path, text] : embedded_case_files())
    if (path.ends_with(k_ending) && path.find('/') == std::string::npos)
      names.push_back(path.substr(0, path.size() - k_ending.size()));
  return names;
}

harness::Case builtin_case(const std::string& name) {
  return harness::parse_case(embedded_text(name + k_ending), name + k_ending, embedded_text);
}

}  // namespace squall::app
