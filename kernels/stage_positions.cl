/* Reads:  records. Writes: positions alone, 16 bytes each, in single precision whatever the records are in, for a copy
   to the host.
   One work-item = one particle. */
#include "shared.h"

__kernel void stage_positions(__global const Scalar4* records, __global float4* staging, int count) {
  int i = (int)get_global_id(0);
  if (i < count) staging[i] = (float4)(convert_float3_rte(records[2 * (size_t)i].xyz), 0.0f);
}
