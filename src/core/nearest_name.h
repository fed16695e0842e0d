#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace squall {

/// The candidate with the smallest edit distance (Levenshtein: insert, delete, replace) to a name, the first of
/// several; for "did you mean". Empty if there are no candidates.
std::string nearest_name(std::string_view name, const std::vector<std::string>& candidates);

}  // namespace squall
