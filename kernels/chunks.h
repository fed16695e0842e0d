/* Chunks: contiguous ranges of particles (or cells), one work-item each, where order matters or a sum is made; and what
   each chunk of particles reports about a frame. */
#ifndef SQUALL_CHUNKS_H
#define SQUALL_CHUNKS_H

#ifdef __cplusplus

#include <cstdint>

namespace squall {

/// What a chunk of particles reports at the end of a frame.
template <class Scalar>
struct ChunkSummary {
  std::int64_t density_error;  ///< sum of clamp(max0(rho/rho0 - 1)) 2^32 over active particles
  std::int64_t neighbours;     ///< within H, without self, over active particles
  Scalar max_speed2;           ///< largest |v|^2 of the frame, m^2/s^2
  Scalar max_acceleration2;    ///< m^2/s^4
  Scalar max_density;          ///< relative
  std::int32_t lost;
  std::int32_t active;  ///< of all chunks; the first one reports it
  std::int32_t clamps;  ///< likewise, over the frame
};
static_assert(sizeof(ChunkSummary<float>) == 40 && sizeof(ChunkSummary<double>) == 56);

}  // namespace squall

#else

#include "shared.h"

typedef struct {
  long density_error, neighbours;
  Scalar max_speed2, max_acceleration2, max_density;
  int lost, active, clamps;
} ChunkSummary;

/* First of the `count` things that belong to chunk `chunk` of `chunks`. */
static inline int chunk_begin(int count, int chunk, int chunks) { return (int)((long)count * chunk / chunks); }

#endif
#endif
