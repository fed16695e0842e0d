#pragma once

#include <filesystem>
#include <string>

#include "harness/validation/case.h"
#include "harness/validation/table_reader.h"

namespace squall::harness {

/// Where a case's other files are.
struct CaseFiles {
  std::string case_path;
  const FileReader& read;

  std::string beside(const std::string& file) const {
    return (std::filesystem::path(case_path).parent_path() / file).string();
  }
};

/// One [[check]] of a case whose scene, solvers and earlier checks are known. Throws InputError.
Check read_check(TableReader& reader, const Case& of, const CaseFiles& files);

}  // namespace squall::harness
