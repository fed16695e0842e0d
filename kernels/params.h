/* The constants of one run, as every backend and every kernel sees them. Built once, in double, by core (make_params)
   and rounded once; never passed as -D text. Lengths in m, relative to the container's min corner and in its frame;
   densities relative to rest density; pressures divided by rest density. */
#ifndef SQUALL_PARAMS_H
#define SQUALL_PARAMS_H

#include "shared.h"

SQUALL_NAMESPACE_BEGIN

/* Smoothing kernels as wall integrals know them. */
#define SQUALL_CUBIC 0
#define SQUALL_POLY6 1
#define SQUALL_SPIKY 2
#define SQUALL_BELL 3

/* Where a lost particle is kept, in m, and the coordinate from which on a particle counts as lost. */
#define SQUALL_LOST_COORDINATE 1e30f
#define SQUALL_LOST_FROM 1e29f

SQUALL_STRUCT(Params) {
  /* grid (grid.h) */
  int cells_x, cells_y, cells_z;
  int cell_count;
  Scalar inverse_edge_x, inverse_edge_yz; /* 1/m */

  /* container */
  Scalar size_x, size_y, size_z; /* m */
  Scalar lid;                    /* 1: the top is a wall; 0: open */
  Scalar clamp_distance;         /* m: particles are kept this far inside */
  Scalar lost_distance;          /* m: outside by more than this is lost */

  /* support */
  Scalar support_radius;          /* H, m */
  Scalar support_squared;         /* H^2 */
  Scalar list_squared;            /* H^2 (1 + 1e-5): neighbours are listed up to here, so that no rounding loses one */
  Scalar inverse_support;         /* 1/H */
  Scalar inverse_half_support;    /* 2/H */
  Scalar inverse_support_squared; /* 1/H^2 */
  Scalar softening;               /* 0.01 (H/2)^2: keeps viscosity finite at r = 0 */
  Scalar tiny;                    /* 1e-20 m: keeps x/r finite at r = 0 */

  /* density and forces; what each multiplies is said in sph_formulas.h */
  Scalar density_scale;
  Scalar force_scale;
  Scalar stiffness;        /* wcsph: c^2/7; mueller: k; m^2/s^2 */
  Scalar tension;          /* 1 keeps negative pressure, 0 clamps it */
  Scalar artificial_scale; /* wcsph: alpha (H/2) c / 2, m^2/s */
  Scalar viscosity_scale;  /* wcsph: 5 nu; mueller: 2 nu dx^3 45/(pi H^5); dfsph: 187/7 nu/H^2 */

  /* dfsph (dfsph_formulas.h) */
  Scalar response_guard;       /* 1/m^4: particles whose response is below its root feel no pressure of their own */
  Scalar largest_warm_impulse; /* m^2: the largest impulse to start from, times the time step */
  Scalar free_density;         /* relative density below which a particle may be compressed freely */
  Scalar smoothing_scale;      /* 1/s: xsph/dt_max density_scale */
  Scalar core_share;           /* largest share of a wall's core (wall_cores.h); 0: none */
  Scalar inverse_core_reach;   /* 1/m */

  /* walls: how far the planes lie behind the container's faces, per kernel, m */
  Scalar density_wall_shift;
  Scalar force_wall_shift;

  /* air */
  Scalar drag_coefficient; /* g/v_t^2, 1/m; 0 without rain */
  Scalar self_value;       /* kernel sum of a particle alone */
  Scalar steepness;        /* 2^30 */

  /* fractions that no type may round on its own */
  Scalar thirtieth, fifth, two_hundred_fifty_sixth, one_half;
}
SQUALL_STRUCT_END(Params);

/* What one sub-step needs: a row of the frame's table. */
SQUALL_STRUCT(Substep) {
  Scalar dt;                                             /* s: the drift */
  Scalar kick;                                           /* s: (dt_previous + dt)/2 */
  Scalar acceleration_x, acceleration_y, acceleration_z; /* m/s^2: gravity minus the container's acceleration */
  Scalar wind_x, wind_y, wind_z;                         /* m/s, relative to the container */
  int box_count;                                         /* boxes [0, box_count) still stand */
  int held_count;                                        /* held groups [0, held_count) are still held */
  int released_count;     /* groups [held_count, held_count + released_count) are freed now */
  int statistics;         /* 1 in the sub-step whose state the frame report describes */
  Scalar previous_dt;     /* s: for the half kick taken back from particles freed now */
  Scalar warm_kick;       /* s: dfsph starts from this times the pressure so far; 0: from no pressure */
  Scalar inverse_kick;    /* 1/s */
  Scalar relaxation_rate; /* 1/s: dfsph, relaxation/dt */
  Scalar correction;      /* dfsph: how much mean over-density goes away in this sub-step at most */
  Scalar reserved_0, reserved_1, reserved_2;
}
SQUALL_STRUCT_END(Substep);

/* A solid box. Its faces as walls of the fluid's density and force lie shifted into the box, as the container's do. */
SQUALL_STRUCT(Box) {
  Scalar solid_min[3], solid_max[3];
  Scalar density_min[3], density_max[3];
  Scalar force_min[3], force_max[3];
}
SQUALL_STRUCT_END(Box);

/* Ids [first_id, end_id) are held: fixed, feeling nothing and seen by nobody. */
#ifdef __cplusplus
struct HeldGroup {
  std::uint32_t first_id, end_id;
};
#else
typedef struct {
  uint first_id, end_id;
} HeldGroup;
#endif

SQUALL_NAMESPACE_END

#endif
