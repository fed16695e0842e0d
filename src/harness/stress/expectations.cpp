#include <array>

#include "harness/stress/stress.h"

namespace squall::harness {

namespace {

constexpr auto mueller = Pressure::mueller;
constexpr auto wcsph = Pressure::wcsph;
constexpr auto dfsph = Pressure::dfsph;

constexpr const char* k_creates_energy =
    "density and forces use different kernels and half the pressure gradient, as printed in 2003: they derive from no "
    "energy, so motion feeds on itself (docs/physics.md)";
constexpr const char* k_elastic =
    "an equation of state stores what it is compressed by, and gives it back at once: the start's energy is more than "
    "what it weighs";
constexpr const char* k_bounces =
    "walls push back elastically and viscosity acts between neighbours alone: what is one particle thick bounces on";
constexpr const char* k_clamped =
    "one particle above the floor weighs too little to feel its pressure: it is the safety net that stops it";
constexpr const char* k_rim =
    "the block's lower edges: beside a free side water is less dense than at rest right down to the floor, so no "
    "pressure acts there: it is the safety net that stops it";
constexpr const char* k_pairs = "the kernel's slope falls toward its middle: wide kernels let particles pair up";
constexpr const char* k_sound = "pressure passes on at the speed of sound: it is still there when the walls are gone";
constexpr const char* k_undamped =
    "water without viscosity keeps its motion: what a lattice gains by packing more densely, nothing takes away";
constexpr const char* k_corrects =
    "compression is taken back by speed, and speed stays: as much at once as makes 8 % of a fall through half the "
    "depth "
    "(docs/dfsph.md)";
constexpr const char* k_pulled =
    "nothing pushes where water is less dense than at rest: particles may come close there";
constexpr const char* k_jets =
    "where the front meets the far wall, those of its particles that come first shoot up it, a tenth faster than any "
    "front; all but eight stay below 1.9 m/s";
constexpr const char* k_inside = "nothing keeps a drop from being put into water; above it, it is not";

constexpr std::array k_known{
    KnownStressFailure{6, wcsph, "", k_bounces},
    KnownStressFailure{6, mueller, "", k_bounces},
    KnownStressFailure{6, dfsph, "layer: mean speed", k_undamped},
    KnownStressFailure{6, dfsph, "layer: spread", k_undamped},
    KnownStressFailure{6, dfsph, "row: mean speed", k_undamped},
    KnownStressFailure{6, dfsph, "column: mean speed", k_undamped},
    KnownStressFailure{7, wcsph, "",
                       "water settles some 5 % denser than the lattice it starts on, and goes on rearranging"},
    KnownStressFailure{7, mueller, "", k_creates_energy},
    KnownStressFailure{7, dfsph, "mean speed", k_undamped},
    KnownStressFailure{8, wcsph, "from", k_clamped},
    KnownStressFailure{8, mueller, "from", k_clamped},
    KnownStressFailure{8, dfsph, "from", k_rim},
    KnownStressFailure{9, mueller, "", k_creates_energy},
    KnownStressFailure{10, wcsph, "energy", k_elastic},
    KnownStressFailure{10, mueller, "energy", k_elastic},
    KnownStressFailure{10, dfsph, "energy", k_corrects},
    KnownStressFailure{12, dfsph, "smallest", k_pulled},
    KnownStressFailure{12, mueller, "smallest", k_creates_energy},
    KnownStressFailure{13, wcsph, "share", k_pairs},
    KnownStressFailure{13, mueller, "share", k_pairs},
    KnownStressFailure{14, mueller, "c = 20", k_creates_energy},
    KnownStressFailure{15, mueller, "", k_creates_energy},
    KnownStressFailure{16, mueller, "energy", k_creates_energy},
    KnownStressFailure{24, mueller, "", k_creates_energy},
    KnownStressFailure{24, dfsph, "change of energy", k_undamped},
    KnownStressFailure{27, dfsph, "gap of dx: fastest", k_jets},
    KnownStressFailure{27, dfsph, "gap of dx/2: fastest", k_jets},
    KnownStressFailure{27, mueller, "gap of dx:", k_creates_energy},
    KnownStressFailure{31, dfsph, "change of energy", k_corrects},
    KnownStressFailure{32, wcsph, "water around it", k_inside},
    KnownStressFailure{32, dfsph, "water around it", k_inside},
    KnownStressFailure{33, wcsph, "acceleration of one", k_sound},
    KnownStressFailure{33, dfsph, "acceleration of one", k_corrects},
    KnownStressFailure{33, mueller, "acceleration of one", k_sound},
};

}  // namespace

std::span<const KnownStressFailure> known_failures() { return k_known; }

}  // namespace squall::harness
