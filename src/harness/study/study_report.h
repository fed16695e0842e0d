#pragma once

#include <string>
#include <vector>

#include "harness/report/plot.h"
#include "harness/study/study_results.h"
#include "harness/sweep_report.h"

namespace squall::harness {

/// The plots of a study: error against cost with the front, step error against the step, and how perturbed starts
/// leave the unperturbed one.
std::vector<Plot> study_plots(const StudyResult& result);

/// One page with everything, which loads nothing from anywhere.
std::string study_html(const StudyResult& result, const std::vector<Picture>& pictures);

}  // namespace squall::harness
