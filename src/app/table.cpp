#include "app/table.h"

#include <algorithm>
#include <utility>

#include "app/terminal.h"

namespace squall::app {

Table::Table(std::vector<std::string> header, bool all_left) : lines_{{std::move(header)}}, all_left_(all_left) {}

void Table::add(std::vector<std::string> cells) { lines_.push_back({std::move(cells)}); }

void Table::add_free(std::string first, std::string rest) {
  lines_.push_back({{std::move(first), std::move(rest)}, true});
}

std::string Table::text() const {
  std::vector<std::size_t> widths(lines_.front().cells.size(), 0);
  for (const auto& line : lines_)
    for (std::size_t c = 0; c < (line.free ? 1 : std::min(widths.size(), line.cells.size())); ++c)
      widths[c] = std::max(widths[c], line.cells[c].size());
  std::string text;
  for (std::size_t l = 0; l < lines_.size(); ++l) {
    const std::string line = line_text(lines_[l], widths);
    text += (l == 0 ? bold(line) : line) + "\n";
  }
  return text;
}

std::string Table::line_text(const Line& line, const std::vector<std::size_t>& widths) const {
  std::string text;
  for (std::size_t c = 0; c < line.cells.size(); ++c) {
    const std::string& cell = line.cells[c];
    const std::size_t width = c < widths.size() ? widths[c] : 0;
    const std::string padding(width > cell.size() ? width - cell.size() : 0, ' ');
    const bool left = all_left_ || c == 0 || line.free;
    text += (c > 0 ? "  " : "") + (left ? cell + padding : padding + cell);
  }
  text.erase(text.find_last_not_of(' ') + 1);
  return text;
}

}  // namespace squall::app
