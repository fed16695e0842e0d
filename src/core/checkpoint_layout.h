#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>

/// How numbers lie in a checkpoint file; private to core.
namespace squall::checkpoint_layout {

inline constexpr std::string_view k_magic{"\x89squall\n", 8};
inline constexpr std::size_t k_preamble_bytes = 24;  ///< magic, version, bytes per number, length: in every version
inline constexpr std::size_t k_header_bytes = 104;
inline constexpr std::size_t k_checksum_bytes = 8;
inline constexpr std::size_t k_numbers_per_particle = 7;  ///< position, velocity, pressure

/// Bytes of everything that is there once per particle.
constexpr std::uint64_t particle_bytes(std::uint64_t number_bytes) { return 4 + k_numbers_per_particle * number_bytes; }

/// Length of a file. Exact below 2^63 for the counts that a header can hold and the loader lets through.
constexpr std::uint64_t file_bytes(std::uint64_t particles, std::uint64_t rains, std::uint64_t text,
                                   std::uint64_t number_bytes) {
  return k_header_bytes + 8 * rains + text + particles * particle_bytes(number_bytes) + k_checksum_bytes;
}

/// Chains every eight bytes through a bijective mix: bytes that differ in one place never give the same.
std::uint64_t checksum(std::string_view bytes);

/// The unsigned integer with the bits of a value.
template <class Value>
auto bits_of(Value value) {
  if constexpr (std::is_same_v<Value, float>)
    return std::bit_cast<std::uint32_t>(value);
  else if constexpr (std::is_same_v<Value, double>)
    return std::bit_cast<std::uint64_t>(value);
  else
    return static_cast<std::make_unsigned_t<Value>>(value);
}

template <class Value>
void put(std::string& bytes, Value value) {
  auto bits = bits_of(value);
  char buffer[sizeof bits];
  for (std::size_t i = 0; i < sizeof bits; ++i) buffer[i] = static_cast<char>((bits >> (8 * i)) & 0xff);
  bytes.append(buffer, sizeof bits);
}

/// Takes numbers off the front. Who calls has checked that the bytes are there.
class Taker {
 public:
  explicit Taker(std::string_view bytes) : rest_(bytes) {}

  template <class Value>
  Value take() {
    decltype(bits_of(Value{})) bits = 0;
    for (std::size_t i = 0; i < sizeof bits; ++i) {
      const auto byte = static_cast<unsigned char>(rest_[i]);
      bits = static_cast<decltype(bits)>(bits | (static_cast<decltype(bits)>(byte) << (8 * i)));
    }
    rest_.remove_prefix(sizeof bits);
    return std::bit_cast<Value>(bits);
  }
  std::string_view take_text(std::size_t length) {
    const std::string_view text = rest_.substr(0, length);
    rest_.remove_prefix(length);
    return text;
  }

 private:
  std::string_view rest_;
};

}  // namespace squall::checkpoint_layout
