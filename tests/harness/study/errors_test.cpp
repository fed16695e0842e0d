#include "harness/study/errors.h"

#include <gtest/gtest.h>

#include <cmath>

#include "harness/study/observables.h"

namespace squall::harness {
namespace {

constexpr int k_times = 8;

/// A run whose observables are all `offset` scales, at ten output times a second.
Record flat_run(double offset) {
  Record record;
  for (int i = 1; i <= k_times; ++i) record.time_s.push_back(0.1 * i);
  double scale = 1.0;
  for (const auto& observable : study_observables()) {
    record.scales[observable.name] = scale;
    record.values[observable.name].assign(k_times, offset * scale);
    scale *= 3.0;
  }
  return record;
}

/// Its one particle lies at `dx` spacings at output time i.
template <class Place>
Record tracked_run(Place dx) {
  Record record = flat_run(0.0);
  for (int i = 0; i < k_times; ++i)
    record.tracks.push_back({std::llrint(1e9 * dx(record.time_s[static_cast<std::size_t>(i)])), 5, 7});
  return record;
}

// Sums and roots of numbers around 1: a few roundings.
constexpr double k_rounding = 1e-14;

TEST(StudyErrors, AreRootMeanSquaresOverScales) {
  const Record a = flat_run(0.25), b = flat_run(0.0);
  for (const auto& name : error_names()) {
    ASSERT_TRUE(difference(a, b, name)) << name;
    EXPECT_NEAR(*difference(a, b, name), 0.25, k_rounding) << name;
    EXPECT_NEAR(*size_of(a, name), 0.25, k_rounding) << name;
  }
  Record half = b;
  half.values["x_cm_m"][0] = half.scales["x_cm_m"];  // one of eight times is off by a whole scale
  EXPECT_NEAR(*difference(half, b, "x_cm_m"), std::sqrt(1.0 / k_times), k_rounding);
  EXPECT_NEAR(*difference(half, b, k_combined_error), std::sqrt(1.0 / (4.0 * k_times)), k_rounding)
      << "four observables make up the combined error";
  EXPECT_NEAR(*difference(half, b, "x_cm_m", 0.1), 1.0, k_rounding) << "the first time alone";
}

TEST(StudyErrors, ScalesAreThoseOfEachRun) {
  Record coarse = flat_run(0.5), fine = flat_run(0.5);
  for (auto& [name, scale] : coarse.scales) scale *= 2.0;
  for (auto& [name, values] : coarse.values)
    for (double& value : values) value *= 2.0;
  EXPECT_NEAR(*difference(coarse, fine, "energy_j"), 0.0, k_rounding);
}

TEST(StudyErrors, OtherTimesOrMissingValuesGiveNone) {
  const Record a = flat_run(0.1);
  Record shifted = a, shorter = a, missing = a, never = a;
  shifted.time_s[3] += 1e-3;
  shorter.time_s.pop_back();
  missing.values.erase("front_m");
  never.values["front_m"].assign(k_times, std::nan(""));
  EXPECT_FALSE(difference(a, shifted, "y_cm_m"));
  EXPECT_FALSE(difference(a, shorter, "y_cm_m"));
  for (const Record& lacking : {missing, never}) {
    EXPECT_FALSE(difference(a, lacking, "front_m"));
    EXPECT_FALSE(difference(a, lacking, k_combined_error));
    EXPECT_TRUE(difference(a, lacking, "y_cm_m"));
  }
  EXPECT_FALSE(difference(Record{}, Record{}, "y_cm_m"));
}

/// Water that falls has no front until it lands, and in one run a frame later than in the other.
TEST(StudyErrors, AreOverTheTimesAtWhichBothHaveAValue) {
  Record a = flat_run(0.0), b = flat_run(0.0);
  for (std::size_t i = 0; i < 4; ++i) a.values["front_m"][i] = std::nan("");
  for (std::size_t i = 0; i < 5; ++i) b.values["front_m"][i] = std::nan("");
  const double scale = a.scales["front_m"];
  a.values["front_m"][4] = 77.0 * scale;  // b has none yet
  a.values["front_m"][5] = 0.6 * scale;   // one of three
  EXPECT_NEAR(*difference(a, b, "front_m"), 0.6 / std::sqrt(3.0), k_rounding);
  EXPECT_NEAR(*difference(a, b, k_combined_error), 0.5 * 0.6 / std::sqrt(3.0), k_rounding) << "of four observables";
  EXPECT_FALSE(difference(a, b, "front_m", 0.5)) << "until then they have none at the same time";
  EXPECT_FALSE(difference(a, b, k_combined_error, 0.5));
}

TEST(StudyErrors, WhatNeitherRunHasIsNoPartOfTheCombinedOne) {
  Record a = flat_run(0.3), b = flat_run(0.0);
  for (Record* record : {&a, &b}) record->values["front_m"].assign(k_times, std::nan(""));
  a.values["x_cm_m"] = b.values["x_cm_m"];  // 0, 0.3 and 0.3 are left
  EXPECT_NEAR(*difference(a, b, k_combined_error), 0.3 * std::sqrt(2.0 / 3.0), k_rounding);
  for (const auto& observable : study_observables())
    for (Record* record : {&a, &b}) record->values[observable.name].assign(k_times, std::nan(""));
  for (const auto& name : error_names()) {
    EXPECT_FALSE(difference(a, b, name)) << name;
    EXPECT_FALSE(size_of(a, name)) << name;
  }
}

TEST(StudyErrors, NoiseIsTheStandardDeviation) {
  const Record a = flat_run(1.0), b = flat_run(2.0), c = flat_run(6.0);
  const auto noise = noise_of({&a, &b, &c});
  ASSERT_TRUE(noise);
  EXPECT_EQ(noise->starts, 3);
  for (const auto& name : error_names()) EXPECT_NEAR(noise->spread.at(name), std::sqrt(7.0), 10 * k_rounding) << name;
  EXPECT_FALSE(noise_of({&a}));
  EXPECT_DOUBLE_EQ(noise_floor(0.3, 0.3), 0.6);
  EXPECT_DOUBLE_EQ(noise_floor(0.3, 0.4), std::sqrt(2.0) * 0.5);
}

TEST(StudyErrors, GrowthFindsTheExponentAndTheHorizon) {
  const auto still = tracked_run([](double) { return 0.0; });
  // 3e-6 e^(15 t) dx: 0.1 dx is passed at t = 0.694 s, between the sixth and the seventh output time.
  const auto leaving = tracked_run([](double t) { return 3e-6 * std::exp(15.0 * t); });
  const auto growth = growth_of({&still, &leaving});
  ASSERT_TRUE(growth);
  ASSERT_TRUE(growth->rate_per_s && growth->horizon_s);
  // Places are kept in units of 1e-9 dx: the smallest separation, 1.3e-5 dx, is off by at most 4e-5 of itself.
  EXPECT_NEAR(*growth->rate_per_s, 15.0, 1e-3);
  EXPECT_DOUBLE_EQ(*growth->horizon_s, still.time_s[5]);
  EXPECT_TRUE(growth->horizon_reached);
  const auto calm = growth_of({&still, &still});
  ASSERT_TRUE(calm);
  EXPECT_FALSE(calm->rate_per_s);
  EXPECT_FALSE(calm->horizon_reached);
  EXPECT_DOUBLE_EQ(*calm->horizon_s, still.time_s.back());
  EXPECT_FALSE(growth_of({&still}));
}

TEST(StudyErrors, OrdersOfExactPowersAreFound) {
  for (const double p : {0.5, 1.0, 2.0, 3.5})
    for (const auto& h : {std::array{4.0, 2.0, 1.0}, std::array{0.9, 0.75, 0.2}, std::array{1.0, 0.999, 0.5}}) {
      const double d12 = std::pow(h[0], p) - std::pow(h[1], p), d23 = std::pow(h[1], p) - std::pow(h[2], p);
      const auto order = order_of(h[0], h[1], h[2], 7.0 * d12, 7.0 * d23);
      ASSERT_TRUE(order) << p;
      // 1 - (h2/h1)^p loses three digits where h1 and h2 differ by a thousandth.
      EXPECT_NEAR(*order, p, 1e-11) << h[0] << " " << h[1] << " " << h[2];
    }
}

TEST(StudyErrors, WhatDoesNotConvergeHasNoOrder) {
  EXPECT_FALSE(order_of(4.0, 2.0, 1.0, 1.0, 1.0)) << "halving the step changes as much again";
  EXPECT_FALSE(order_of(4.0, 2.0, 1.0, 1.0, 0.0));
  EXPECT_FALSE(order_of(4.0, 4.0, 1.0, 1.0, 0.5));
  EXPECT_FALSE(order_of(1.0, 2.0, 4.0, 1.0, 0.5));
}

}  // namespace
}  // namespace squall::harness
