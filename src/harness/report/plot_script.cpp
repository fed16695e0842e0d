#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "harness/report/plain_text.h"
#include "harness/report/plot.h"

namespace squall::harness {

namespace {

constexpr double k_width = 900.0, k_height = 520.0;

/// In single quotes gnuplot reads everything as it is, but for the quote itself; no way of escaping that holds in every
/// place of a text (at its start, two are an empty text), so the typographic one stands in for it.
std::string quoted(const std::string& text) {
  std::string result = "'";
  for (const char c : clean_utf8(text)) result += c == '\'' ? std::string("\xe2\x80\x99") : std::string(1, c);
  return result + "'";
}

/// What is drawn, and where.
class Script {
 public:
  explicit Script(const Plot& plot) : plot_(plot) {
    std::vector<double> xs, ys;
    for (const auto& series : plot.series) {
      series_.push_back(drawable(series));
      for (const auto& sample : series_.back().samples) {
        xs.push_back(sample.x);
        for (const double y : {sample.y, sample.low.value_or(sample.y), sample.high.value_or(sample.y)})
          ys.push_back(y);
      }
    }
    empty_ = xs.empty();
    for (const auto& mark : plot.marks) ys.push_back(mark.y);
    x_ = axis_range(xs, plot.x);
    y_ = axis_range(ys, plot.y);
  }

  std::string text() {
    add_frame();
    add_axis("x", plot_.x, x_);
    add_axis("y", plot_.y, y_);
    for (const auto& mark : plot_.marks) add_mark(mark);
    add_names();
    for (std::size_t i = 0; i < series_.size(); ++i) {
      add_point_labels(i);
      add_data(i);
    }
    add_plot();
    return text_;
  }

 private:
  bool fits(double value, const Axis& axis) const { return std::isfinite(value) && (!axis.log || value > 0.0); }

  Series drawable(Series series) const {
    std::erase_if(series.samples, [&](const Sample& s) { return !fits(s.x, plot_.x) || !fits(s.y, plot_.y); });
    for (auto& sample : series.samples) {
      if (sample.low && !fits(*sample.low, plot_.y)) sample.low.reset();
      if (sample.high && !fits(*sample.high, plot_.y)) sample.high.reset();
    }
    std::stable_sort(series.samples.begin(), series.samples.end(),
                     [](const Sample& a, const Sample& b) { return a.x < b.x; });
    return series;
  }

  std::string colour(std::size_t i) const { return series_[i].colour.empty() ? palette_colour(i) : series_[i].colour; }

  template <class... Values>
  void add(fmt::format_string<Values...> pattern, Values&&... values) {
    text_ += fmt::format(pattern, std::forward<Values>(values)...) + "\n";
  }

  void add_frame() {
    add("set terminal svg size {},{} noenhanced font 'Helvetica,Arial,sans-serif,14' background rgb 'white' name {}",
        k_width, k_height, quoted(plot_.name));
    add("set encoding utf8");
    add("set title {} font ',17'", quoted(plot_.title));
    add("set border 3 lc rgb '#555555'");
    add("set grid lt 1 lw 0.6 lc rgb '#dddddd'");
    add("set tics nomirror out");
    add("unset key");
    std::size_t longest = 0;
    for (const auto& series : series_) longest = std::max(longest, series.name.size());
    constexpr double k_letter_px = 7.6, k_room_px = 40.0;
    const double right = std::max(0.5, 1.0 - (k_letter_px * static_cast<double>(longest) + k_room_px) / k_width);
    add("set rmargin at screen {:.4f}", right);
    if (empty_) add("set label 'nothing was measured' at graph 0.5, graph 0.5 center");
  }

  void add_axis(const std::string& name, const Axis& axis, const Range& range) {
    add("set {}label {}", name, quoted(axis.label));
    if (axis.log) add("set logscale {}", name);
    add("set {}range [{}:{}] noextend", name, range.low, range.high);
    std::string ticks;
    for (const double tick : axis_ticks(range, axis.log))
      ticks += fmt::format("{}{} {}", ticks.empty() ? "" : ", ", quoted(readable_number(tick)), tick);
    add("set {}tics ({})", name, ticks);
  }

