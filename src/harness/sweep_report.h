#pragma once

#include <string>
#include <utility>
#include <vector>

#include "harness/report/plot.h"
#include "harness/sweep_results.h"

namespace squall::harness {

/// The plots of a sweep: fps, speedup (where there is one), frame_time and realtime_factor, in this order.
std::vector<Plot> sweep_plots(const SweepResult& result);

/// A drawn plot: its name and the text of its SVG file.
using Picture = std::pair<std::string, std::string>;

/// The whole sweep as one self-contained page; `pictures` are the plots above, drawn.
std::string sweep_html(const SweepResult& result, const std::vector<Picture>& pictures);

/// What the sweep found, a sentence each: crossovers, largest scenes, agreement.
std::vector<std::string> sweep_findings(const SweepResult& result);

}  // namespace squall::harness
