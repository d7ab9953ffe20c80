// A service that ends by an exception of one of its threads: what it logged just before is written.

#include <csignal>
#include <stdexcept>
#include <string>
#include <thread>

#include <gtest/gtest.h>

#include "host/run.hpp"
#include "support/paths.hpp"

namespace fathom::test {
namespace {

void run_and_throw() {
  std::string words[]{"fathom-test", "--config", "of its own"};
  char* arguments[]{words[0].data(), words[1].data(), words[2].data(), nullptr};
  config::CommonConfig common;
  common.bus.domain = 67;
  common.bus.profiles_dir = source_dir() + "/deploy/dds";
  (void)host::run_service(
      3, arguments, {"test", "Ends by an exception."}, [] { return std::string(); },
      [&](const config::LoadRequest&, bool) {
        return host::Prepared{common, "hash"};
      },
      [](host::ServiceHost& host) {
        for (int i = 0; i < 400; ++i) host.log().info("line " + std::to_string(i));
        std::thread([] { throw std::runtime_error("of a thread"); }).join();
        return ExitCode::done;
      });
}

TEST(LastWords, AreWrittenBeforeAnExceptionEndsTheService) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(run_and_throw(), ::testing::KilledBySignal(SIGABRT),
              "line 399\n.*nobody caught an exception: of a thread");
}

}  // namespace
}  // namespace fathom::test
