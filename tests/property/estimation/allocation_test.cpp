#include <atomic>
#include <cstdlib>
#include <new>

#include <gtest/gtest.h>

#include "support/survey_run.hpp"

namespace {
std::atomic<long> g_allocations{0};
}  // namespace

// Every way to the heap of this executable is counted. Not inlined: the compiler would see one half of a pair
// and warn.
[[gnu::noinline]] void* operator new(std::size_t size) {
  ++g_allocations;
  if (void* memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
[[gnu::noinline]] void* operator new(std::size_t size, std::align_val_t alignment) {
  ++g_allocations;
  const auto step = static_cast<std::size_t>(alignment);
  if (void* memory = std::aligned_alloc(step, (size + step - 1) / step * step)) return memory;
  throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* memory) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::align_val_t) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
  std::free(memory);
}

namespace fathom::estimation {
namespace {

TEST(Allocation, NoneAfterConstruction) {
  const test::SurveyRun run({.duration_s = 60.0, .dive_s = 40.0});
  FusionEngine engine(test::SurveyRun::config());
  NavDetail detail;
  AlignmentStatus alignment;
  Forecast forecast;
  Verdict verdict;
  const long before = g_allocations.load();
  std::size_t count = 0;
  for (const test::Sample& sample : run.samples) {
    test::feed(engine, sample);
    while (engine.next_verdict(verdict)) ++count;
    if (count % 500 == 0) {
      engine.fill(detail);
      engine.fill(alignment);
      engine.fill(forecast);
    }
  }
  Command command;
  command.kind = CommandKind::realign;
  EXPECT_TRUE(engine.apply(command));
  EXPECT_EQ(g_allocations.load() - before, 0);
  EXPECT_GT(count, 300U);
  // The counter counts.
  const auto* one = new int(1);
  EXPECT_EQ(g_allocations.load() - before, 1);
  delete one;
}

}  // namespace
}  // namespace fathom::estimation
