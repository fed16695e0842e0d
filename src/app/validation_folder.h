#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "harness/context.h"
#include "harness/results_json.h"
#include "harness/validation/validate.h"

namespace squall::app {

/// The folder of `validate --out`: report.html, validate.json, and per case a plot of each check and a CSV file of each
/// run. Made if missing; files of these names are replaced, report.html and validate.json of an earlier validation
/// removed as soon as a run has done a frame, and not before. Throws InputError for what cannot be written.
class ValidationFolder {
 public:
  explicit ValidationFolder(const std::string& path);

  /// Paths in this folder that every validation writes.
  static std::vector<std::filesystem::path> own_files(const std::filesystem::path& folder);
  /// Where the time series of a case's run goes.
  static std::filesystem::path series_file(const std::filesystem::path& folder, const std::string& case_name,
                                           const harness::RunPlan& plan);

  /// Writes the time series and the plots of a case, and before them what `so_far` says of all cases until now: so that
  /// a validation that is killed says whose files these are. Throws DeviceError if gnuplot does not draw.
  void add(const harness::CaseResult& result, const harness::Json& so_far);
  /// Writes validate.json and report.html, unless the folder keeps an earlier validation.
  void finish(const harness::Context& context, const std::vector<harness::CaseResult>& results,
              const std::vector<std::string>& notes);

 private:
  /// Whether it may take the place of earlier results: a run that has not done a frame may not.
  bool is_worth(const harness::CaseResult& result) const;
  void begin();
  void write_case(const harness::CaseResult& result);
  void write(const std::string& name, const std::string& text) const;

  std::filesystem::path path_;
  bool begun_ = false;
  std::vector<harness::CaseResult> waiting_;  ///< without a frame; not worth earlier results
  std::vector<std::pair<std::string, std::string>> pictures_;
};

}  // namespace squall::app