  void add_mark(const Mark& mark) {
    if (!fits(mark.y, plot_.y)) return;
    add("set arrow from graph 0, first {} to graph 1, first {} nohead dt 2 lw 1.5 lc rgb '#333333' back", mark.y,
        mark.y);
    const bool left = room_at(mark.y, 0.0) >= room_at(mark.y, 1.0);
    add("set label {} at graph {}, first {} {} offset 0, 0.6 tc rgb '#333333' font ',13'", quoted(mark.name),
        left ? 0.01 : 0.99, mark.y, left ? "left" : "right");
  }

  static double place_on(double value, const Range& range, bool log) {
    const double share = log ? std::log(value / range.low) / std::log(range.high / range.low)
                             : (value - range.low) / (range.high - range.low);
    return std::clamp(share, 0.0, 1.0);
  }
  double height_of(double y) const { return place_on(y, y_, plot_.y.log); }

  /// How far curves stay away from a height near one side of the plot, in plot heights.
  double room_at(double y, double side) const {
    double room = 1.0;
    for (const auto& series : series_)
      for (const auto& sample : series.samples)
        if (std::abs(place_on(sample.x, x_, plot_.x.log) - side) < 0.4)
          room = std::min(room, std::abs(height_of(sample.y) - height_of(y)));
    return room;
  }

  /// Names beside the last points, moved apart where curves end close together, with a thin line to where they belong.
  void add_names() {
    std::vector<std::size_t> named;
    std::vector<double> heights;
    for (std::size_t i = 0; i < series_.size(); ++i) {
      if (series_[i].samples.empty() || series_[i].name.empty()) continue;
      named.push_back(i);
      heights.push_back(height_of(series_[i].samples.back().y));
    }
    constexpr double k_line_height = 0.055;
    const auto places = spread_out(heights, k_line_height);
    for (std::size_t n = 0; n < named.size(); ++n) {
      const auto& series = series_[named[n]];
      const auto& last = series.samples.back();
      add("set arrow from first {}, first {} to graph 1.015, graph {:.4f} nohead lw 0.7 lc rgb {}", last.x, last.y,
          places[n], quoted(colour(named[n])));
      add("set label {} at graph 1.02, graph {:.4f} left tc rgb {}", quoted(series.name), places[n],
          quoted(colour(named[n])));
    }
  }

  void add_point_labels(std::size_t i) {
    for (const auto& sample : series_[i].samples)
      if (!sample.label.empty())
        add("set label {} at first {}, first {} right offset -0.8, 0.7 font ',12' tc rgb {}", quoted(sample.label),
            sample.x, sample.y, quoted(colour(i)));
  }

  void add_data(std::size_t i) {
    if (series_[i].samples.empty()) return;
    add("$series{} << END", i);
    for (const auto& s : series_[i].samples) add("{} {} {} {}", s.x, s.y, s.low.value_or(s.y), s.high.value_or(s.y));
    add("END");
  }

  std::string style_of(std::size_t i) const {
    static constexpr int k_shapes[] = {7, 5, 9, 13, 11, 15};
    const auto& series = series_[i];
    std::string style = series.line && series.points ? "linespoints" : series.line ? "lines" : "points";
    style += fmt::format(" lw 2.2 dt {}", series.dashed ? 2 : 1);
    if (series.points && series.ring) style += " pt 6 ps 1.7";
    if (series.points && !series.ring) style += fmt::format(" pt {} ps 0.8", k_shapes[i % std::size(k_shapes)]);
    return style + " lc rgb " + quoted(colour(i));
  }

  void add_plot() {
    std::vector<std::string> parts;
    for (std::size_t i = 0; i < series_.size(); ++i) {
      if (series_[i].samples.empty()) continue;
      const auto line = quoted(colour(i));
      if (series_[i].spread == Spread::band)
        parts.push_back(
            fmt::format("$series{} using 1:3:4 with filledcurves fs transparent solid 0.18 lc rgb {}", i, line));
      if (series_[i].spread == Spread::bars)
        parts.push_back(fmt::format("$series{} using 1:2:3:4 with yerrorbars pt -1 lw 1 lc rgb {}", i, line));
      parts.push_back(fmt::format("$series{} using 1:2 with {}", i, style_of(i)));
    }
    if (parts.empty()) parts.push_back("NaN");
    add("plot {}", fmt::join(parts, ", \\\n  "));
  }

  const Plot& plot_;
  std::vector<Series> series_;
  Range x_, y_;
  bool empty_ = false;
  std::string text_;
};

}  // namespace

std::string gnuplot_script(const Plot& plot) { return Script(plot).text(); }

}  // namespace squall::harness
