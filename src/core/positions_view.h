#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <cstring>

#include "grid.h"

namespace squall {

/// How a delivered position is written.
enum class PositionFormat {
  float32,  ///< three floats, m
  unorm16,  ///< three unsigned 16-bit codes: coordinate = offset + code * scale; k_lost_code in each: a lost particle
};

/// Code of lost particles in unorm16; all others have smaller ones.
inline constexpr std::uint16_t k_lost_code = 65535;

/// Delivered positions where they lie, in m, relative to the container's min corner and in its frame. Particle i has
/// its x, y, z in `format` at `stride * i` bytes from `data`: what a vertex buffer takes, or call position(i).
///
/// Valid until the next call on the solver. With Readback::async the memory lives one frame longer: another thread may
/// read it while the next advance() runs.
struct PositionsView {
  const void* data = nullptr;
  PositionFormat format = PositionFormat::float32;
  std::size_t stride = 0;  ///< bytes
  std::size_t count = 0;
  /// Frames that were complete when the water was so: the solver's clock().frame, or with latency that many fewer.
  std::uint64_t frame = 0;
  Eigen::Vector3f offset = Eigen::Vector3f::Zero();  ///< m, for unorm16
  Eigen::Vector3f scale = Eigen::Vector3f::Ones();   ///< m per code, for unorm16

  /// Bytes of one position, without what lies between two of them.
  std::size_t position_bytes() const { return 3 * (format == PositionFormat::unorm16 ? 2 : 4); }

  /// Position of particle i < count [m]; 1e30 in every coordinate for a lost one.
  Eigen::Vector3f position(std::size_t i) const {
    const char* at = static_cast<const char*>(data) + i * stride;
    if (format == PositionFormat::float32) {
      float x[3];
      std::memcpy(x, at, sizeof x);
      return {x[0], x[1], x[2]};
    }
    std::uint16_t code[3];
    std::memcpy(code, at, sizeof code);
    if (code[0] == k_lost_code) return Eigen::Vector3f::Constant(SQUALL_LOST_COORDINATE);
    const Eigen::Vector3f codes(code[0], code[1], code[2]);
    return offset + codes.cwiseProduct(scale);
  }

  /// How far a coordinate of position(i) may be from the solver's own [m]: 0 for float32. For unorm16 half a code by
  /// rounding to codes, and 3 roundings (the step's inverse, into codes, and back) of up to 65534 codes, 2^-24 each.
  /// Coordinates outside the range of codes are shown at its ends: only a held particle that was loaded outside the
  /// container can have such.
  Eigen::Vector3f error_bound() const {
    constexpr float k_codes = 0.512f;
    return format == PositionFormat::unorm16 ? Eigen::Vector3f(k_codes * scale) : Eigen::Vector3f::Zero();
  }

  /// Particle i is not finite or far away, and is not to be drawn (FrameReport::lost counts them).
  bool lost(std::size_t i) const { return is_lost(position(i).x()) != 0; }
};

}  // namespace squall
