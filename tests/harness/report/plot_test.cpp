#include "harness/report/plot.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "harness/report/gnuplot.h"
#include "harness/report/plain_text.h"

namespace squall::harness {
namespace {

constexpr double k_nan = std::numeric_limits<double>::quiet_NaN();

TEST(Axis, ShowsAllValuesWithRoomAround) {
  const Range log = axis_range({1458.0, 46656.0}, {"", true});
  EXPECT_LT(log.low, 1458.0);
  EXPECT_GT(log.low, 1000.0);
  EXPECT_GT(log.high, 46656.0);
  const Range zero = axis_range({3.0, 9.0}, {"", false, true});
  EXPECT_EQ(zero.low, 0.0);
  EXPECT_GT(zero.high, 9.0);
  EXPECT_LT(axis_range({3.0, 9.0}, {"", false}).low, 3.0);
}

TEST(Axis, OneValueNoneAndValuesThatCannotBeDrawn) {
  for (const bool log : {false, true}) {
    const Range one = axis_range({7.0}, {"", log});
    EXPECT_LT(one.low, 7.0);
    EXPECT_GT(one.high, 7.0);
    const Range none = axis_range({k_nan, std::numeric_limits<double>::infinity()}, {"", log});
    EXPECT_LT(none.low, none.high);
  }
  const Range zero = axis_range({0.0}, {"", false, true});
  EXPECT_LT(zero.low, zero.high);
  EXPECT_GT(axis_range({-1.0, 0.0, 4.0}, {"", true}).low, 0.0);
}

TEST(Axis, TicksAreRoundNumbersInsideTheRange) {
  EXPECT_THAT(axis_ticks({1300.0, 52000.0}, true), testing::ElementsAre(2000, 5000, 10000, 20000, 50000));
  EXPECT_THAT(axis_ticks({0.0, 1.9}, false), testing::ElementsAre(0.0, 0.5, 1.0, 1.5));
  EXPECT_THAT(axis_ticks({11000.0, 13900.0}, true), testing::ElementsAre(11000, 11500, 12000, 12500, 13000, 13500))
      << "a short piece of a log axis";
  for (const Range& range : {Range{1e-9, 1e9}, Range{0.1, 0.2}, Range{1.0, 10.0}, Range{3.0, 3.1}})
    for (const bool log : {false, true}) {
      const auto ticks = axis_ticks(range, log);
      EXPECT_GE(ticks.size(), 2u);
      EXPECT_LE(ticks.size(), 14u);
      for (const double tick : ticks) EXPECT_TRUE(tick >= range.low && tick <= range.high);
      EXPECT_TRUE(std::is_sorted(ticks.begin(), ticks.end()));
    }
}

TEST(Names, AreMovedApartAndKeepTheirOrder) {
  EXPECT_THAT(spread_out({0.5, 0.1}, 0.1), testing::ElementsAre(0.5, 0.1));
  const auto moved = spread_out({0.98, 0.99, 0.97, 0.0}, 0.1);
  EXPECT_THAT(moved[3], 0.0);
  EXPECT_LE(moved[1], 1.0);
  // One subtraction of the gap per neighbour.
  EXPECT_GE(moved[1] - moved[0], 0.1 - 1e-15);
  EXPECT_GE(moved[0] - moved[2], 0.1 - 1e-15);
  EXPECT_TRUE(spread_out({}, 0.1).empty());
}

TEST(Colours, ArePerPlaceAndFromLightToDark) {
  EXPECT_NE(palette_colour(0), palette_colour(1));
  EXPECT_EQ(palette_colour(0), palette_colour(6));
  EXPECT_EQ(blue_shade(0, 1), blue_shade(4, 5));
  EXPECT_LT(blue_shade(1, 3).substr(1, 2), blue_shade(0, 3).substr(1, 2));
}

TEST(PlainText, IsCleanedAndEscaped) {
  EXPECT_EQ(clean_utf8("a\xc3\xa9\xe2\x82\xac\xf0\x9f\x92\xa7"), "a\xc3\xa9\xe2\x82\xac\xf0\x9f\x92\xa7");
  EXPECT_EQ(clean_utf8("\xff\n\xc3"), "\xef\xbf\xbd \xef\xbf\xbd");
  EXPECT_EQ(clean_utf8("\xc0\x80\xed\xa0\x80").find('\0'), std::string::npos);
  EXPECT_EQ(clean_utf8("\xed\xa0\x80"), "\xef\xbf\xbd\xef\xbf\xbd\xef\xbf\xbd") << "half of a surrogate pair";
  EXPECT_EQ(escape_markup("<a href=\"x\">'&'"), "&lt;a href=&quot;x&quot;&gt;&#39;&amp;&#39;");
  EXPECT_EQ(readable_number(11664.0), "11,664");
  EXPECT_EQ(readable_number(1234567.0), "1,234,567");
  EXPECT_EQ(readable_number(0.05), "0.05");
  EXPECT_EQ(readable_number(-1000.0), "-1,000");
}

Plot nasty_plot() {
  Plot plot{"nasty", "it's `touch x` \"$(x)\" <b> & {/Bold x} a_b^c @d \xff", {"x\n'y", true}, {"y", true}, {}, {}};
  plot.series = {{"'; system 'false'; '", {{1.0, 2.0, 1.5, 2.5, "first"}, {10.0, 20.0}}},
                 {"nothing", {}},
                 {"not to be drawn", {{-1.0, 2.0}, {2.0, k_nan}}},
                 {"one", {{3.0, 4.0}}}};
  plot.series[0].spread = Spread::band;
  plot.series[3].spread = Spread::bars;
  plot.series[3].ring = true;
  plot.marks = {{"budget <5 ms>", 5.0}, {"not on a log axis", -1.0}};
  return plot;
}

/// Opening and closing tags match: what an XML reader asks for first.
void expect_balanced(const std::string& svg) {
  std::vector<std::string> open;
  for (std::size_t at = svg.find('<'); at != std::string::npos; at = svg.find('<', at + 1)) {
    const std::size_t end = svg.find('>', at);
    ASSERT_NE(end, std::string::npos);
    const std::string tag = svg.substr(at + 1, end - at - 1);
    if (tag[0] == '?' || tag[0] == '!' || tag.back() == '/') continue;
    const std::string name = tag.substr(tag[0] == '/' ? 1 : 0, tag.find_first_of(" \n\t") - (tag[0] == '/' ? 1 : 0));
    if (tag[0] != '/') {
      open.push_back(name);
      continue;
    }
    ASSERT_FALSE(open.empty()) << name;
    ASSERT_EQ(open.back(), name);
    open.pop_back();
  }
  EXPECT_TRUE(open.empty());
}

TEST(Plot, TextIsNeitherCommandNorMarkup) {
  const std::string svg = draw_svg(nasty_plot());
  expect_balanced(svg);
  EXPECT_NE(svg.find("it\xe2\x80\x99s `touch x` \"$(x)\" &lt;b> &amp; {/Bold x} a_b^c @d \xef\xbf\xbd"),
            std::string::npos);
  EXPECT_NE(svg.find("budget &lt;5 ms"), std::string::npos);
  EXPECT_NE(svg.find("\xe2\x80\x99; system \xe2\x80\x99"
                     "false\xe2\x80\x99; \xe2\x80\x99"),
            std::string::npos);
  EXPECT_EQ(svg.find("not on a log axis"), std::string::npos);
  EXPECT_EQ(svg.find("not to be drawn"), std::string::npos);
}

TEST(Plot, NothingToDrawIsSaid) {
  const std::string svg = draw_svg({"empty", "empty", {"x", true}, {"y", false, true}, {}, {}});
  expect_balanced(svg);
  EXPECT_NE(svg.find("nothing was measured"), std::string::npos);
}

TEST(Plot, TheSamplesOfACurveAreDrawnInTheOrderOfX) {
  const std::string script =
      gnuplot_script({"p", "p", {"x"}, {"y"}, {{"curve", {{3.0, 1.0}, {1.0, 2.0}, {2.0, 5.0}}}}, {}});
  EXPECT_NE(script.find("$series0 << END\n1 2 2 2\n2 5 5 5\n3 1 1 1\nEND\n"), std::string::npos) << script;
}

}  // namespace
}  // namespace squall::harness
