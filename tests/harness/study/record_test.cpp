#include "harness/study/record.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

#include "core/errors.h"
#include "harness/study/study_scenes.h"

namespace squall::harness {
namespace {

StudyRun short_run(int frames = 3) {
  StudyRun run;
  run.scene = falling_column();
  run.plan = reference_plan(frames);
  return run;
}

TEST(StudyRecord, HoldsARunAndComesBackFromItsText) {
  const auto record = record_run(short_run(), "a key", make_any, {});
  ASSERT_TRUE(record);
  EXPECT_EQ(record->key, "a key");
  EXPECT_EQ(record->error, "");
  EXPECT_EQ(record->particles, 64);
  ASSERT_EQ(record->time_s.size(), 3u);
  EXPECT_DOUBLE_EQ(record->time_s[2], 0.1);
  EXPECT_EQ(record->tracks.size(), 3u);
  EXPECT_EQ(record->tracks[0].size(), 3u * 64u);
  EXPECT_GT(record->most_substeps, 0);
  EXPECT_GT(record->smallest_dt_s, 0.0);
  for (const auto& [name, values] : record->values)
    for (const double value : values) EXPECT_TRUE(std::isfinite(value)) << name;
  const std::string text = to_json(*record).dump();
  EXPECT_EQ(to_json(record_from_json(Json::parse(text))).dump(), text);
}

TEST(StudyRecord, NumbersThatAreNoneSurvive) {
  Record record;
  record.time_s = {0.1, 0.2};
  record.values["front_m"] = {1.0, std::numeric_limits<double>::infinity()};
  record.density_error_max = std::nan("");
  const Record again = record_from_json(Json::parse(to_json(record).dump()));
  EXPECT_EQ(again.values.at("front_m")[0], 1.0);
  EXPECT_TRUE(std::isnan(again.values.at("front_m")[1]));
  EXPECT_TRUE(std::isnan(again.density_error_max));
}

TEST(StudyRecord, OtherTextsAreRefused) {
  EXPECT_THROW(record_from_json(Json::parse("{}")), InputError);
  EXPECT_THROW(record_from_json(Json::parse("[1]")), InputError);
  Json json = to_json(Record{});
  json["values"]["front_m"] = {1.0};
  EXPECT_THROW(record_from_json(json), InputError) << "a value without a time";
  json = to_json(Record{});
  json["steps"] = "many";
  EXPECT_THROW(record_from_json(json), InputError);
}

TEST(StudyRecord, FollowsTheSameTimesWhateverTheFrames) {
  StudyRun fine = short_run(9);
  fine.scene.time.frame_rate_hz *= 3.0;
  fine.every = 3;
  const auto a = record_run(short_run(), "a", make_any, {}), b = record_run(fine, "b", make_any, {});
  ASSERT_TRUE(a && b);
  ASSERT_EQ(a->time_s.size(), b->time_s.size());
  for (std::size_t i = 0; i < a->time_s.size(); ++i) EXPECT_NEAR(a->time_s[i], b->time_s[i], 1e-15);
  // The column has hardly begun to fall: its mean height changes by g t^2/2 at most, and the step by less than that.
  const double fallen = 0.5 * 9.81 * 0.1 * 0.1 / a->scales.at("y_cm_m");
  EXPECT_LT(std::abs(a->values.at("y_cm_m")[2] - b->values.at("y_cm_m")[2]), fallen);
}

TEST(StudyRecord, ARepeatKeepsItsTimeAlone) {
  StudyRun run = short_run();
  run.repeat = 1;
  const auto record = record_run(run, "again", make_any, {});
  ASSERT_TRUE(record);
  EXPECT_GT(record->wall_s, 0.0);
  EXPECT_TRUE(record->time_s.empty() && record->tracks.empty());
}

TEST(StudyRecord, ARunThatIsEndedEarlyGivesNone) {
  EXPECT_FALSE(record_run(short_run(), "cut", make_any, [](double share) { return share < 0.5; }));
}

TEST(StudyRecord, PerturbedStartsDifferByAMillionthOfASpacing) {
  const Particles start = initial_particles(falling_column());
  std::set<double> places;
  for (const int number : {1, 2, 3}) {
    const Particles moved = jittered(start, 0.1, number);
    double largest = 0.0;
    for (std::size_t i = 0; i < start.size(); ++i)
      largest = std::max(largest, (moved.positions[i] - start.positions[i]).cwiseAbs().maxCoeff());
    EXPECT_LE(largest, 1e-6 * 0.1 + 1e-16);
    EXPECT_GT(largest, 0.5e-6 * 0.1) << "the largest of 192 numbers";
    EXPECT_EQ(jittered(start, 0.1, number).positions[5].y(), moved.positions[5].y()) << "the same each time";
    places.insert(moved.positions[5].y());
  }
  EXPECT_EQ(places.size(), 3u);
}

TEST(StudyRecord, KeysTellRunsApart) {
  const StudyRun run = short_run();
  Context context;
  std::set<std::string> keys{key_of(run, context)};
  const auto expect_new = [&](const StudyRun& other, const char* what) {
    EXPECT_TRUE(keys.insert(key_of(other, context)).second) << what;
  };
  StudyRun other = run;
  other.scene.solver.cfl = 0.2, expect_new(other, "scene");
  other = run, other.plan.settings.pressure = Pressure::mueller, expect_new(other, "solver");
  other = run, other.plan.settings.precision = Precision::single_precision, expect_new(other, "precision");
  other = run, other.plan.settings.threads = 2, expect_new(other, "threads");
  other = run, other.plan.settings.seed = 2, expect_new(other, "seed");
  other = run, other.plan.backend = "omp", expect_new(other, "backend");
  other = run, other.plan.frames = 4, expect_new(other, "frames");
  other = run, other.jitter = 1, expect_new(other, "jitter");
  other = run, other.repeat = 1, expect_new(other, "repeat");
  other = run, other.every = 2, expect_new(other, "every");
  context.squall_version = "another";
  expect_new(run, "version");
  EXPECT_EQ(key_of(run, Context{}), key_of(short_run(), Context{}));
}

}  // namespace
}  // namespace squall::harness
