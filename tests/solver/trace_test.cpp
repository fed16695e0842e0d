// Settings::trace on every backend: spans lie within their frame and each other, and change nothing else.
#include <algorithm>
#include <map>
#include <vector>

#include "solver/backends_under_test.h"
#include "solver/states.h"

namespace squall::test {
namespace {

class Trace : public OnEveryBackend {
 protected:
  static Scene scene() {
    Scene scene = filled_tank(3);
    scene.container.open_top = true;
    scene.rains.push_back(rain_over_tank(300));
    return scene;
  }
  std::unique_ptr<Solver> make_traced(const Scene& scene, Readback readback = Readback::mapped) const {
    BackendUnderTest traced = GetParam();
    traced.settings.trace = true;
    traced.settings.readback = readback;
    return traced.make(scene);
  }
};
SQUALL_ON_EVERY_BACKEND(Trace);

/// [ms] that sums of a few doubles of this size may be off.
double rounding_of(double milliseconds) { return 8 * std::numeric_limits<double>::epsilon() * milliseconds; }

/// Every lane's spans are one behind the other or inside each other, and all of them inside the frame. Returns the time
/// of those without children, by lane.
std::map<std::string, double> check_nesting(const FrameReport& report) {
  const double slack = rounding_of(report.frame_ms);
  std::map<std::string, std::vector<PhaseSpan>> lanes;
  for (const auto& span : report.spans) {
    EXPECT_LE(span.begin_ms, span.end_ms) << span.name;
    const double shift = span.lane == "host" || span.lane == "omp team" ? 0.0 : report.clock_error_ms;
    EXPECT_GE(span.begin_ms, -shift - slack) << span.name;
    EXPECT_LE(span.end_ms, report.frame_ms + shift + slack) << span.name;
    lanes[span.lane].push_back(span);
  }
  std::map<std::string, double> busy;
  for (auto& [lane, spans] : lanes) {
    std::stable_sort(spans.begin(), spans.end(), [](const PhaseSpan& a, const PhaseSpan& b) {
      return a.begin_ms != b.begin_ms ? a.begin_ms < b.begin_ms : a.end_ms > b.end_ms;
    });
    std::vector<PhaseSpan> open;
    for (std::size_t i = 0; i < spans.size(); ++i) {
      while (!open.empty() && open.back().end_ms <= spans[i].begin_ms + slack) open.pop_back();
      if (!open.empty()) {
        EXPECT_LE(spans[i].end_ms, open.back().end_ms + slack)
            << lane << ": " << spans[i].name << " in " << open.back().name;
      }
      open.push_back(spans[i]);
      const bool is_parent = i + 1 < spans.size() && spans[i + 1].begin_ms < spans[i].end_ms - slack;
      if (!is_parent) busy[lane] += spans[i].end_ms - spans[i].begin_ms;
    }
  }
  return busy;
}

int count_of(const FrameReport& report, const std::string& name) {
  return static_cast<int>(std::count_if(report.spans.begin(), report.spans.end(),
                                        [&](const PhaseSpan& span) { return span.name == name; }));
}

TEST_P(Trace, SpansLieInTheirFrameAndInEachOther) {
  const auto solver = make_traced(scene());
  for (int frame = 0; frame < 4; ++frame) {
    const FrameReport& report = solver->advance();
    EXPECT_EQ(count_of(report, "rain"), frame > 0 ? 1 : 0) << "no drop is due at the start";
    EXPECT_EQ(count_of(report, "plan"), 1);
    if (GetParam().backend != "reference") {
      EXPECT_EQ(count_of(report, "sub-step"), report.substeps);
    }
    if (GetParam().backend == "omp") {
      const std::vector<const char*> explicit_phases = {"sort", "density", "forces"};
      const std::vector<const char*> solver_phases = {"sort",    "prepare",       "divergence solve",
                                                      "predict", "density solve", "drift"};
      for (const char* phase : GetParam().settings.pressure == Pressure::dfsph ? solver_phases : explicit_phases)
        EXPECT_EQ(count_of(report, phase), report.substeps) << phase;
    }
    if (GetParam().backend == "opencl") {
      const bool by_particle = solver->info().simd == "scalar";  // the sort's last kernel, by the way it goes
      EXPECT_EQ(count_of(report, "sort_move"), by_particle ? report.substeps : 0);
      EXPECT_EQ(count_of(report, "sort_scatter"), by_particle ? 0 : report.substeps);
      EXPECT_GE(report.clock_error_ms, 0.0);
    }
    for (const auto& [lane, milliseconds] : check_nesting(report))
      EXPECT_LE(milliseconds, report.frame_ms * (1 + 1e-9)) << lane;
  }
}

TEST_P(Trace, TheBlockingReadBackIsPartOfTheSubStep) {
  if (GetParam().backend != "opencl") return;  // the others deliver in place
  const auto solver = make_traced(scene(), Readback::blocking);
  const FrameReport& report = solver->advance();
  EXPECT_EQ(count_of(report, "read-back"), report.substeps);
  EXPECT_EQ(count_of(report, "stage_positions"), report.substeps);
  EXPECT_EQ(count_of(report, "sub-step"), report.substeps);
  check_nesting(report);
}

TEST_P(Trace, TheAsyncReadBackHasALaneOfItsOwn) {
  if (GetParam().backend != "opencl") return;
  const auto solver = make_traced(scene(), Readback::async);
  const FrameReport& report = solver->advance();
  EXPECT_EQ(count_of(report, "stage_positions"), 1);
  const auto of_transfers = [](const PhaseSpan& span) { return span.lane == "transfer queue"; };
  ASSERT_EQ(std::count_if(report.spans.begin(), report.spans.end(), of_transfers), 1);
  EXPECT_EQ(std::find_if(report.spans.begin(), report.spans.end(), of_transfers)->name, "readback");
  EXPECT_EQ(count_of(report, "sub-step"), report.substeps);
  check_nesting(report);
}

TEST_P(Trace, TheQuantizedReadBackIsBehindTheLastSubStep) {
  if (GetParam().backend != "opencl") return;
  const auto solver = make_traced(scene(), Readback::quantized);
  const FrameReport& report = solver->advance();
  EXPECT_EQ(count_of(report, "quantize_positions"), 1);
  EXPECT_EQ(count_of(report, "readback"), 1);
  EXPECT_EQ(count_of(report, "sub-step"), report.substeps);
  check_nesting(report);
}

TEST_P(Trace, NothingIsNotedUnlessAskedFor) {
  const auto solver = make(scene());
  const FrameReport& report = solver->advance();
  EXPECT_TRUE(report.spans.empty());
  EXPECT_EQ(report.clock_error_ms, 0.0);
  EXPECT_TRUE(report.phase_ms.empty());
}

TEST_P(Trace, TheWaterIsTheSame) {
  const auto traced = make_traced(scene());
  const auto plain = make(scene());
  for (int frame = 0; frame < 3; ++frame) {
    EXPECT_TRUE(traced->advance().phase_ms.empty()) << "phases are asked for by profile";
    plain->advance();
  }
  EXPECT_EQ(first_difference(traced->state().particles, plain->state().particles), "");
}

}  // namespace
}  // namespace squall::test
