#include "harness/report/html_report.h"

#include <gtest/gtest.h>

#include "harness/report/gnuplot.h"

namespace squall::harness {
namespace {

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
  return found;
}

TEST(HtmlReport, EscapesEverythingItIsTold) {
  HtmlReport page("<t>", "<lead>");
  page.heading("<h>");
  page.paragraph("<p>");
  page.list({"<item>"});
  page.table({"<head>"}, {{"<cell>"}});
  page.definitions({{"<term>", "<meaning>"}});
  const std::string text = page.text();
  for (const char* word : {"t", "lead", "h", "item", "head", "cell", "term", "meaning"})
    EXPECT_NE(text.find("&lt;" + std::string(word) + "&gt;"), std::string::npos) << word;
  for (const char* word : {"<t>", "<lead>", "<h>", "<item>", "<cell>", "<term>", "<meaning>"})
    EXPECT_EQ(text.find(word), std::string::npos) << word;
}

TEST(HtmlReport, PicturesOfOnePageShareNoIds) {
  const Plot plot{"p", "p", {"x"}, {"y"}, {{"curve", {{1.0, 1.0}, {2.0, 2.0}}}}, {}};
  HtmlReport page("two pictures", "");
  for (const char* name : {"first", "second"}) page.figure(draw_svg(plot), name, "caption");
  const std::string text = page.text();
  EXPECT_EQ(count(text, "<svg"), 2u);
  for (std::size_t at = text.find(" id="); at != std::string::npos; at = text.find(" id=", at + 1)) {
    const std::string id = text.substr(at, text.find_first_of("'\"", at + 5) + 1 - at);
    EXPECT_EQ(count(text, id), 1u) << id;
  }
}

TEST(HtmlReport, FetchesNothing) {
  HtmlReport page("page", "");
  page.figure(draw_svg({"p", "p", {"x"}, {"y"}, {{"curve", {{1.0, 1.0}}}}, {}}), "p", "");
  const std::string text = page.text();
  for (const char* way : {"http:", "https:", "//", " src=", "<script", "<link", "<iframe", "@import", "file:"})
    EXPECT_EQ(text.find(way), std::string::npos) << way;
  for (std::size_t at = text.find("href="); at != std::string::npos; at = text.find("href=", at + 1))
    EXPECT_EQ(text[at + 6], '#') << text.substr(at, 40);
}

TEST(HtmlReport, WhatIsNoPictureIsLeftOut) { EXPECT_EQ(svg_element("no picture", "p"), ""); }

}  // namespace
}  // namespace squall::harness
