#pragma once

#include <cstddef>

#if defined(__SANITIZE_ADDRESS__)
#define SQUALL_POISONS 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define SQUALL_POISONS 1
#endif
#endif
#ifdef SQUALL_POISONS
#include <sanitizer/asan_interface.h>
#endif

namespace squall::openmp {

/// Of memory with room for `capacity` values the first `size` may be touched. Under AddressSanitizer the rest, which is
/// there to grow into, is reported like memory that is not ours; elsewhere this does nothing.
template <class T>
void put_out_of_reach([[maybe_unused]] T* memory, [[maybe_unused]] std::size_t size,
                      [[maybe_unused]] std::size_t capacity) {
#ifdef SQUALL_POISONS
  __asan_unpoison_memory_region(memory, size * sizeof(T));
  __asan_poison_memory_region(memory + size, (capacity - size) * sizeof(T));
#endif
}

}  // namespace squall::openmp
