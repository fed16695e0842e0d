#include "harness/trace_json.h"

#include <gmock/gmock.h>

#include <chrono>
#include <sstream>

#include "harness/fake_solver.h"
#include "harness/results_json.h"

namespace squall::harness {
namespace {

using std::chrono::milliseconds;
const std::chrono::steady_clock::time_point k_start{std::chrono::hours(1000)};

FrameRecord record(int number, std::chrono::steady_clock::time_point begin, double frame_ms,
                   std::vector<PhaseSpan> spans) {
  FrameRecord frame;
  frame.begin = begin;
  frame.report.frame = static_cast<std::uint64_t>(number);
  frame.report.frame_ms = frame_ms;
  frame.report.substeps = 1;
  frame.report.clock_error_ms = 0.25;
  frame.report.spans = std::move(spans);
  return frame;
}

Json trace_of(const std::vector<TracedRun>& runs) {
  std::ostringstream out;
  write_trace(out, Context{}, runs);
  return Json::parse(out.str());
}

std::vector<Json> events_named(const Json& trace, const std::string& name) {
  std::vector<Json> events;
  for (const auto& event : trace["traceEvents"])
    if (event["name"] == name) events.push_back(event);
  return events;
}

TEST(TraceJson, ARunIsAProcessAndALaneAThread) {
  const std::vector<FrameRecord> first{
      record(7, k_start, 5.0, {{"plan", "host", 0.0, 0.5}, {"sort", "omp team", 1.0, 2.0}})};
  const std::vector<FrameRecord> second{record(7, k_start + milliseconds(10), 4.0, {{"plan", "host", 0.0, 1.0}})};
  const Json trace = trace_of({{"omp, \"2\" threads", &first}, {"opencl", &second}});
  const auto processes = events_named(trace, "process_name");
  ASSERT_EQ(processes.size(), 2u);
  EXPECT_EQ(processes[0]["args"]["name"], "omp, \"2\" threads");
  EXPECT_EQ(events_named(trace, "thread_name").size(), 3u) << "two lanes and one";
  const auto frames = events_named(trace, "frame");
  ASSERT_EQ(frames.size(), 2u);
  EXPECT_EQ(frames[0]["ts"], 0.0) << "time counts from the first frame";
  EXPECT_EQ(frames[0]["dur"], 5000.0);
  EXPECT_EQ(frames[0]["args"]["frame"], 7);
  EXPECT_EQ(frames[0]["args"]["clock_error_us"], 250.0);
  EXPECT_EQ(frames[1]["ts"], 10000.0);
  EXPECT_NE(frames[0]["pid"], frames[1]["pid"]);
  const auto sort = events_named(trace, "sort").at(0);
  EXPECT_EQ(sort["ph"], "X");
  EXPECT_EQ(sort["ts"], 1000.0);
  EXPECT_EQ(sort["dur"], 1000.0);
  EXPECT_NE(sort["tid"], frames[0]["tid"]);
}

// Ends are rounded, not lengths: three thirds of a parent end where it ends.
TEST(TraceJson, RoundingLetsNothingStickOut) {
  const double third = 1.0 / 3.0;
  const std::vector<FrameRecord> frames{record(0, k_start, 1.0,
                                               {{"a", "queue", 0.0, third},
                                                {"b", "queue", third, 2 * third},
                                                {"c", "queue", 2 * third, 1.0},
                                                {"sub-step", "queue", 0.0, 1.0}})};
  const Json trace = trace_of({{"run", &frames}});
  const auto end = [&](const char* name) {
    const Json event = events_named(trace, name).at(0);
    return std::llround(1e3 * event["ts"].get<double>()) + std::llround(1e3 * event["dur"].get<double>());
  };
  EXPECT_EQ(end("a"), std::llround(1e3 * events_named(trace, "b").at(0)["ts"].get<double>()));
  EXPECT_EQ(end("c"), end("sub-step"));
  std::vector<std::string> order;
  for (const auto& event : trace["traceEvents"])
    if (event["ph"] == "X" && event["name"] != "frame") order.push_back(event["name"]);
  EXPECT_THAT(order, testing::ElementsAre("sub-step", "a", "b", "c")) << "parents come first";
}

TEST(TraceJson, SubStepsAreCounted) {
  const std::vector<FrameRecord> frames{
      record(0, k_start, 2.0, {{"sub-step", "queue", 0.0, 1.0}, {"sub-step", "queue", 1.0, 2.0}})};
  const auto substeps = events_named(trace_of({{"run", &frames}}), "sub-step");
  ASSERT_EQ(substeps.size(), 2u);
  EXPECT_EQ(substeps[0]["args"]["sub-step"], 0);
  EXPECT_EQ(substeps[1]["args"]["sub-step"], 1);
}

TEST(TraceJson, RunsWithoutFramesAndFramesWithoutSpans) {
  const std::vector<FrameRecord> none;
  const std::vector<FrameRecord> ended{record(0, k_start, 1.0, {{"plan", "host", 0.0, 0.5}}),
                                       record(1, k_start + milliseconds(2), 1.0, {}),
                                       record(2, k_start + milliseconds(4), 1.0, {{"plan", "host", 0.0, 0.5}})};
  EXPECT_EQ(traced_frames(none), 0u);
  EXPECT_EQ(traced_frames(ended), 1u);
  const Json trace = trace_of({{"none", &none}, {"ended", &ended}});
  EXPECT_EQ(events_named(trace, "frame").size(), 1u);
  EXPECT_EQ(trace_of({})["traceEvents"].size(), 0u);
}

TEST(TraceJson, ANameNeedNotBeUtf8) {
  const std::vector<FrameRecord> frames{record(0, k_start, 1.0, {{"\xff", "host", 0.0, 0.5}})};
  EXPECT_EQ(trace_of({{"\xfe", &frames}})["traceEvents"].size(), 6u) << "two names, each with its place, and two spans";
}

TEST(TraceJson, ARunNotesWhereItsFramesBegin) {
  RunPlan plan = short_plan("traced");
  plan.settings.trace = true;
  harness::Run run(make_fake(plan), plan);
  while (!run.done()) run.step();
  ASSERT_EQ(run.frames().size(), 6u);
  for (std::size_t f = 0; f < 6; ++f) {
    const auto& frame = run.frames()[f];
    ASSERT_FALSE(frame.report.spans.empty());
    if (f == 0) continue;
    const auto& before = run.frames()[f - 1];
    const std::chrono::duration<double, std::milli> since = frame.begin - before.begin;
    EXPECT_GE(since.count(), before.report.frame_ms) << "frames do not overlap";
  }
  EXPECT_EQ(traced_frames(run.frames()), 6u);
}

}  // namespace
}  // namespace squall::harness
