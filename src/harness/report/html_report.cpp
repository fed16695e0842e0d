#include "harness/report/html_report.h"

#include <fmt/format.h>

#include "harness/report/plain_text.h"

namespace squall::harness {

namespace {

constexpr const char* k_style = R"(
body { margin: 2rem auto; max-width: 62rem; padding: 0 1rem; background: #fff; color: #1b1b1b;
       font: 16px/1.5 system-ui, "Helvetica Neue", Arial, sans-serif; }
h1 { font-size: 1.8rem; margin-bottom: 0.2rem; }
h2 { font-size: 1.25rem; margin: 2.2rem 0 0.6rem; border-bottom: 1px solid #ccc; }
p.lead { color: #444; margin-top: 0; }
.wide { overflow-x: auto; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; font-size: 0.92rem; margin: 0.6rem 0; }
th, td { padding: 0.25rem 0.7rem; text-align: right; border-bottom: 1px solid #e2e2e2; white-space: nowrap; }
th { border-bottom: 2px solid #888; }
th:first-child, td:first-child, table.left th, table.left td { text-align: left; }
table.left td { white-space: normal; overflow-wrap: anywhere; }
figure { margin: 1.4rem 0; }
figure svg { width: 100%; height: auto; }
figcaption { color: #444; font-size: 0.92rem; }
dt { font-weight: 600; margin-top: 0.5rem; }
dd { margin: 0 0 0 1.2rem; }
)";

void replace_all(std::string& text, const std::string& from, const std::string& to) {
  for (std::size_t place = text.find(from); place != std::string::npos; place = text.find(from, place + to.size()))
    text.replace(place, from.size(), to);
}

std::string table_line(const char* cell, const std::vector<std::string>& texts) {
  std::string line = "<tr>";
  for (const auto& text : texts) line += fmt::format("<{0}>{1}</{0}>", cell, escape_markup(text));
  return line + "</tr>\n";
}

}  // namespace

HtmlReport::HtmlReport(const std::string& title, const std::string& lead) : title_(title) {
  body_ = fmt::format("<h1>{}</h1>\n<p class=\"lead\">{}</p>\n", escape_markup(title), escape_markup(lead));
}

void HtmlReport::heading(const std::string& text) { body_ += fmt::format("<h2>{}</h2>\n", escape_markup(text)); }

void HtmlReport::paragraph(const std::string& text) { body_ += fmt::format("<p>{}</p>\n", escape_markup(text)); }

void HtmlReport::list(const std::vector<std::string>& items) {
  if (items.empty()) return;
  body_ += "<ul>\n";
  for (const auto& item : items) body_ += fmt::format("<li>{}</li>\n", escape_markup(item));
  body_ += "</ul>\n";
}

void HtmlReport::table(const std::vector<std::string>& header, const std::vector<std::vector<std::string>>& rows,
                       bool all_left) {
  body_ += fmt::format("<div class=\"wide\"><table{}>\n<thead>{}</thead>\n<tbody>\n", all_left ? " class=\"left\"" : "",
                       table_line("th", header));
  for (const auto& row : rows) body_ += table_line("td", row);
  body_ += "</tbody></table></div>\n";
}

void HtmlReport::figure(const std::string& svg, const std::string& name, const std::string& caption) {
  body_ += fmt::format("<figure>\n{}\n<figcaption>{}</figcaption>\n</figure>\n", svg_element(svg, name),
                       escape_markup(caption));
}

void HtmlReport::definitions(const std::vector<std::pair<std::string, std::string>>& terms) {
  body_ += "<dl>\n";
  for (const auto& [term, meaning] : terms)
    body_ += fmt::format("<dt>{}</dt><dd>{}</dd>\n", escape_markup(term), escape_markup(meaning));
  body_ += "</dl>\n";
}

std::string HtmlReport::text() const {
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<title>{}</title>\n<style>{}</style>\n</head>\n<body>\n{}</body>\n</html>\n",
      escape_markup(title_), k_style, body_);
}

std::string svg_element(const std::string& svg, const std::string& name) {
  const std::size_t start = svg.find("<svg");
  std::string text = start == std::string::npos ? std::string() : svg.substr(start);
  replace_all(text, " xmlns=\"http://www.w3.org/2000/svg\"", "");
  replace_all(text, " xmlns:xlink=\"http://www.w3.org/1999/xlink\"", "");
  // Several pictures share one page, and with it one space of ids.
  replace_all(text, " id='", " id='" + name + "_");
  replace_all(text, " id=\"", " id=\"" + name + "_");
  replace_all(text, "xlink:href='#", "href='#" + name + "_");
  replace_all(text, "xlink:href=\"#", "href=\"#" + name + "_");
  replace_all(text, "url(#", "url(#" + name + "_");
  return text;
}

}  // namespace squall::harness
