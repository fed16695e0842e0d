#pragma once

#include <string>

namespace squall::harness {

/// The text with bytes that are no UTF-8, and control characters, replaced: what any XML or HTML reader takes.
std::string clean_utf8(const std::string& text);

/// Clean text with & < > " ' escaped, for element content and attribute values.
std::string escape_markup(const std::string& text);

/// 11664.0 as "11,664" (rounded to whole numbers from 100 on), 0.5 as "0.5": at most three digits below 100.
std::string readable_number(double value);

}  // namespace squall::harness
