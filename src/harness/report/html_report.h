#pragma once

#include <string>
#include <utility>
#include <vector>

namespace squall::harness {

/// One self-contained HTML page: text, tables and pictures, and nothing that a browser would have to fetch. All text is
/// taken as it is and escaped.
class HtmlReport {
 public:
  HtmlReport(const std::string& title, const std::string& lead);

  void heading(const std::string& text);
  void paragraph(const std::string& text);
  void list(const std::vector<std::string>& items);
  /// The first column is aligned left, all others right; with `all_left` every one left.
  void table(const std::vector<std::string>& header, const std::vector<std::vector<std::string>>& rows,
             bool all_left = false);
  /// An SVG file's text, drawn inside the page. `name` must be different for each figure: it keeps their elements
  /// apart.
  void figure(const std::string& svg, const std::string& name, const std::string& caption);
  /// Terms and what they mean.
  void definitions(const std::vector<std::pair<std::string, std::string>>& terms);

  /// The page so far.
  std::string text() const;

 private:
  std::string title_, body_;
};

/// An SVG file as an element of an HTML page: without the XML declaration and namespaces, its ids made its own.
std::string svg_element(const std::string& svg, const std::string& name);

}  // namespace squall::harness
