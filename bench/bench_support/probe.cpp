#include "bench_support/probe.h"

namespace squall::bench {

const char* to_string(Operation operation) {
  switch (operation) {
    case Operation::fma:
      return "fma";
    case Operation::multiply:
      return "mul";
    case Operation::add:
      return "add";
    case Operation::mixed:
      return "mul+add";
    case Operation::square_root:
      return "sqrt";
    case Operation::divide:
      return "div";
  }
  return "?";
}

const char* to_string(Stream stream) {
  return stream == Stream::copy ? "copy" : stream == Stream::scale ? "scale" : "triad";
}

std::size_t bytes_per_element(Stream stream) { return (stream == Stream::triad ? 3 : 2) * sizeof(float); }

const Probe& probe_for(Simd simd) {
#ifdef SQUALL_HAS_X86_SIMD
  if (simd == Simd::avx512) return avx512_probe();
  if (simd == Simd::avx2) return avx2_probe();
#endif
  (void)simd;
  return scalar_probe();
}

}  // namespace squall::bench
