/* Reads:  records. Writes: positions alone, 16 bytes each, for a copy to the host.
   One work-item = one particle. */
__kernel void stage_positions(__global const float4* records, __global float4* staging, int count) {
  int i = (int)get_global_id(0);
  if (i < count) staging[i] = (float4)(records[2 * (size_t)i].xyz, 0.0f);
}
