#include "harness/report/plain_text.h"

#include <fmt/format.h>

#include <cmath>

namespace squall::harness {

namespace {

/// Length of the well-formed UTF-8 sequence at `place`; 0 if there is none (RFC 3629, section 4).
std::size_t sequence_length(const std::string& text, std::size_t place) {
  const auto byte = [&](std::size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u; };
  const unsigned first = byte(place);
  if (first < 0x80) return 1;
  const std::size_t length = first >= 0xc2 && first < 0xe0   ? 2
                             : first >= 0xe0 && first < 0xf0 ? 3
                             : first >= 0xf0 && first < 0xf5 ? 4
                                                             : 0;
  for (std::size_t i = 1; i < length; ++i)
    if ((byte(place + i) & 0xc0u) != 0x80u) return 0;
  const unsigned second = byte(place + 1);
  const bool overlong = (first == 0xe0 && second < 0xa0) || (first == 0xf0 && second < 0x90);
  const bool surrogate = first == 0xed && second >= 0xa0;
  const bool beyond = first == 0xf4 && second >= 0x90;
  return overlong || surrogate || beyond ? 0 : length;
}

}  // namespace

std::string clean_utf8(const std::string& text) {
  constexpr const char* k_replacement = "\xef\xbf\xbd";
  std::string result;
  for (std::size_t place = 0; place < text.size();) {
    const std::size_t length = sequence_length(text, place);
    const auto first = static_cast<unsigned char>(text[place]);
    if (length == 0)
      result += k_replacement;
    else if (first < 0x20 || first == 0x7f)
      result += ' ';
    else
      result += text.substr(place, length);
    place += length == 0 ? 1 : length;
  }
  return result;
}

std::string escape_markup(const std::string& text) {
  std::string result;
  for (const char c : clean_utf8(text)) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      case '\'':
        result += "&#39;";
        break;
      default:
        result += c;
    }
  }
  return result;
}

std::string readable_number(double value) {
  constexpr double k_whole_from = 100.0;
  value += 0.0;  // -0 becomes 0
  if (!std::isfinite(value) || std::abs(value) < k_whole_from) return fmt::format("{:.3g}", value);
  std::string digits = fmt::format("{:.0f}", value);
  const std::size_t first = digits.front() == '-' ? 1 : 0;
  for (std::size_t place = digits.size(); place > first + 3;) digits.insert(place -= 3, ",");
  return digits;
}

}  // namespace squall::harness
