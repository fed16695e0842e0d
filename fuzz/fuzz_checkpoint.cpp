// Checkpoints: any bytes are one or an InputError; one that is accepted is written and read again to the same bytes.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <string>

#include "core/checkpoint.h"
#include "core/checkpoint_layout.h"
#include "core/errors.h"

namespace {

using namespace squall;

void try_decode(const std::string& bytes) {
  try {
    const std::string again = encode_checkpoint(decode_checkpoint(bytes, "fuzz.sqc"));
    if (encode_checkpoint(decode_checkpoint(again, "fuzz.sqc")) != again) std::abort();
  } catch (const InputError&) {
  }
}

/// With magic, version, length and checksum put right, so that what lies behind them is reached.
std::string sealed(std::string bytes) {
  using namespace checkpoint_layout;
  if (bytes.size() < k_header_bytes + k_checksum_bytes) return bytes;
  const std::uint32_t version = k_checkpoint_version;
  const std::uint64_t length = bytes.size();
  std::memcpy(bytes.data(), k_magic.data(), k_magic.size());
  std::memcpy(bytes.data() + 8, &version, sizeof version);
  std::memcpy(bytes.data() + 16, &length, sizeof length);
  const std::uint64_t sum = checksum(std::string_view(bytes).substr(0, bytes.size() - k_checksum_bytes));
  std::memcpy(bytes.data() + bytes.size() - k_checksum_bytes, &sum, sizeof sum);
  return bytes;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  try_decode(bytes);
  try_decode(sealed(bytes));
  return 0;
}
