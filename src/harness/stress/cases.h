#pragma once

#include "harness/stress/bench.h"

/// One function per case of docs/stress.md; the table of them is in stress.cpp.
namespace squall::harness::stress {

using Bench = const StressBench&;
using Outcome = StressOutcome&;

// few.cpp: states of hardly any particles
void coincident_pair(Bench bench, Outcome outcome);
void ends_of_the_kernel(Bench bench, Outcome outcome);
void lone_particle(Bench bench, Outcome outcome);
void hardly_any(Bench bench, Outcome outcome);
void not_numbers(Bench bench, Outcome outcome);
void denormals(Bench bench, Outcome outcome);

// crowds.cpp: too many in one place
void heap_at_a_point(Bench bench, Outcome outcome);
void over_dense_start(Bench bench, Outcome outcome);
void all_in_one_cell(Bench bench, Outcome outcome);
void pairing(Bench bench, Outcome outcome);
void stretched(Bench bench, Outcome outcome);

// rest.cpp: water that should do nothing
void thin_layers(Bench bench, Outcome outcome);
void tall_column(Bench bench, Outcome outcome);
void corner_lattice(Bench bench, Outcome outcome);
void long_rest(Bench bench, Outcome outcome);

// walls.cpp
void corner_residents(Bench bench, Outcome outcome);
void outsiders(Bench bench, Outcome outcome);
void thin_gaps(Bench bench, Outcome outcome);
void edges_of_the_grid(Bench bench, Outcome outcome);
void far_from_the_origin(Bench bench, Outcome outcome);
void vanishing_walls(Bench bench, Outcome outcome);

// motion.cpp: impacts and moving containers
void impact(Bench bench, Outcome outcome);
void mixed_kernels(Bench bench, Outcome outcome);
void jerk(Bench bench, Outcome outcome);
void fast_walls(Bench bench, Outcome outcome);
void drops(Bench bench, Outcome outcome);

// steps.cpp: time steps and parameters
void largest_step(Bench bench, Outcome outcome);
void oversized_steps(Bench bench, Outcome outcome);
void stiff_with_soft_step(Bench bench, Outcome outcome);
void extreme_viscosity(Bench bench, Outcome outcome);
void few_iterations(Bench bench, Outcome outcome);
void abrupt_steps(Bench bench, Outcome outcome);
void extreme_densities(Bench bench, Outcome outcome);

// order.cpp
void order(Bench bench, Outcome outcome);

}  // namespace squall::harness::stress
