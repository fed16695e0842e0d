#pragma once

#include <string>

#include "harness/report/plot.h"

namespace squall::harness {

/// Throws DeviceError, which says what to install, if there is no gnuplot that starts.
void require_gnuplot();

/// The plot as an SVG file. Throws DeviceError if gnuplot does not start or does not draw it.
std::string draw_svg(const Plot& plot);

}  // namespace squall::harness
