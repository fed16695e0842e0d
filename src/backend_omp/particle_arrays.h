#pragma once

#include <cstddef>
#include <cstdint>

#include "backend_omp/passes.h"
#include "backend_omp/team_array.h"
#include "core/fields.h"
#include "core/particles.h"

namespace squall::openmp {

/// What the backend keeps of each particle. Behind the last one lies padding, far away from everything.
template <class Scalar>
struct ParticleArrays {
  /// Only arrays that `terms` and `statistics` need have elements.
  ParticleArrays(PassTerms terms, bool statistics, int threads);

  /// Keeps what there is, up to `count` particles.
  void resize(std::size_t count);
  /// Returns how many of them are lost.
  std::int64_t append(const Particles& particles);
  Particles download() const;
  /// Of the first `active` sorted particles.
  Fields fields(std::size_t active) const;
  /// Takes those from `first` on over into the state unchanged: particles that are held or lost.
  void keep_from(std::size_t first);

  std::size_t count = 0;
  TeamArray<Record<Scalar>> state, sorted;  ///< between sub-steps; within one, in canonical order
  TeamArray<std::uint32_t> ids[2];          ///< take turns: the sort reads one and writes the other
  std::size_t ids_now = 0;                  ///< which of the two belongs to `state`
  TeamArray<Scalar> x, y, z;                ///< coordinates of `sorted`
  TeamArray<int> keys;                      ///< of `state`
  TeamArray<Scalar> density;                ///< of `sorted`, like all that follow (PassContext)
  TeamArray<Scalar> pressure, isolation;
  TeamArray<int> neighbours;  ///< when last counted

 private:
  /// p/rho0; wcsph keeps p/rho^2.
  double pressure_of(std::size_t i) const;

  PassTerms terms_;
  bool statistics_;
  int threads_;
};

}  // namespace squall::openmp
