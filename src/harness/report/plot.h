#pragma once

#include <optional>
#include <string>
#include <vector>

namespace squall::harness {

/// Colours that stay apart for colour-blind readers and in grey (Okabe and Ito, 2008), as "#rrggbb".
std::string palette_colour(std::size_t index);

/// Colour `index` of `count` from light to dark blue: for curves of one kind in an order, like thread counts.
std::string blue_shade(std::size_t index, std::size_t count);

struct Axis {
  std::string label;       ///< with its unit: "frame time [ms]"
  bool log = false;        ///< values that are not above 0 are not drawn
  bool from_zero = false;  ///< linear only: starts at 0, whatever the values
};

struct Sample {
  double x = 0.0, y = 0.0;
  std::optional<double> low = {}, high = {};  ///< spread of y, drawn as Series::spread says
  std::string label = {};                     ///< written beside the point
};

enum class Spread { none, bars, band };

/// One curve; its name, if it has one, stands beside its last point, in its colour.
struct Series {
  std::string name;
  std::vector<Sample> samples;
  std::string colour = {};  ///< "#rrggbb"; empty: from the palette, by position
  bool line = true;         ///< joins the samples, in the order of x
  bool points = true;
  bool dashed = false;
  bool ring = false;  ///< points are rings, large enough to go around those of another curve
  Spread spread = Spread::none;
};

/// A horizontal line across the plot, with its name on it.
struct Mark {
  std::string name;
  double y = 0.0;
};

struct Plot {
  std::string name;  ///< letters, digits and '_': names the file and the elements inside
  std::string title;
  Axis x, y;
  std::vector<Series> series;
  std::vector<Mark> marks = {};
};

struct Range {
  double low = 0.0, high = 1.0;
};

/// What an axis must show for these values, with a little room around them; [1, 10] without any that can be drawn.
Range axis_range(const std::vector<double>& values, const Axis& axis);

/// Where numbers stand on an axis: at 1, 2 and 5 times powers of ten, at most about a dozen, ascending.
std::vector<double> axis_ticks(const Range& range, bool log);

/// Shifts positions so that neighbours are at least `gap` apart, all inside [0, 1] if they fit, in the same order.
std::vector<double> spread_out(const std::vector<double>& positions, double gap);

/// The plot as a gnuplot script, data included, that writes SVG to stdout. Text is taken as it is, but for apostrophes,
/// which become typographic ones: nothing in a name is a command or markup.
std::string gnuplot_script(const Plot& plot);

}  // namespace squall::harness
