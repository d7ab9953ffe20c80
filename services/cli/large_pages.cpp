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
  const auto end_of_heap = [] { return reinterpret_cast<std::uintptr_t>(sbrk(0)); };
  const std::uintptr_t begin = (end_of_heap() + kPage_bytes - 1) / kPage_bytes * kPage_bytes;
  constexpr std::size_t kMoreThanIsLeft_bytes = 1024 * 1024;
  void* volatile grows = std::malloc(kMoreThanIsLeft_bytes);  // volatile: a pair that is not optimised away
  std::free(grows);
  const std::uintptr_t end = end_of_heap();
  // A kernel without large pages refuses, and nothing is lost.
  if (end > begin) static_cast<void>(madvise(reinterpret_cast<void*>(begin), end - begin, MADV_HUGEPAGE));
}

#else

void use_large_pages() {}

#endif

}  // namespace fathom::cli
