#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "harness/study/study.h"

namespace squall::harness {

/// What is asked of the runs; asking something else needs no run again.
struct StudyQuestion {
  std::string error = "combined";   ///< one of error_names(): what settings are ranked by
  std::optional<double> max_error;  ///< the cheapest setting within it is wanted
  std::optional<double> budget_ms;  ///< the most accurate setting is wanted whose 95th percentile keeps it
};

enum class PointStatus { fine, unstable, failed, not_run };
const char* to_string(PointStatus status);

/// An error against another run, and what chance alone would make of it.
struct ErrorFinding {
  double value = 0.0;
  std::optional<double> floor;  ///< empty where there are no perturbed starts to know it from

  bool at_floor() const { return floor && value <= *floor; }
  double ranked() const { return at_floor() ? *floor : value; }  ///< nothing below the floor is told apart
};

struct PointFinding {
  PointStatus status = PointStatus::not_run;
  std::string reason;                                ///< why it is unstable, failed or has no error to rank by
  std::vector<double> wall_s_per_s;                  ///< of each timing
  double cost = 0.0;                                 ///< their median
  double frame_ms_median = 0.0, frame_ms_p95 = 0.0;  ///< medians over the timings
  double dt_s = 0.0;                                 ///< mean sub-step
  std::map<std::string, ErrorFinding> step_errors;   ///< against the reference of its own model
  std::map<std::string, ErrorFinding> total_errors;  ///< against the yardstick
  std::optional<double> trajectory_dx;               ///< median distance from its model's reference at the horizon
  bool on_front = false;
};

/// What perturbed starts of a model say.
struct ModelFinding {
  std::optional<Noise> noise;
  std::optional<Growth> growth;
};

/// Self-convergence: three runs whose step or spacing shrinks.
struct OrderFinding {
  std::string model, of;      ///< "step" or "spacing"
  std::string error;          ///< one of error_names()
  double until_s = 0.0;       ///< output times that took part
  std::vector<double> h;      ///< the three mean sub-steps [s] or spacings [m], falling
  std::vector<double> apart;  ///< differences between neighbours
  std::optional<double> order;
  std::string problem;  ///< why there is none
};

struct StudyFindings {
  std::vector<PointFinding> points;  ///< as in StudyPoints
  std::vector<ModelFinding> models;  ///< likewise
  std::vector<OrderFinding> orders;
  std::vector<std::string> gaps;         ///< observables without a value, a sentence each
  std::optional<std::size_t> yardstick;  ///< the model whose reference total errors are against
  std::vector<std::size_t> front;        ///< points, cheapest first
  std::optional<std::size_t> cheapest;   ///< within max_error
  std::optional<std::size_t> best;       ///< within budget_ms
};

/// Judges what ran. Throws InputError for an error of another name.
StudyFindings find_out(const StudyRuns& runs, const StudyQuestion& question);

/// Orders of all models that have three steps or spacings, halved or not.
std::vector<OrderFinding> find_orders(const StudyRuns& runs, const StudyFindings& findings);

}  // namespace squall::harness
