#pragma once

#include <chrono>
#include <cstddef>

#include "core/frame_report.h"
#include "core/settings.h"

namespace squall::openmp {

/// Wall clock per phase, noted by one thread at its barriers, where the whole team has done with it; does nothing
/// unless profiling or tracing.
class PhaseClock {
 public:
  using Moment = std::chrono::steady_clock::time_point;

  /// Spans count from `frame_start`. Their memory is taken here: the team itself must not fail.
  PhaseClock(const Settings& settings, Moment frame_start, std::size_t substeps, FrameReport& report)
      : profile_(settings.profile), trace_(settings.trace), frame_start_(frame_start), report_(report) {
    if (!profile_ && !trace_) return;
    last_ = substep_begin_ = std::chrono::steady_clock::now();
    if (trace_) report_.spans.reserve(report_.spans.size() + k_spans_per_substep * substeps);
  }

  /// A phase that began where the one before it ended.
  void finish(const char* phase) {
    if (!profile_ && !trace_) return;
    const Moment now = std::chrono::steady_clock::now();
    if (profile_) report_.phase_ms[phase] += milliseconds(last_, now);
    note(phase, last_, now);
    last_ = now;
  }

  void finish_substep() {
    note("sub-step", substep_begin_, last_);
    substep_begin_ = last_;
  }

 private:
  static constexpr std::size_t k_spans_per_substep = 7;  // as many as phases, and itself

  static double milliseconds(Moment begin, Moment end) {
    return std::chrono::duration<double, std::milli>(end - begin).count();
  }
  void note(const char* name, Moment begin, Moment end) {
    if (trace_)
      report_.spans.push_back({name, "omp team", milliseconds(frame_start_, begin), milliseconds(frame_start_, end)});
  }

  bool profile_, trace_;
  Moment frame_start_, last_, substep_begin_;
  FrameReport& report_;
};

}  // namespace squall::openmp
