// A service whose Fast DDS stands still, as in a deadlock: every thread but the main one is held, as a
// debugger holds it.

#include <array>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/ptrace.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include "integration/host/patience.hpp"
#include "support/paths.hpp"
#include "support/process.hpp"

namespace fathom::test {
namespace {

constexpr int kDomainOfTheDeaf = 65;
/// Of the first participant of a domain: discovery and samples (RTPS 9.6.2.3).
constexpr std::array<std::uint16_t, 2> kPorts{7400 + 250 * kDomainOfTheDeaf + 10,
                                              7400 + 250 * kDomainOfTheDeaf + 11};

/// Holds all threads of a process but the main one and its log's, and says which; none where that is not
/// permitted.
std::vector<pid_t> hold_threads(pid_t process) {
  std::vector<pid_t> held;
  for (const auto& entry :
       std::filesystem::directory_iterator("/proc/" + std::to_string(process) + "/task")) {
    const auto thread = static_cast<pid_t>(std::stol(entry.path().filename().string()));
    std::string name;
    std::ifstream(entry.path() / "comm") >> name;
    if (thread == process || name == "log") continue;
    if (ptrace(PTRACE_SEIZE, thread, nullptr, nullptr) != 0) return {};
    ptrace(PTRACE_INTERRUPT, thread, nullptr, nullptr);
    held.push_back(thread);
  }
  return held;
}

/// Something that waits to be read.
void send_to_ports() {
  const int fd = socket(AF_INET, SOCK_DGRAM, 0);
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  const std::array<char, 8000> data{};
  for (const std::uint16_t port : kPorts) {
    to.sin_port = htons(port);
    for (int i = 0; i < 5; ++i)
      sendto(fd, data.data(), data.size(), 0, reinterpret_cast<const sockaddr*>(&to), sizeof to);
  }
  close(fd);
}

TEST(Deaf, AServiceThatHearsNothingEnds) {
  Process service("fathom-guidance-example",
                  {"--config", source_dir() + "/deploy/config/guidance_example.json", "--set",
                   "bus.domain=" + std::to_string(kDomainOfTheDeaf), "--set",
                   "bus.profiles_dir=" + source_dir() + "/deploy/dds"});
  ASSERT_TRUE(
      wait_until([&] { return service.err().find("started, version") != std::string::npos; }, kPatience_s))
      << service.err();
  const std::vector<pid_t> held = hold_threads(service.pid());
  if (held.empty()) GTEST_SKIP() << "may not hold threads of other processes (ptrace)";
  bool ended = false;
  for (int i = 0; i < 120 && !ended; ++i) {
    send_to_ports();
    ended = wait_until([&] { return !service.running(); }, 0.5);
    for (const pid_t thread : held) waitpid(thread, nullptr, __WALL | WNOHANG);  // whoever holds buries
  }
  ASSERT_TRUE(ended) << service.err();
  EXPECT_EQ(service.wait(), 4);
  EXPECT_THAT(service.err(), ::testing::HasSubstr("has waited for 10 s and nothing takes it"));
}

}  // namespace
}  // namespace fathom::test
