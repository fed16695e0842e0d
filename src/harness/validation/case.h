#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/scene.h"
#include "core/settings.h"

namespace squall::harness {

/// A value that something should have at a time, and how far repeated measurements of it lie apart.
struct ExpectedPoint {
  double time_s = 0.0, value = 0.0;
  std::optional<double> low = {}, high = {};  ///< low <= value <= high
};

/// What a check holds the measured quantity against; exactly one of its parts.
struct Expectation {
  std::optional<double> value;               ///< the same at all times
  std::vector<ExpectedPoint> points;         ///< a table
  std::string formula;                       ///< a closed form (formulas.h)
  std::map<std::string, double> parameters;  ///< of the formula
  std::string like;                          ///< another quantity of the same run
};

/// How the difference of measured m and expected e becomes one number (docs/validation.md).
enum class Measure { max, rms, mean, slope, line, period, below, above };
const char* to_string(Measure measure);

/// A solver that should fail a check, and why.
struct KnownFailure {
  Pressure pressure = Pressure::mueller;
  std::string reason;
};

/// One quantity of a case held against what it should be.
struct Check {
  std::string name;
  std::string quantity;
  Expectation expected;
  std::optional<double> from_s, to_s;     ///< only this part of the run
  std::optional<double> largest_shift_s;  ///< fit one shift in time, at most this far
  Measure measure = Measure::max;
  bool relative = false;        ///< errors are shares of the expected value
  std::optional<double> scale;  ///< else: errors are in units of this, given in the quantity's unit
  double tolerance = 0.0;       ///< in the error's unit
  double tolerance_dx = 0.0;    ///< and so many spacings, for lengths
  std::string tolerance_why;
  std::string source;
  std::vector<KnownFailure> fails;
};

/// A scene and what should happen in it (docs/validation.md).
struct Case {
  std::string name;  ///< the file's stem
  std::string title, source;
  Scene scene;
  std::vector<Pressure> solvers;                ///< those that take part
  std::optional<std::int64_t> particles;        ///< scale the scene to about so many
  std::optional<std::int64_t> quick_particles;  ///< --quick and the reference backend
  double duration_s = 0.0;
  int samples_per_frame = 1;  ///< states looked at per frame of the scene
  std::vector<Check> checks;
  std::vector<std::string> files;  ///< it was read from; none of a case that comes with squall
};

/// What a case is where its file says nothing: all solvers that can run its scene, for as long as that says, with
/// enough samples for means of pressures.
void set_defaults(Case& result);
/// How long its runs are [s]: duration_s, up to a whole sample.
double duration_of(const Case& of);
/// Most samples per frame of a scene: 64, and no more than 1000 a second.
int most_samples(const Scene& scene);

/// A case from its file's text; the scene and tables it names are read by `read` and lie relative to `path`. Throws
/// InputError with file:line:column, the value, what is allowed and the nearest name of an unknown key or quantity.
Case parse_case(const std::string& text, const std::string& path, const FileReader& read);

/// The same from a file.
Case load_case(const std::string& path);

/// A case from a scene and a table of expected values, both files: a check per column, the rms difference over the
/// column's largest value, which may be at most `tolerance`. It runs as long as the table
/// says, whose times begin at 0. Throws InputError like load_case().
Case case_from_table(const std::string& scene_path, const std::string& table_path, double tolerance);

/// A table of expected values from CSV text: a header with time_s first and, for each quantity, a column of its name
/// and, if its spread is known, name_low and name_high. Times rise from line to line; cells of values may be empty.
/// Lines that start with # are comments. Throws InputError with file:line.
std::map<std::string, std::vector<ExpectedPoint>> parse_expected_csv(const std::string& text, const std::string& path);

/// Why a time [s] cannot follow another (absent: it is the first) in a table; empty if it can.
std::string order_problem(const std::optional<double>& before_s, double time_s);
/// What is wrong with how far repeated measurements lie apart: low <= value <= high. Empty if nothing is.
std::string spread_problem(const ExpectedPoint& point);

}  // namespace squall::harness
