#include "harness/stress/stress.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <utility>

#include "core/errors.h"
#include "harness/stress/cases.h"

namespace squall::harness {

namespace {

using namespace stress;

constexpr std::array k_cases{
    StressCase{1, "two in one place", "no NaN; they part gently or stay", true, coincident_pair},
    StressCase{2, "1000 at one point", "no NaN, bounded speed, none lost", true, heap_at_a_point},
    StressCase{3, "r = H, just inside, H/2", "as the reference in double; symmetric", true, ends_of_the_kernel},
    StressCase{4, "one particle alone", "its parabola", true, lone_particle},
    StressCase{5, "0, 1, 2 particles", "100 steps like any other", true, hardly_any},
    StressCase{6, "a layer, a row, a column", "they come to rest", true, thin_layers},
    StressCase{7, "36 layers at rest", "compression below 1 %, no divergence", true, tall_column},
    StressCase{8, "impact at 2.8 and 4.4 m/s", "no tunnelling, no energy from nowhere", true, impact},
    StressCase{9, "no viscosity in a dam break", "no energy from nowhere", true, mixed_kernels},
    StressCase{10, "a start 0.1 to 70 % too dense", "no explosion at any time step", true, over_dense_start},
    StressCase{11, "a lattice in the corners", "rest density everywhere", true, corner_lattice},
    StressCase{12, "a block pulled apart", "no clumps", true, stretched},
    StressCase{13, "a kernel of H = 3 dx", "no pairing", true, pairing},
    StressCase{14, "the largest stable step", "what is taken lies below it", false, largest_step},
    StressCase{15, "steps 20 times too long", "sub-steps", true, oversized_steps},
    StressCase{16, "k = 1e5 with the step of 3", "sub-steps", true, stiff_with_soft_step},
    StressCase{17, "viscosity 1e-6 and 100 m^2/s", "motion dies down, never grows", true, extreme_viscosity},
    StressCase{18, "residents of planes and corners", "put in, gently", true, corner_residents},
    StressCase{19, "particles outside", "put back, or lost and counted", true, outsiders},
    StressCase{20, "NaN, infinity, 1e38", "lost and counted; no other bit changes", true, not_numbers},
    StressCase{21, "all in one cell", "neighbours as by brute force", true, all_in_one_cell},
    StressCase{22, "densities of 1:1000", "refused, or scale-free", true, extreme_densities},
    StressCase{23, "1.7 km from the origin", "the same water", true, far_from_the_origin},
    StressCase{24, "a million steps at rest", "no heat, no leak, no drift", true, long_rest},
    StressCase{25, "10 g for 50 ms, both ways", "it follows, and nobody tunnels", true, jerk},
    StressCase{26, "walls that outrun a step", "nobody on the wrong side; jumps refused", true, fast_walls},
    StressCase{27, "gaps of dx and dx/2", "no explosion", true, thin_gaps},
    StressCase{28, "denormal speeds", "harmless", true, denormals},
    StressCase{29, "order, threads, widths", "rounding apart the same; threads to the bit", true, order},
    StressCase{30, "solves that cannot converge", "finite, reported; nonsense refused", true, few_iterations},
    StressCase{31, "steps that change tenfold", "no kick from the warm start", true, abrupt_steps},
    StressCase{32, "a drop meets whatever there is", "no speed from overlap", true, drops},
    StressCase{33, "walls that vanish", "the water falls, and does not burst", true, vanishing_walls},
    StressCase{34, "first and last cells", "neighbours as by brute force", true, edges_of_the_grid},
};

bool refused_by_nan(double value, double limit) { return std::isnan(value) || std::isnan(limit); }

}  // namespace

bool StressFinding::holds() const {
  switch (relation) {
    case Relation::at_most:
      return !refused_by_nan(value, limit) && value <= limit;
    case Relation::at_least:
      return !refused_by_nan(value, limit) && value >= limit;
    case Relation::equal:
      return value == limit;
    case Relation::information:
      break;
  }
  return true;
}

void StressOutcome::at_most(std::string what, double value, double limit) {
  findings.push_back({std::move(what), value, StressFinding::Relation::at_most, limit});
}
void StressOutcome::at_least(std::string what, double value, double limit) {
  findings.push_back({std::move(what), value, StressFinding::Relation::at_least, limit});
}
void StressOutcome::equal(std::string what, double value, double limit) {
  findings.push_back({std::move(what), value, StressFinding::Relation::equal, limit});
}
void StressOutcome::information(std::string what, double value) {
  findings.push_back({std::move(what), value, StressFinding::Relation::information, 0.0});
}

bool StressOutcome::holds() const {
  return error.empty() &&
         std::all_of(findings.begin(), findings.end(), [](const StressFinding& finding) { return finding.holds(); });
}

std::span<const StressCase> stress_cases() { return k_cases; }

const char* to_string(StressVerdict verdict) {
  switch (verdict) {
    case StressVerdict::passed:
      return "passed";
    case StressVerdict::failed_as_expected:
      return "failed_as_expected";
    case StressVerdict::not_applicable:
      return "not_applicable";
    case StressVerdict::failed:
      return "failed";
    case StressVerdict::passed_unexpectedly:
      break;
  }
  return "passed_unexpectedly";
}

namespace {

bool covers(const KnownStressFailure& known, const StressResult& result, const StressFinding& finding) {
  return known.number == result.tried->number && known.pressure == result.subject.settings.pressure &&
         finding.what.rfind(known.finding, 0) == 0;
}

/// Every failed finding is a known one, and every known failure is met by a finding that fails.
StressVerdict judge(StressResult& result) {
  const auto& findings = result.outcome.findings;
  if (!result.outcome.not_applicable.empty()) return StressVerdict::not_applicable;
  bool unknown = !result.outcome.error.empty(), out_of_date = false;
  for (const StressFinding& finding : findings) {
    const bool known = std::any_of(known_failures().begin(), known_failures().end(),
                                   [&](const auto& entry) { return covers(entry, result, finding); });
    unknown = unknown || (!finding.holds() && !known);
  }
  for (const KnownStressFailure& known : known_failures()) {
    if (known.number != result.tried->number || known.pressure != result.subject.settings.pressure) continue;
    const bool met = std::any_of(findings.begin(), findings.end(), [&](const StressFinding& finding) {
      return !finding.holds() && covers(known, result, finding);
    });
    if (met && result.why.find(known.why) == std::string::npos)
      result.why += (result.why.empty() ? "" : "; ") + std::string(known.why);
    out_of_date = out_of_date || !met;
  }
  if (unknown) return StressVerdict::failed;
  if (out_of_date) return StressVerdict::passed_unexpectedly;
  return result.why.empty() ? StressVerdict::passed : StressVerdict::failed_as_expected;
}

}  // namespace

StressResult try_case(const StressCase& tried, const StressSubject& subject, const StressFactory& make, bool quick) {
  StressResult result;
  result.tried = &tried;
  result.subject = subject;
  const auto start = std::chrono::steady_clock::now();
  try {
    tried.run(StressBench(make, subject, quick), result.outcome);
  } catch (const DeviceError&) {
    throw;
  } catch (const std::exception& error) {
    result.outcome.error = error.what();
  }
  result.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  result.verdict = judge(result);
  return result;
}

}  // namespace squall::harness
