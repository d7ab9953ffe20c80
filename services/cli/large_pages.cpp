#include "cli/large_pages.hpp"

#include <cstddef>
#include <cstdint>
#include <cstdlib>

#ifdef __GLIBC__
#include <malloc.h>
#include <sys/mman.h>
#include <unistd.h>
#endif

namespace fathom::cli {

#ifdef __GLIBC__

void use_large_pages() {
  constexpr int kStep_bytes = 256 * 1024 * 1024;   // address space; memory only where it is touched
  constexpr int kMapped_bytes = 32 * 1024 * 1024;  // from here on a block is a mapping: the most glibc takes
  constexpr std::size_t kPage_bytes = std::size_t{2} << 20U;
  // All threads share the one heap that has large pages.
  if (mallopt(M_ARENA_MAX, 1) == 0 || mallopt(M_MMAP_THRESHOLD, kMapped_bytes) == 0 ||
      mallopt(M_TRIM_THRESHOLD, kStep_bytes) == 0 || mallopt(M_TOP_PAD, kStep_bytes) == 0)
    return;
  const auto end_of_heap = [] { return static_cast<std::byte*>(sbrk(0)); };
  std::byte* const before = end_of_heap();
  constexpr std::size_t kMoreThanIsLeft_bytes = 1024 * 1024;
  void* volatile grows = std::malloc(kMoreThanIsLeft_bytes);  // volatile: a pair that is not optimised away
  std::free(grows);
  const std::byte* const end = end_of_heap();
  std::byte* const begin = before + (kPage_bytes - reinterpret_cast<std::uintptr_t>(before) % kPage_bytes);
  // A kernel without large pages refuses, and nothing is lost.
  if (end > begin) static_cast<void>(madvise(begin, static_cast<std::size_t>(end - begin), MADV_HUGEPAGE));
}

#else

void use_large_pages() {}

#endif

}  // namespace fathom::cli
