/* Reads:  nothing. Writes: a pattern that the host looks for in its own memory.
   One work-item = one integer. */
__kernel void probe_memory(__global uint* data, uint pattern) {
  data[get_global_id(0)] = pattern + (uint)get_global_id(0);
}
