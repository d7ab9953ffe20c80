// Nobody reads what a service logs, and the pipe is full: the service does its work, and ends when it is
// asked to.

#include <atomic>
#include <csignal>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "bus/participant.hpp"
#include "bus/reader.hpp"
#include "integration/host/patience.hpp"
#include "samples/status/health.hpp"
#include "support/paths.hpp"
#include "support/presence.hpp"
#include "support/process.hpp"
#include "support/temporary_folder.hpp"

namespace fathom::test {
namespace {

constexpr int kDomainOfThePipe = 66;

/// For a shell: a service whose standard error is a pipe that is full and stays so.
std::vector<std::string> in_front_of_a_full_pipe(const std::string& pipe,
                                                 const std::vector<std::string>& arguments) {
  std::vector<std::string> out{
      "-c", R"(mkfifo "$1" && exec 2<>"$1"; timeout 1 head -c 1000000 /dev/zero >&2; exec "${@:2}")", "full",
      pipe, binary_dir() + "/bin/fathom-guidance-example"};
  out.insert(out.end(), arguments.begin(), arguments.end());
  return out;
}

TEST(FullPipe, HoldsNoServiceUp) {
  const TemporaryFolder folder;
  bus::Participant participant(presence(kDomainOfThePipe, "ear"));
  std::atomic<int> signs = 0;
  const bus::Reader<ServiceStatus> reader(participant,
                                          [&](const ServiceStatus&, const bus::SampleInfo&) { ++signs; });
  Process service("/bin/bash",
                  in_front_of_a_full_pipe(folder / "pipe",
                                          {"--config", source_dir() + "/deploy/config/guidance_example.json",
                                           "--set", "bus.domain=" + std::to_string(kDomainOfThePipe), "--set",
                                           "bus.profiles_dir=" + source_dir() + "/deploy/dds"}));
  EXPECT_TRUE(wait_until([&] { return signs >= 2; }, kPatience_s));
  service.kill(SIGTERM);
  ASSERT_TRUE(wait_until([&] { return !service.running(); }, kPatience_s));
  EXPECT_EQ(service.wait(), 0);
}

TEST(FullPipe, HoldsNoServiceUpThatFails) {
  const TemporaryFolder folder;
  Process service("/bin/bash", in_front_of_a_full_pipe(folder / "pipe", {"--config", "/none"}));
  ASSERT_TRUE(wait_until([&] { return !service.running(); }, kPatience_s));
  EXPECT_EQ(service.wait(), 2);
}

}  // namespace
}  // namespace fathom::test
