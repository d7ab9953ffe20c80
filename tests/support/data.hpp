#pragma once

#include <cstdlib>
#include <string_view>

#include <gtest/gtest.h>

namespace fathom::test {

/// FATHOM_REQUIRE_DATA=1: recordings have to be there. tests/run sets it where their folders are.
inline bool data_required() {
  const char* value = std::getenv("FATHOM_REQUIRE_DATA");
  return value != nullptr && std::string_view(value) == "1";
}

}  // namespace fathom::test

/// Ends a test whose recording or data set is missing: skipped, or failed where data are required. `what` may
/// be streamed parts: FATHOM_DATA_IS_MISSING(file << " is not there").
#define FATHOM_DATA_IS_MISSING(what)                           \
  do {                                                         \
    if (::fathom::test::data_required()) GTEST_FAIL() << what; \
    GTEST_SKIP() << "data: " << what;                          \
  } while (false)
