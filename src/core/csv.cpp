#include "core/csv.h"

#include <array>
#include <charconv>
#include <cmath>
#include <string_view>
#include <system_error>

#include "core/errors.h"
#include "core/text_file.h"

namespace squall {
namespace {

constexpr std::string_view k_header = "x,y,z,vx,vy,vz";
constexpr std::size_t k_fields = 6;

/// One line of the file, and where it is.
struct Line {
  const std::string& path;
  std::size_t number;
  std::string_view text;

  [[noreturn]] void fail(std::size_t offset, const std::string& what) const {
    throw InputError(path + ":" + std::to_string(number) + ":" + std::to_string(offset + 1) + ": " + what);
  }
};

double parse_number(const Line& line, std::size_t offset, std::string_view field) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
  if (error != std::errc{} || end != field.data() + field.size() || !std::isfinite(value))
    line.fail(offset, "'" + std::string(field) + "' is not a finite number");
  return value + 0.0;  // -0 becomes 0: files that mean the same are the same
}

std::array<double, k_fields> parse_line(const Line& line) {
  std::array<double, k_fields> values{};
  std::size_t offset = 0;
  for (std::size_t i = 0; i < k_fields; ++i) {
    const std::size_t comma = line.text.find(',', offset);
    const bool last = i + 1 == k_fields;
    if (last != (comma == std::string_view::npos))
      line.fail(last ? comma : line.text.size(), "a line has six numbers (" + std::string(k_header) +
                                                     "); this one has " + (last ? "more" : std::to_string(i + 1)));
    const std::size_t end = last ? line.text.size() : comma;
    values[i] = parse_number(line, offset, line.text.substr(offset, end - offset));
    offset = end + 1;
  }
  return values;
}

/// Cuts the first line off `rest`.
std::string_view take_line(std::string_view& rest) {
  const std::size_t newline = rest.find('\n');
  std::string_view line = rest.substr(0, newline);
  rest = newline == std::string_view::npos ? std::string_view{} : rest.substr(newline + 1);
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  return line;
}

}  // namespace

Particles parse_particle_csv(const std::string& text, const std::string& path) {
  std::string_view rest = text;
  constexpr std::string_view k_byte_order_mark = "\xEF\xBB\xBF";  // spreadsheets write it
  if (rest.starts_with(k_byte_order_mark)) rest.remove_prefix(k_byte_order_mark.size());
  const Line header{path, 1, take_line(rest)};
  if (header.text != k_header) header.fail(0, "the first line must be the header " + std::string(k_header));
  Particles particles;
  for (std::size_t number = 2; !rest.empty(); ++number) {
    const auto v = parse_line(Line{path, number, take_line(rest)});
    particles.add(static_cast<std::uint32_t>(particles.size()), {v[0], v[1], v[2]}, {v[3], v[4], v[5]});
  }
  return particles;
}

Particles read_particle_csv(const std::string& path) { return parse_particle_csv(read_text_file(path), path); }

}  // namespace squall
