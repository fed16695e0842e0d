#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "core/scene.h"

namespace squall::harness {

/// A quantity [SI] as a function of time [s].
using Curve = std::function<double(double time_s)>;

/// What a closed form is made for.
struct FormulaRequest {
  const Scene& scene;
  std::string quantity;
  const std::map<std::string, double>& parameters;
};

/// A closed form that checks may name.
struct Formula {
  std::string name;
  std::string meaning;                  ///< with its source
  std::vector<std::string> parameters;  ///< those it may be given; what is not given follows from the scene
  Curve (*make)(const FormulaRequest& request);
};

/// All of them, described in docs/validation.md.
const std::vector<Formula>& formulas();

/// The curve of a formula. Throws InputError for an unknown name, parameter or quantity that it does not give, and for
/// a scene that it does not hold for.
Curve make_curve(const std::string& formula, const FormulaRequest& request);

/// The makers; in files of their own where they are more than a line.
Curve make_sloshing(const FormulaRequest& request);
Curve make_sloshing_period(const FormulaRequest& request);
Curve make_ellipsoid(const FormulaRequest& request);

/// A parameter, or `otherwise` if it is not given.
double parameter_or(const FormulaRequest& request, const std::string& name, double otherwise);
/// Throws InputError if it is not given.
double parameter(const FormulaRequest& request, const std::string& name);

/// 0, 1 or 2 for quantities that begin with x, y or z; throws InputError for others.
int axis_of(const FormulaRequest& request);
/// The gauge that the quantity is; null if it is none.
const Scene::Gauge* gauge_of(const FormulaRequest& request);
/// Throws InputError that names the formula's quantities.
[[noreturn]] void refuse_quantity(const FormulaRequest& request, const std::string& formula,
                                  const std::string& allowed);

/// Depth [m] of the scene's water when it is spread evenly over the floor.
double rest_depth(const Scene& scene);

}  // namespace squall::harness
