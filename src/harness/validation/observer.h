#pragma once

#include <Eigen/Core>

#include <optional>
#include <string>
#include <vector>

#include "core/frame_report.h"
#include "core/scene.h"
#include "core/settings.h"
#include "core/solver.h"
#include "harness/gauges.h"
#include "harness/validation/series.h"

namespace squall::harness {

/// A quantity that every scene has.
struct Quantity {
  std::string name;     ///< with its unit
  std::string unit;     ///< "1" for a pure number
  std::string meaning;  ///< one sentence
  std::string needs;    ///< what must be there for it to have a value; empty: it is a sum, 0 without particles
};

/// All of them; lengths are relative to the container's min corner and in its frame (docs/validation.md).
const std::vector<Quantity>& quantities();

/// Unit of a quantity or of a column of the scene's gauges; empty for another name.
std::string unit_of(const Scene& scene, const std::string& quantity);

/// Names that checks of a scene may use: quantities() and the columns of its gauges. Throws InputError for a gauge that
/// is called like a quantity or a part of another gauge.
std::vector<std::string> quantity_names(const Scene& scene);

/// Collects a run into a time series, sample by sample: quantities() and the scene's gauges. Positions belong to the
/// time t of a sample. What needs velocities is taken at t - dt/2, where leap-frog has them, with positions taken back
/// by v dt/2: second order, like the integrator. Pressures are means over `samples_per_frame` samples and belong to the
/// middle of that span. What has no value at a moment (Quantity::needs) is NaN there.
class Observer {
 public:
  Observer(const Scene& scene, Pressure pressure, int samples_per_frame);

  /// `report` of the frame that led to the state; none for the start.
  void add(const State& state, const FrameReport* report);

  const TimeSeries& series() const { return series_; }

 private:
  struct Moment;
  void add_positions(const State& state, double time_s);
  void add_motion(const State& state, double time_s);
  void add_wall_force(const State& state, double time_s);
  void add_gauges(const State& state, double time_s);
  Column& column(const std::string& name);
  void put(const std::string& name, double time_s, double value);
  void put_axes(const std::string& before, const std::string& after, double time_s, const Eigen::Vector3d& value);

  Scene scene_;
  Gauges gauges_;
  std::size_t samples_per_frame_;
  TimeSeries series_;
  std::vector<std::vector<GaugeReading>> recent_;  ///< of the frame so far
  std::optional<State> before_;
  Particles start_;
};

}  // namespace squall::harness
