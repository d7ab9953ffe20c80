#include "estimation/filter/state_index.hpp"

#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fathom::estimation {
namespace {

StateGroups named(const char* name) {
  StateGroups groups;
  EXPECT_TRUE(named_state_groups(name, groups)) << name;
  return groups;
}

TEST(StateIndex, NamedConfigurationsHoldWhatTheyAreKnownFor) {
  EXPECT_EQ(StateIndex(named("gps_ins15")).size(), 15);
  EXPECT_EQ(StateIndex(named("gps_ins24")).size(), 24);
  EXPECT_EQ(StateIndex(named("gps_ins36")).size(), 36);
  const StateIndex full(named("full"));
  EXPECT_EQ(full.size(), 53);
  EXPECT_EQ(full.imu_end(), 33);

  // The published 25: navigation 9, inertial biases 6, USBL bias 2, depth bias, Doppler scale 3, compass
  // bias, USBL misalignment 3.
  const StateIndex hybrid(named("hybrid25"));
  EXPECT_EQ(hybrid.size(), 25);
  int held = kNavStates;
  for (const Group group : {Group::accel_bias, Group::gyro_bias, Group::usbl_bias, Group::depth_bias,
                            Group::dvl_scale_xyz, Group::heading_bias, Group::usbl_misalignment}) {
    EXPECT_TRUE(hybrid.has(group));
    held += group_size(group);
  }
  EXPECT_EQ(held, 25);
}

TEST(StateIndex, EveryStateHasAnOwnName) {
  StateGroups groups = named("full");
  groups.depth_bias = groups.log_scale = groups.mount_angles = groups.mount_lever = true;
  groups.gps_latency = groups.gps_lever = true;
  groups.surface_altitude = false;
  const StateIndex index(groups);
  std::set<std::string_view> names;
  for (int i = 0; i < index.size(); ++i) {
    EXPECT_FALSE(index.name(i).empty()) << i;
    EXPECT_LE(index.name(i).size(), 31U) << index.name(i);
    names.insert(index.name(i));
  }
  EXPECT_EQ(names.size(), static_cast<std::size_t>(index.size()));
  EXPECT_EQ(index.name(index.of(Group::mount_angles) + 1), "mount_yaw_rad");
}

TEST(StateIndex, MoreStatesThanThereIsRoomForAreRefused) {
  EngineConfig config;
  config.groups = named("full");
  EXPECT_EQ(config.validate(), "");
  config.groups.gps_lever = config.groups.mount_angles = config.groups.mount_lever = true;
  config.groups.dvl_bias = config.groups.log_scale = true;
  EXPECT_THAT(config.validate(), testing::HasSubstr("groups: 65 states: expected at most 64"));
}

}  // namespace
}  // namespace fathom::estimation
