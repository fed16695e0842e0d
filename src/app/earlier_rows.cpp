#include "app/earlier_rows.h"

#include <fmt/format.h>

#include <charconv>
#include <fstream>
#include <limits>
#include <string_view>

#include "core/errors.h"
#include "core/text_file.h"

namespace squall::app {

namespace {

/// Field `column` of a row; commas in quotes do not count.
std::string_view field_of(std::string_view row, std::size_t column) {
  bool quoted = false;
  std::size_t begin = 0;
  for (std::size_t i = 0; i <= row.size(); ++i) {
    if (i < row.size() && row[i] == '"') quoted = !quoted;
    if (i < row.size() && (quoted || row[i] != ',')) continue;
    if (column-- == 0) return row.substr(begin, i - begin);
    begin = i + 1;
  }
  return {};
}

std::size_t column_of_time(std::string_view header) {
  std::size_t column = 0;
  while (!field_of(header, column).empty() && field_of(header, column) != "time_s") ++column;
  return column;
}

double time_of(std::string_view row, std::size_t column) {
  const std::string_view field = field_of(row, column);
  double time = std::numeric_limits<double>::infinity();
  std::from_chars(field.data(), field.data() + field.size(), time);
  return time;
}

}  // namespace

bool keep_rows_until(const std::filesystem::path& file, const std::string& header, double time_s) {
  std::error_code error;
  if (!std::filesystem::exists(file, error)) return false;
  if (!std::filesystem::is_regular_file(file, error))
    throw InputError(file.string() + ": cannot be gone on with: it is no file; name another --out");
  const std::string text = read_text_file(file.string());
  if (header.starts_with(text)) return false;  // nothing was written, or not even the first line
  if (!text.starts_with(header))
    throw InputError(fmt::format("{}: its columns are not those of this version; name another --out", file.string()));
  const std::size_t column = column_of_time(std::string_view(header).substr(0, header.size() - 1));
  std::string kept = header;
  std::string_view rest = std::string_view(text).substr(header.size());
  // A row without its end was cut off.
  for (std::size_t end = rest.find('\n'); end != std::string_view::npos; end = rest.find('\n')) {
    if (time_of(rest.substr(0, end), column) <= time_s) kept += rest.substr(0, end + 1);
    rest.remove_prefix(end + 1);
  }
  const std::filesystem::path part = file.string() + ".part";
  std::ofstream out(part, std::ios::binary);
  out << kept << std::flush;
  if (out) std::filesystem::rename(part, file, error);
  if (!out || error)
    throw InputError(file.string() + ": cannot write this file; check the folder's rights and free space");
  return true;
}

}  // namespace squall::app
