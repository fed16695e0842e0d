#pragma once

#include <string>
#include <vector>

#include "app/options.h"
#include "app/study_options.h"

namespace squall::app {

/// The command line as texts, before values are understood.
struct RawOptions {
  std::vector<std::string> backends, readbacks, pressures;
  std::string simd, precision, pressure, format = "squall";
  RawStudyOptions study;
};

/// Throws UsageError for names that there are not, and for options that need or contradict one another.
void understand(const RawOptions& raw, Options& options);

}  // namespace squall::app
