#pragma once

#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "harness/study/record.h"

namespace squall::harness {

inline constexpr double k_no_end = std::numeric_limits<double>::infinity();

/// The observables whose errors make up an error: itself, or those of the combined one.
std::vector<std::string> parts_of(const std::string& error);

/// Whether a record has a value of an observable at any output time, and a scale to hold it against.
bool has_value(const Record& record, const std::string& observable);

/// Root mean square of the difference of an observable, each over its own scale, over the output times up to `until_s`
/// at which both have a value; of the combined error that of its observables, those left out that neither has. Empty if
/// the times are not the same, if only one of them has an observable, or if they have none at the same time.
std::optional<double> difference(const Record& a, const Record& b, const std::string& error, double until_s = k_no_end);

/// The same against the exact value 0, over the times at which the record has a value.
std::optional<double> size_of(const Record& record, const std::string& error, double until_s = k_no_end);

/// Whether an error needs no reference, as its exact value is 0.
bool is_exact(const std::string& error);

/// How far apart runs lie that differ in nothing but a start shifted by some 1e-6 dx.
struct Noise {
  std::map<std::string, double> spread;  ///< of each error: standard deviation, root mean square over the output times
  int starts = 0;                        ///< runs it is of, the unperturbed one included
};

/// Standard deviation between records, over output times up to `until_s`; errors that a record lacks are left out.
/// Empty for fewer than two records.
std::optional<Noise> noise_of(const std::vector<const Record*>& records, double until_s = k_no_end);

/// Difference of two runs below which it says nothing: twice the spread of both, taken together as (a^2 + b^2)/2.
double noise_floor(double spread_a, double spread_b);

/// Median over the tracked particles of the distance between their places in two records [dx], at output time `index`.
/// Empty if one has no such time or follows other particles.
std::optional<double> separation(const Record& a, const Record& b, std::size_t index);

/// How perturbed starts leave the unperturbed one.
struct Growth {
  std::vector<double> time_s, separation_dx;  ///< median over starts
  std::optional<double> rate_per_s;           ///< Lyapunov exponent: slope of ln(separation) from 2e-6 to 0.1 dx
  std::optional<double> horizon_s;            ///< last output time at which it is below 0.1 dx; empty if at none
  bool horizon_reached = false;               ///< it rose above 0.1 dx within the study's time
};
inline constexpr double k_horizon_dx = 0.1;

/// `records`: the unperturbed run, then the perturbed ones. Empty for fewer than two, or without tracks.
std::optional<Growth> growth_of(const std::vector<const Record*>& records);

/// Order of convergence p of f(h) = f(0) + C h^p from the differences between h1 > h2 > h3: solves
/// d12/d23 = (h1^p - h2^p)/(h2^p - h3^p), which is p = ln(d12/d23)/ln 2 where h is halved twice. Empty where no p in
/// [0.05, 8] does.
std::optional<double> order_of(double h1, double h2, double h3, double d12, double d23);

}  // namespace squall::harness
