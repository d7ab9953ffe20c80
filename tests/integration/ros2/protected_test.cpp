// The gateway as the only way between a protected vehicle network and a graph of ROS 2.

#include <atomic>
#include <string>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/clock.hpp"
#include "bus/reader.hpp"
#include "bus/writer.hpp"
#include "integration/ros2/peer.hpp"
#include "samples/imu.hpp"
#include "samples/nav_state.hpp"
#include "security/keygen.hpp"
#include "support/paths.hpp"
#include "support/presence.hpp"
#include "support/temporary_folder.hpp"
#include "unit/ros2/state.hpp"

namespace fathom {
namespace {

using test::wait_until;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr std::uint32_t kVehicle = 77;
constexpr std::uint32_t kGraph = 78;

TEST(Ros2GatewayProtected, MayDoWhatItDoes) {
  const test::TemporaryFolder folder;
  security::KeygenOptions keygen;
  keygen.folder = folder / "credentials";
  security::make_credentials(keygen, SystemClock().utc_ns());
  bus::ParticipantOptions presence = test::presence(kVehicle, "fusion");
  presence.security.folder = keygen.folder;
  bus::Participant fusion(presence);
  bus::Writer<NavState> states(fusion);
  std::atomic<int> samples = 0;
  const bus::Reader<ImuSample> imu(fusion, [&](const ImuSample&, const bus::SampleInfo&) { ++samples; });
  test::Process gateway(
      "fathom-ros2-gateway",
      {"--config", test::source_dir() + "/deploy/config/ros2_gateway.json", "--set",
       "bus.domain=" + std::to_string(kVehicle), "--set", "ros.domain=" + std::to_string(kGraph), "--set",
       "bus.profiles_dir=" + test::source_dir() + "/deploy/dds", "--set", "clock.anchor_file=", "--set",
       "bus.security.folder=" + keygen.folder, "--set",
       R"(inputs=[{"kind":"imu","topic":"/imu/data","sensor":"imu","frame_id":"imu_link","rate_hz":50}])"});
  const test::Peer imu_peer("write", kGraph, {"imu", "rt/imu/data"});
  test::Peer odometry("read", kGraph, {"odometry", "rt/fathom/odometry"});
  std::atomic<bool> done = false;
  std::thread publisher([&] {
    for (std::uint64_t number = 1; !done; ++number) {
      NavState state = ros2::test::state_at({0.6, 0.1, 0.0});
      state.header.stamp_ns = SystemClock().utc_ns();
      state.header.sequence = number;
      states.write(state);
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
  });
  EXPECT_TRUE(wait_until([&] { return samples > 10; }, 20.0)) << gateway.err();
  EXPECT_THAT(odometry.output(), HasSubstr("child_frame_id base_link")) << gateway.err();
  done = true;
  publisher.join();
  EXPECT_EQ(fusion.counters().permission_refused, 0U);
  EXPECT_EQ(fusion.counters().stranger_refused, 0U) << "the graph's participant is in another domain";
  EXPECT_THAT(gateway.err(), Not(HasSubstr("permission")));
}

}  // namespace
}  // namespace fathom
