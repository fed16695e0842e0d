#include "harness/trace_json.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <map>
#include <ostream>

#include "harness/results_json.h"

namespace squall::harness {

namespace {

using Moment = std::chrono::steady_clock::time_point;

/// Times are rounded to whole nanoseconds once, ends and not lengths, so that nothing sticks out of its parent.
struct Event {
  std::string name;
  int lane;
  std::int64_t begin_ns, end_ns;
  std::string arguments;  ///< JSON
};

std::string quoted(const std::string& text) { return Json(text).dump(-1, ' ', false, Json::error_handler_t::replace); }

std::int64_t nanoseconds(double milliseconds) { return std::llround(1e6 * milliseconds); }

std::string microseconds(std::int64_t ns) { return fmt::format("{:.3f}", 1e-3 * static_cast<double>(ns)); }

/// Parents before their children.
bool comes_before(const Event& a, const Event& b) {
  return a.begin_ns != b.begin_ns ? a.begin_ns < b.begin_ns : a.end_ns > b.end_ns;
}

/// Writes the parts of the file, with a comma between them.
class TraceWriter {
 public:
  explicit TraceWriter(std::ostream& out) : out_(out) {}

  void name_process(int process, const std::string& name) {
    add(fmt::format(R"({{"name":"process_name","ph":"M","pid":{},"args":{{"name":{}}}}})", process, quoted(name)));
    add(fmt::format(R"({{"name":"process_sort_index","ph":"M","pid":{0},"args":{{"sort_index":{0}}}}})", process));
  }
  void name_lane(int process, int lane, const std::string& name) {
    add(fmt::format(R"({{"name":"thread_name","ph":"M","pid":{},"tid":{},"args":{{"name":{}}}}})", process, lane,
                    quoted(name)));
    add(fmt::format(R"({{"name":"thread_sort_index","ph":"M","pid":{},"tid":{},"args":{{"sort_index":{}}}}})", process,
                    lane, lane));
  }
  void event(int process, const Event& event) {
    add(fmt::format(R"({{"name":{},"ph":"X","ts":{},"dur":{},"pid":{},"tid":{},"args":{}}})", quoted(event.name),
                    microseconds(event.begin_ns), microseconds(event.end_ns - event.begin_ns), process, event.lane,
                    event.arguments));
  }

 private:
  void add(const std::string& text) {
    out_ << (first_ ? "\n" : ",\n") << text;
    first_ = false;
  }
  std::ostream& out_;
  bool first_ = true;
};

/// The lanes of a run in the order of their first event; the host's frames come first.
class Lanes {
 public:
  explicit Lanes(TraceWriter& writer, int process) : writer_(writer), process_(process) { number("host"); }
  int number(const std::string& name) {
    const auto [lane, is_new] = numbers_.try_emplace(name, static_cast<int>(numbers_.size()) + 1);
    if (is_new) writer_.name_lane(process_, lane->second, name);
    return lane->second;
  }

 private:
  TraceWriter& writer_;
  int process_;
  std::map<std::string, int> numbers_;
};

std::vector<Event> events_of(const FrameRecord& frame, Moment epoch, Lanes& lanes) {
  const FrameReport& report = frame.report;
  const std::int64_t begin = std::chrono::duration_cast<std::chrono::nanoseconds>(frame.begin - epoch).count();
  std::vector<Event> events;
  events.push_back({"frame", lanes.number("host"), begin, begin + nanoseconds(report.frame_ms),
                    fmt::format(R"({{"frame":{},"sub-steps":{},"clock_error_us":{:.3f}}})", report.frame,
                                report.substeps, 1e3 * report.clock_error_ms)});
  std::map<std::string, int> substeps;
  for (const auto& span : report.spans) {
    const bool counts = span.name == "sub-step";
    events.push_back({span.name, lanes.number(span.lane), begin + nanoseconds(span.begin_ms),
                      begin + nanoseconds(span.end_ms),
                      counts ? fmt::format(R"({{"sub-step":{}}})", substeps[span.lane]++) : "{}"});
  }
  std::stable_sort(events.begin(), events.end(), comes_before);
  return events;
}

}  // namespace

std::size_t traced_frames(const std::vector<FrameRecord>& frames) {
  const auto end =
      std::find_if(frames.begin(), frames.end(), [](const auto& frame) { return frame.report.spans.empty(); });
  return static_cast<std::size_t>(end - frames.begin());
}

void write_trace(std::ostream& out, const Context& context, const std::vector<TracedRun>& runs) {
  Moment epoch = Moment::max();
  for (const auto& run : runs)
    if (!run.frames->empty()) epoch = std::min(epoch, run.frames->front().begin);
  out << R"({"displayTimeUnit":"ms","otherData":)"
      << to_json(context).dump(-1, ' ', false, Json::error_handler_t::replace) << R"(,"traceEvents":[)";
  TraceWriter writer(out);
  for (std::size_t r = 0; r < runs.size(); ++r) {
    const int process = static_cast<int>(r) + 1;
    writer.name_process(process, runs[r].label);
    Lanes lanes(writer, process);
    for (std::size_t f = 0; f < traced_frames(*runs[r].frames); ++f)
      for (const auto& event : events_of((*runs[r].frames)[f], epoch, lanes)) writer.event(process, event);
  }
  out << "\n]}\n";
}

}  // namespace squall::harness
