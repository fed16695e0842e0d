#include "backend_omp/particle_arrays.h"

#include <Eigen/Core>
#include <algorithm>

#include "grid.h"

namespace squall::openmp {

template <class Scalar>
ParticleArrays<Scalar>::ParticleArrays(PassTerms terms, bool statistics, int threads)
    : terms_(terms), statistics_(statistics), threads_(threads) {
  resize(0);
}

template <class Scalar>
void ParticleArrays<Scalar>::resize(std::size_t new_count) {
  constexpr Scalar k_far = SQUALL_LOST_COORDINATE;
  const Record<Scalar> far{k_far, k_far, k_far, 0, 0, 0, 0, 0};
  const std::size_t padded = new_count + k_padding;
  state.resize(padded, far, threads_);
  sorted.resize(padded, far, threads_);
  std::fill(sorted.data() + new_count, sorted.data() + padded, far);
  for (auto* coordinates : {&x, &y, &z}) {
    coordinates->resize(padded, k_far, threads_);
    std::fill(coordinates->data() + new_count, coordinates->data() + padded, k_far);
  }
  for (auto& one : ids) one.resize(padded, 0, threads_);
  keys.resize(padded, 0, threads_);
  density.resize(padded, Scalar(1), threads_);
  if (statistics_) neighbours.resize(padded, 0, threads_);
  if (terms_.pressure == Pressure::mueller) pressure.resize(padded, Scalar(0), threads_);
  if (terms_.drag) isolation.resize(padded, Scalar(0), threads_);
  count = new_count;
}

template <class Scalar>
std::int64_t ParticleArrays<Scalar>::append(const Particles& particles) {
  std::int64_t lost = 0;
  const std::size_t first = count;
  resize(count + particles.size());
  for (std::size_t i = 0; i < particles.size(); ++i) {
    const auto at = particles.positions[i].cast<Scalar>().eval(), v = particles.velocities[i].cast<Scalar>().eval();
    const auto pressure_now = static_cast<Scalar>(particles.pressures[i]);
    state[first + i] = {at.x(), at.y(), at.z(), pressure_now, v.x(), v.y(), v.z(), 0};
    ids[ids_now][first + i] = particles.ids[i];
    lost += is_lost(at.x());
  }
  return lost;
}

template <class Scalar>
Particles ParticleArrays<Scalar>::download() const {
  using Vector = Eigen::Matrix<Scalar, 3, 1>;
  Particles particles;
  particles.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const Record<Scalar>& r = state[i];
    particles.add(ids[ids_now][i], Vector(r.x, r.y, r.z).template cast<double>(),
                  Vector(r.vx, r.vy, r.vz).template cast<double>(),
                  terms_.pressure == Pressure::dfsph ? static_cast<double>(r.pressure_term) : 0.0);
  }
  return particles;
}

template <class Scalar>
Fields ParticleArrays<Scalar>::fields(std::size_t active) const {
  Fields fields;
  for (std::size_t i = 0; i < active; ++i) {
    fields.densities.push_back(static_cast<double>(density[i]));
    fields.pressures.push_back(pressure_of(i));
    if (statistics_) fields.neighbours.push_back(neighbours[i]);
  }
  return fields;
}

template <class Scalar>
double ParticleArrays<Scalar>::pressure_of(std::size_t i) const {
  if (terms_.pressure == Pressure::dfsph) return static_cast<double>(state[i].pressure_term);
  if (terms_.pressure == Pressure::mueller) return static_cast<double>(pressure[i]);
  const double relative = static_cast<double>(density[i]);
  return static_cast<double>(sorted[i].pressure_term) * relative * relative;
}

template <class Scalar>
void ParticleArrays<Scalar>::keep_from(std::size_t first) {
  std::copy(sorted.data() + first, sorted.data() + count, state.data() + first);
}

template struct ParticleArrays<float>;
template struct ParticleArrays<double>;

}  // namespace squall::openmp
