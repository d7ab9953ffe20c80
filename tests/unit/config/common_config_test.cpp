// The sections that the file of every service has.

#include "config/common_config.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "config/discovery_config.hpp"
#include "config/service_config.hpp"
#include "support/paths.hpp"

namespace fathom::config {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

const std::string kFile = test::source_dir() + "/deploy/config/discovery.json";

CommonConfig with(const std::vector<std::string>& sets) {
  return load_service_config<DiscoveryConfig>({kFile, sets}).value.common;
}

std::string refusal(const std::vector<std::string>& sets) {
  try {
    (void)with(sets);
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(CommonConfig, AsksNothingOfTheKernelByItself) {
  EXPECT_EQ(with({}).realtime.policy, SchedulingPolicy::other);
  EXPECT_FALSE(with({}).realtime.lock_memory);
}

TEST(CommonConfig, RealtimeIsRead) {
  const RealtimeConfig realtime =
      with({"realtime.policy=fifo", "realtime.priority=35", "realtime.lock_memory=true"}).realtime;
  EXPECT_EQ(realtime.policy, SchedulingPolicy::fifo);
  EXPECT_EQ(realtime.priority, 35);
  EXPECT_TRUE(realtime.lock_memory);
}

TEST(CommonConfig, RealtimeIsStrict) {
  EXPECT_THAT(refusal({"realtime.policy=rr"}), AllOf(HasSubstr("realtime.policy"), HasSubstr("fifo")));
  EXPECT_THAT(refusal({"realtime.priority=0"}), AllOf(HasSubstr("realtime.priority"), HasSubstr("99")));
  EXPECT_THAT(refusal({"realtime.priority=100"}), HasSubstr("realtime.priority"));
  EXPECT_THAT(refusal({"realtime.lock_memory=1"}), HasSubstr("realtime.lock_memory"));
  EXPECT_THAT(refusal({"realtime.nice=5"}), HasSubstr("realtime.nice"));
}

TEST(CommonConfig, DiscoveryServersAreAddressesWithPorts) {
  EXPECT_THAT(with({R"(bus.discovery_servers=["192.168.2.1:11811","10.0.0.1:1"])"}).bus.discovery_servers,
              ElementsAre("192.168.2.1:11811", "10.0.0.1:1"));
  for (const char* wrong :
       {"192.168.2.1", "vehicle:11811", "192.168.2.1:", "192.168.2.1:0", "192.168.2.1:65536",
        "192.168.2.1:11811x", "192.168.2:11811", ":11811", "192.168.2.1:+811"}) {
    EXPECT_THAT(refusal({std::string("bus.discovery_servers=[\"") + wrong + "\"]"}),
                AllOf(HasSubstr("bus.discovery_servers"), HasSubstr("such as 192.168.2.1:11811")))
        << wrong;
  }
  EXPECT_THAT(refusal({R"(bus.discovery_servers=["10.0.0.1:1"])", "bus.security.folder=credentials"}),
              AllOf(HasSubstr("bus.discovery_servers"), HasSubstr("none where security.folder is set")));
}

TEST(CommonConfig, InterfacesAndPeersAreAddresses) {
  EXPECT_EQ(refusal({R"(bus.interfaces=["127.0.0.1","192.168.2.1"])", R"(bus.peers=["10.0.0.2"])"}),
            "accepted");
  for (const char* wrong : {"abc", "1.2.3.999", "10.0.0", "10.0.0.1:7400", ""}) {
    for (const char* key : {"bus.interfaces", "bus.peers"}) {
      EXPECT_THAT(
          refusal({std::string(key) + "=[\"10.0.0.1\",\"" + wrong + "\"]"}),
          AllOf(HasSubstr(key), HasSubstr("IPv4 addresses such as 192.168.2.1, not '" + std::string(wrong))))
          << wrong;
    }
  }
}

TEST(CommonConfig, ADiscoveryServerListensAtOneOfItsInterfaces) {
  EXPECT_THAT(refusal({"discovery_listen=192.168.2.1:11811"}),
              AllOf(HasSubstr("discovery_listen"), HasSubstr("an address of bus.interfaces")));
  EXPECT_THAT(refusal({"discovery_listen=127.0.0.1"}),
              AllOf(HasSubstr("discovery_listen"), HasSubstr("such as 192.168.2.1:11811")));
  EXPECT_EQ(refusal({"discovery_listen=192.168.2.1:11811", R"(bus.interfaces=["192.168.2.1"])"}), "accepted");
}

}  // namespace
}  // namespace fathom::config
