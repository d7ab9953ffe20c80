// The table of permissions against the topics that there are, and against what must never be in it.

#include "security/roles.hpp"

#include <algorithm>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "bus/topics.hpp"

namespace fathom::test {
namespace {

using security::find_role;
using security::Role;
using security::roles;

std::set<std::string_view> known_topics() {
  std::set<std::string_view> out;
  for (const bus::TopicInfo& topic : bus::all_topics()) out.insert(topic.topic);
  return out;
}

bool in(std::span<const std::string_view> topics, std::string_view topic) {
  return std::find(topics.begin(), topics.end(), topic) != topics.end();
}

TEST(Roles, NameOnlyTopicsThatThereAre) {
  const auto known = known_topics();
  for (const Role& role : roles()) {
    for (const auto topic : role.publishes) EXPECT_TRUE(known.contains(topic)) << role.name << " " << topic;
    for (const auto topic : role.subscribes) {
      EXPECT_TRUE(known.contains(topic)) << role.name << " " << topic;
    }
  }
}

TEST(Roles, HaveNamesOfTheirOwn) {
  std::set<std::string_view> names;
  for (const Role& role : roles()) EXPECT_TRUE(names.insert(role.name).second) << role.name;
  EXPECT_EQ(find_role("nobody"), nullptr);
  EXPECT_EQ(find_role("fusion")->name, "fusion");
}

TEST(Roles, EveryTopicWithOneKindOfWriterHasOnlyThat) {
  const std::pair<std::string_view, std::set<std::string_view>> expected[] = {
      {"fathom/v1/imu", {"imu_bridge", "ros2_gateway"}},
      {"fathom/v1/dvl", {"dvl_bridge", "ros2_gateway"}},
      {"fathom/v1/gps", {"gps_bridge", "ros2_gateway"}},
      {"fathom/v1/depth", {"depth_bridge", "ros2_gateway"}},
      {"fathom/v1/heading", {"heading_bridge"}},
      {"fathom/v1/usbl", {"usbl_bridge"}},
      {"fathom/v1/propulsion", {"actuator_bridge"}},
      {"fathom/v1/fins", {"actuator_bridge"}},
      {"fathom/v1/airspeed", {"air_data_bridge"}},
      {"fathom/v1/altimeter", {"altimeter_bridge"}},
      {"fathom/v1/range", {"range_bridge"}},
      {"fathom/v1/fix", {"fix_bridge", "ros2_gateway", "console", "cli"}},
      {"fathom/v1/nav_state", {"fusion"}},
      {"fathom/v1/nav_detail", {"fusion"}},
      {"fathom/v1/verdict", {"fusion"}},
      {"fathom/v1/alignment", {"fusion"}},
      {"fathom/v1/forecast", {"fusion"}},
      {"fathom/v1/engine_state", {"fusion"}},
      {"fathom/v1/intake", {"fusion"}},
      {"fathom/v1/alarm", {"monitor"}},
      {"fathom/v1/monitor_status", {"monitor"}},
      {"fathom/v1/truth", {"simulator"}},
      {"fathom/v1/command", {"console", "cli"}},
      {"fathom/v1/route", {"guidance", "guidance_example"}}};
  for (const auto& [topic, writers] : expected) {
    std::set<std::string_view> found;
    for (const Role& role : roles()) {
      if (in(role.publishes, topic)) found.insert(role.name);
    }
    EXPECT_EQ(found, writers) << topic;
  }
}

TEST(Roles, WriteAndReadNoTopicByPattern) {
  for (const Role& role : roles()) {
    for (const auto topic : role.publishes) EXPECT_EQ(topic.find('*'), std::string_view::npos) << role.name;
    for (const auto topic : role.subscribes) EXPECT_EQ(topic.find('*'), std::string_view::npos) << role.name;
  }
}

TEST(Roles, TheStateOfTheEngineIsForFusionAndOrdersForThoseWhoFollowOrKeepThem) {
  const auto readers = [](std::string_view topic) {
    std::set<std::string_view> found;
    for (const Role& role : roles())
      if (in(role.subscribes, topic)) found.insert(role.name);
    return found;
  };
  EXPECT_EQ(readers("fathom/v1/engine_state"), (std::set<std::string_view>{"fusion"}));
  EXPECT_EQ(readers("fathom/v1/command"),
            (std::set<std::string_view>{"fusion", "monitor", "recorder", "foxglove"}));
}

}  // namespace
}  // namespace fathom::test
