#include "cli/large_pages.hpp"

#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <thread>

#include <gtest/gtest.h>
#include <sys/resource.h>

#if defined(__GLIBC__) && !defined(FATHOM_SANITIZED)  // sanitizers bring an allocator of their own

namespace fathom::cli {
namespace {

constexpr std::size_t kBlock_bytes = std::size_t{8} << 20U;
constexpr long kSmallPages = kBlock_bytes / 4096;

/// How often the kernel had to give a page while a block is taken, written to and freed.
long faults_of_a_block() {
  const auto count = [] {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return usage.ru_minflt;
  };
  const long before = count();
  void* volatile block = std::malloc(kBlock_bytes);
  std::memset(block, 1, kBlock_bytes);
  std::free(block);
  return count() - before;
}

/// In a process of its own: the heap stays as it is told to be.
[[noreturn]] void use_and_count() {
  use_large_pages();
  faults_of_a_block();
  const long again = faults_of_a_block();
  long by_another_thread = 0;
  std::thread([&] { by_another_thread = faults_of_a_block(); }).join();
  std::fprintf(stderr, "again %ld, by another thread %ld", again, by_another_thread);
  std::_Exit(again < kSmallPages / 10 && by_another_thread < kSmallPages / 10 ? 0 : 1);
}

TEST(LargePages, TheHeapKeepsWhatIsFreedForAllThreads) {
  testing::FLAGS_gtest_death_test_style = "threadsafe";
  EXPECT_EXIT(use_and_count(), testing::ExitedWithCode(0), "again");
}

}  // namespace
}  // namespace fathom::cli
#endif
