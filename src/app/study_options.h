#pragma once

#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace squall::app {

/// What `squall study` alone is told. Empty or absent: not given.
struct StudyOptions {
  std::vector<std::string> vary;  ///< names of what to change; empty: everything
  bool full = false;              ///< --effort full
  std::string error;              ///< what settings are ranked by; empty: combined
  std::optional<double> max_error;
  std::optional<int> perturbed, repeats;
};

/// Its options as texts, before values are understood.
struct RawStudyOptions {
  std::vector<std::string> vary;
  std::string effort = "quick", error;
  std::optional<double> max_error;
  std::optional<int> perturbed, repeats;
};

void add_study_options(CLI::App& command, RawStudyOptions& raw);

/// Throws UsageError for names that are not there.
StudyOptions understand(const RawStudyOptions& raw);

}  // namespace squall::app
