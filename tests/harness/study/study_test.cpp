#include "harness/study/study.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "core/errors.h"
#include "harness/report/plain_text.h"
#include "harness/study/findings.h"
#include "harness/study/study_report.h"
#include "harness/study/study_results.h"
#include "harness/study/study_scenes.h"
#include "harness/study/study_tables.h"

namespace squall::harness {
namespace {

/// Everything of a record that does not depend on the clock.
std::string water_of_record(const Record& record) {
  Record still = record;
  still.wall_s = still.frame_ms_median = still.frame_ms_p95 = 0.0;
  return to_json(still).dump();
}

StudyResult result_of(const StudySubjects& subjects, StudyRuns runs, const StudyQuestion& question = {}) {
  StudyResult result;
  result.scene = {"column", "0123456789abcdef", 64};
  result.subjects = subjects;
  result.question = question;
  result.findings = find_out(runs, question);
  result.runs = std::move(runs);
  result.point_commands.resize(result.runs.points.points.size(), {"squall run x", "x"});
  result.reference_commands.resize(result.runs.models.size());
  return result;
}

TEST(Study, FinerStepsErrLessAndCostMore) {
  const StudySubjects subjects = small_study(Pressure::wcsph, {StudyAxis::step});
  StudyRecords records;
  const StudyRuns runs = run_study(subjects, {}, make_any, records);
  ASSERT_EQ(runs.points.points.size(), 3u);
  ASSERT_NE(runs.models[0].reference_record, nullptr);
  EXPECT_EQ(runs.models[0].noise_records.size(), 3u);
  const StudyFindings findings = find_out(runs, {});
  const auto &base = findings.points[0], &coarse = findings.points[1], &fine = findings.points[2];
  for (const auto* point : {&base, &coarse, &fine}) {
    ASSERT_EQ(point->status, PointStatus::fine) << point->reason;
    ASSERT_TRUE(point->step_errors.contains("y_cm_m"));
    EXPECT_EQ(point->step_errors.at("y_cm_m").value, point->total_errors.at("y_cm_m").value)
        << "one model is its own yardstick";
  }
  EXPECT_GT(coarse.dt_s, base.dt_s);
  EXPECT_GT(base.dt_s, fine.dt_s);
  EXPECT_GT(coarse.step_errors.at("y_cm_m").value, base.step_errors.at("y_cm_m").value);
  EXPECT_GT(base.step_errors.at("y_cm_m").value, fine.step_errors.at("y_cm_m").value);
  const double finest = runs.records[2].front()->smallest_dt_s;
  const Record& reference = *runs.models[0].reference_record;
  EXPECT_LE(reference.mean_dt_s(), finest / 8.0 * (1.0 + 1e-12));
  EXPECT_FALSE(findings.front.empty());
}

TEST(Study, AnInterruptedOneGoesOnToTheSameResult) {
  const StudySubjects subjects = small_study(Pressure::dfsph, {StudyAxis::step});
  StudyRecords whole;
  const StudyRuns all = run_study(subjects, {}, make_any, whole);
  std::vector<Record> kept;
  StudyRecords first([&](const Record& record) { kept.push_back(record); });
  int frames = 0;
  const StudyRuns cut = run_study(subjects, {}, make_any, first, [&](const StudyProgress&) { return ++frames < 15; });
  EXPECT_TRUE(cut.interrupted);
  EXPECT_EQ(kept.size(), 2u) << "two runs of six frames are whole, the third was cut";
  const StudyFindings partial = find_out(cut, {});
  EXPECT_EQ(partial.points[2].status, PointStatus::not_run);
  EXPECT_TRUE(partial.front.empty()) << "no reference yet, no errors";
  StudyRecords second;
  for (const auto& record : kept) second.put(record);
  const StudyRuns rest = run_study(subjects, {}, make_any, second);
  EXPECT_FALSE(rest.interrupted);
  EXPECT_EQ(rest.reused, kept.size());
  EXPECT_EQ(second.size(), whole.size());
  for (std::size_t i = 0; i < all.records.size(); ++i)
    EXPECT_EQ(water_of_record(*all.records[i].front()), water_of_record(*rest.records[i].front()));
  EXPECT_EQ(water_of_record(*all.models[0].reference_record), water_of_record(*rest.models[0].reference_record));
}

TEST(Study, ProgressOnlyGoesForward) {
  StudyRecords records;
  double last = 0.0;
  run_study(small_study(Pressure::wcsph, {StudyAxis::step, StudyAxis::spacing}), {}, make_any, records,
            [&](const StudyProgress& progress) {
              EXPECT_GE(progress.share, last - 1e-12) << progress.what;
              EXPECT_LE(progress.share, 1.0);
              EXPECT_GE(progress.left_s, 0.0);
              last = progress.share;
              return true;
            });
  EXPECT_NEAR(last, 1.0, 1e-9);
}

TEST(Study, StepsThatAreTooLongAreUnstablePoints) {
  StudySubjects subjects = small_study(Pressure::wcsph, {StudyAxis::step});
  subjects.ranges.step = {20.0};  // cfl 8: sound crosses eight support radii a step
  StudyRecords records;
  StudyRuns runs = run_study(subjects, {}, make_any, records);
  const StudyResult result = result_of(subjects, std::move(runs));
  EXPECT_EQ(result.findings.points[0].status, PointStatus::fine) << result.findings.points[0].reason;
  EXPECT_EQ(result.findings.points[1].status, PointStatus::unstable);
  EXPECT_NE(result.findings.points[1].reason, "");
  EXPECT_EQ(to_json(result)["points"][1]["status"], "unstable");
  EXPECT_NE(study_html(result, {}).find("Settings that do not work"), std::string::npos);
}

TEST(Study, EveryResultNamesEveryPoint) {
  const StudySubjects subjects = small_study(Pressure::wcsph, {StudyAxis::step, StudyAxis::ratio});
  StudyRecords records;
  const StudyResult result = result_of(subjects, run_study(subjects, {}, make_any, records), {"y_cm_m", 1.0, 1e9});
  const Json json = to_json(result);
  std::ostringstream csv;
  write_study_csv(csv, result);
  const std::string html = study_html(result, {});
  ASSERT_EQ(json["points"].size(), 4u);
  for (const auto& point : json["points"]) {
    const std::string name = point["name"];
    EXPECT_NE(csv.str().find("\"" + name + "\","), std::string::npos) << name;
    EXPECT_NE(html.find(escape_markup(name)), std::string::npos) << name;
    EXPECT_EQ(point["command"], "squall run x");
    EXPECT_GT(point["wall_s_per_simulated_s"], 0.0);
    EXPECT_TRUE(point["total_errors"].contains("y_cm_m"));
  }
  EXPECT_EQ(json["models"].size(), 2u);
  EXPECT_EQ(json["models"][0]["is_yardstick"], true) << "the scene's own support ratio";
  EXPECT_FALSE(json["recommendation"]["cheapest_within_max_error"].is_null());
  EXPECT_EQ(json["recommendation"]["best_within_budget"].is_null(), false);
  EXPECT_EQ(study_plots(result).size(), 3u);
  const auto commas = [](const std::string& line) { return std::count(line.begin(), line.end(), ','); };
  const std::string header = csv.str().substr(0, csv.str().find('\n'));
  EXPECT_GT(commas(header), 40);
}

TEST(Study, WhatBreaksTheWaterIsUnstable) {
  const StudySubjects subjects = small_study(Pressure::wcsph, {});
  StudyRecords records;
  StudyRuns runs = run_study(subjects, {}, make_any, records);
  Record broken = *runs.records[0].front();
  broken.values["density_error_mean"][2] = 0.3;
  Record gaining = *runs.records[0].front();
  gaining.energy_gain = 0.3;
  for (const Record* record : {&broken, &gaining}) {
    runs.records[0] = {record};
    EXPECT_EQ(find_out(runs, {}).points[0].status, PointStatus::unstable);
  }
  runs.points.points[0].run.scene.container.motions.push_back({0.0, 1.0, std::nullopt, Eigen::Vector3d(1, 0, 0)});
  EXPECT_EQ(find_out(runs, {}).points[0].status, PointStatus::fine) << "a moving container does work";
}

TEST(Study, WhatIsNotThereIsRefused) {
  StudyRecords records;
  StudySubjects subjects = small_study(Pressure::wcsph, {});
  EXPECT_THROW(find_out(run_study(subjects, {}, make_any, records), {"beauty", {}, {}}), InputError);
  subjects.pressures.clear();
  EXPECT_THROW(run_study(subjects, {}, make_any, records), InputError);
}

}  // namespace
}  // namespace squall::harness
