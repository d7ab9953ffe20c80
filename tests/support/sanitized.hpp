#pragma once

namespace fathom::test {

/// Under a sanitizer everything takes many times as long: tests that would take hours do part of their work.
#ifdef FATHOM_SANITIZED
inline constexpr bool kSanitized = true;
#else
inline constexpr bool kSanitized = false;
#endif

}  // namespace fathom::test

/// The first line of a test that does many times over, to judge a mean or by seeds, what other tests do once.
#define FATHOM_MANY_RUNS() \
  if (::fathom::test::kSanitized) GTEST_SKIP() << "sanitized: many runs of what other tests run once"
