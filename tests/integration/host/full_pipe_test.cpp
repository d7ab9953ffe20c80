// Nobody reads what a service logs, and the pipe is full: the service does its work, and ends when it is
// asked to.

#include <atomic>
#include <csignal>

#include <gtest/gtest.h>

#include "bus/participant.hpp"
#include "bus/reader.hpp"
#include "samples/status/health.hpp"
#include "support/presence.hpp"
#include "support/process.hpp"
#include "support/temporary_folder.hpp"

namespace fathom::test {
namespace {

constexpr int kDomain = 66;
constexpr double kPatience_s = 60.0;

TEST(FullPipe, HoldsNoServiceUp) {
  const TemporaryFolder folder;
  bus::Participant participant(presence(kDomain, "ear"));
  std::atomic<int> signs = 0;
  const bus::Reader<ServiceStatus> reader(participant,
                                          [&](const ServiceStatus&, const bus::SampleInfo&) { ++signs; });
  const std::string pipe = folder / "pipe";
  Process service(
      "/bin/bash",
      {"-c", R"(mkfifo "$1" && exec 2<>"$1"; timeout 1 head -c 1000000 /dev/zero >&2; exec "${@:2}")", "full",
       pipe, FATHOM_BINARY_DIR "/bin/fathom-guidance-example", "--config",
       FATHOM_SOURCE_DIR "/deploy/config/guidance_example.json", "--set",
       "bus.domain=" + std::to_string(kDomain), "--set",
       "bus.profiles_dir=" FATHOM_SOURCE_DIR "/deploy/dds"});
  EXPECT_TRUE(wait_until([&] { return signs >= 2; }, kPatience_s));
  service.kill(SIGTERM);
  ASSERT_TRUE(wait_until([&] { return !service.running(); }, kPatience_s));
  EXPECT_EQ(service.wait(), 0);
}

}  // namespace
}  // namespace fathom::test
