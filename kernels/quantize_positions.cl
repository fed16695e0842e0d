/* Reads:  records. Writes: three 16-bit codes per particle, 6 bytes, for the host: round(coordinate / step), steps from
   the container's min corner; coordinates are rounded to single precision first, those beyond the range kept at its
   ends. 65535 is left for lost particles. One work-item = one particle. */
#include "grid.h"

#define LARGEST_CODE 65534.0f
#define LOST_CODE 65535

static inline ushort code_of(float coordinate, float inverse_step) {
  return convert_ushort_rte(clamp(coordinate * inverse_step, 0.0f, LARGEST_CODE));
}

__kernel void quantize_positions(__global const Scalar4* records, __global ushort* codes, float4 inverse_steps,
                                 int count) {
  int i = (int)get_global_id(0);
  if (i >= count) return;
  float4 position = convert_float4_rte(records[2 * (size_t)i]);
  int lost = is_lost(position.x);
  __global ushort* code = codes + 3 * (size_t)i;
  code[0] = lost ? LOST_CODE : code_of(position.x, inverse_steps.x);
  code[1] = lost ? LOST_CODE : code_of(position.y, inverse_steps.y);
  code[2] = lost ? LOST_CODE : code_of(position.z, inverse_steps.z);
}
