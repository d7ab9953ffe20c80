// The real fathom-discovery: services that know nobody else find each other through it.

#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bus/participant.hpp"
#include "bus/reader.hpp"
#include "integration/host/patience.hpp"
#include "samples/status/health.hpp"
#include "support/paths.hpp"
#include "support/presence.hpp"
#include "support/process.hpp"

namespace fathom::test {
namespace {

constexpr std::uint32_t kDomain = 64;
const std::string kServer = "127.0.0.1:21812";

std::unique_ptr<Process> start(const std::string& program, const std::string& file,
                               std::vector<std::string> sets) {
  sets.push_back("bus.domain=" + std::to_string(kDomain));
  sets.push_back("bus.profiles_dir=" + source_dir() + "/deploy/dds");
  std::vector<std::string> arguments{"--config", source_dir() + "/deploy/config/" + file};
  for (const std::string& set : sets) {
    arguments.push_back("--set");
    arguments.push_back(set);
  }
  return std::make_unique<Process>(program, arguments);
}

std::unique_ptr<Process> start_server() {
  return start("fathom-discovery", "discovery.json", {"discovery_listen=" + kServer});
}

/// Hears life signs, and knows nobody but the server.
class Ear {
 public:
  [[nodiscard]] std::uint32_t process_of(const std::string& service) const {
    const std::lock_guard lock(mutex_);
    const auto found = processes_.find(service);
    return found == processes_.end() ? 0 : found->second;
  }

 private:
  static bus::ParticipantOptions options() {
    auto out = presence(kDomain, "ear");
    out.peers = {};
    out.discovery_servers = {kServer};
    return out;
  }

  mutable std::mutex mutex_;
  std::map<std::string, std::uint32_t> processes_;
  bus::Participant participant_{options()};
  bus::Reader<ServiceStatus> reader_{participant_,
                                     [this](const ServiceStatus& status, const bus::SampleInfo&) {
                                       const std::lock_guard lock(mutex_);
                                       processes_[status.header.sensor.str()] = status.pid;
                                     }};
};

TEST(DiscoveryService, IntroducesServicesAndComesBackAfterAKill) {
  const Ear ear;
  auto server = start_server();
  const auto guidance = start("fathom-guidance-example", "guidance_example.json",
                              {"bus.peers=[]", "bus.discovery_servers=[\"" + kServer + "\"]"});
  const auto heard = [&](const std::string& service, const Process& process) {
    return wait_until([&] { return ear.process_of(service) == static_cast<std::uint32_t>(process.pid()); },
                      kPatience_s);
  };
  ASSERT_TRUE(heard("guidance_example", *guidance)) << guidance->err();
  ASSERT_TRUE(heard("discovery", *server)) << "its own life sign: " << server->err();

  server->kill(SIGKILL);
  (void)server->wait();
  server = start_server();
  ASSERT_TRUE(heard("discovery", *server)) << server->err();
  const auto later = start("fathom-guidance-example", "guidance_example.json",
                           {"bus.peers=[]", "bus.discovery_servers=[\"" + kServer + "\"]"});
  ASSERT_TRUE(heard("guidance_example", *later)) << later->err();
  server->kill(SIGTERM);
  EXPECT_EQ(server->wait(), 0) << server->err();
}

TEST(DiscoveryService, APortInUseEndsItInWords) {
  const auto first = start_server();
  ASSERT_TRUE(
      wait_until([&] { return first->err().find("serves discovery at") != std::string::npos; }, kPatience_s))
      << first->err();
  const auto second = start_server();
  EXPECT_EQ(second->wait(), 4);
  EXPECT_THAT(second->err(),
              ::testing::HasSubstr("discovery_listen '" + kServer + "': Address already in use"));
}

}  // namespace
}  // namespace fathom::test
