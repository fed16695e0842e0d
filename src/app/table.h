#pragma once

#include <string>
#include <vector>

namespace squall::app {

/// Text in aligned columns: the first on the left, all others on the right unless `all_left`.
class Table {
 public:
  explicit Table(std::vector<std::string> header, bool all_left = false);
  void add(std::vector<std::string> cells);
  /// A line that takes the first cell's column and then runs on freely.
  void add_free(std::string first, std::string rest);
  std::string text() const;

 private:
  struct Line {
    std::vector<std::string> cells;
    bool free = false;
  };
  std::string line_text(const Line& line, const std::vector<std::size_t>& widths) const;
  std::vector<Line> lines_;
  bool all_left_;
};

}  // namespace squall::app
