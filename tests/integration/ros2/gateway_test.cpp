// The gateway as a service, between fathom's bus and a peer of ROS 2.

#include "integration/ros2/gateway.hpp"

#include <cmath>
#include <mutex>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/clock.hpp"
#include "base/units.hpp"
#include "bus/reader.hpp"
#include "samples/depth.hpp"
#include "samples/dvl.hpp"
#include "samples/gps.hpp"
#include "samples/imu.hpp"
#include "samples/status/health.hpp"
#include "support/paths.hpp"

namespace fathom {
namespace {

using namespace test;  // NOLINT(google-build-using-namespace): the gateway and the vehicle
using ::testing::HasSubstr;

TEST_F(Ros2Gateway, SaysNavigationOnEveryTopic) {
  start();
  auto odometry = first("odometry", "rt/fathom/odometry");
  EXPECT_EQ(odometry["frame_id"].at(0), "odom");
  EXPECT_EQ(odometry["child_frame_id"].at(0), "base_link");
  EXPECT_NEAR(number(odometry["linear"], 0), 1.0, 1e-9) << "forward, heading north";
  EXPECT_NEAR(number(odometry["orientation"], 2), std::sqrt(0.5), 1e-9);
  EXPECT_GT(number(odometry["pose_covariance"], 35), 0.0);
  EXPECT_GT(number(odometry["twist_covariance"], 35), 0.0);
  EXPECT_LT(std::abs(age_s(odometry["stamp"])), 1.0) << "the instant of validity";
  auto imu = first("imu", "rt/fathom/imu", "besteffort");
  EXPECT_EQ(imu["frame_id"].at(0), "base_link");
  EXPECT_NEAR(number(imu["linear_acceleration"], 2), 9.8, 1e-9);
  auto fix = first("fix", "rt/fathom/fix");
  EXPECT_EQ(fix["status"].at(0), "0");
  EXPECT_NEAR(number(fix["latitude"], 0), 36.4, 0.01);
  EXPECT_EQ(fix["position_covariance_type"].at(0), "3");
  auto velocity = first("twist", "rt/fathom/velocity");
  EXPECT_EQ(velocity["frame_id"].at(0), "base_link");
  EXPECT_NEAR(number(velocity["linear"], 0), 1.0, 1e-9);
  auto pose = first("pose", "rt/fathom/pose");
  EXPECT_EQ(pose["frame_id"].at(0), "map");
  EXPECT_GT(number(pose["position"], 1), 0.0) << "north of where it began";
  EXPECT_NEAR(number(pose["position"], 0), 0.0, 1e-3);
  auto geopose = first("geopose", "rt/fathom/geopose");
  EXPECT_NEAR(number(geopose["latitude"], 1), -121.5, 1e-6);
  auto origin = first("geopose", "rt/fathom/map_origin", "latched");
  EXPECT_NEAR(number(origin["latitude"], 0), 36.4, 0.001) << "also for those who come late";
  Peer tf("read", kGraph, {"tf", "rt/tf"});
  const auto transforms = lines_of(tf.output());
  ASSERT_EQ(transforms.size(), 2U);
  EXPECT_THAT(transforms[0], HasSubstr("transform map odom "));
  EXPECT_THAT(transforms[1], HasSubstr("transform odom base_link "));
  Peer diagnostics("read", kGraph, {"diagnostics", "rt/diagnostics"});
  EXPECT_THAT(diagnostics.output(), HasSubstr("'fathom: navigation' 'gps_aided"));
}

TEST_F(Ros2Gateway, LatchesTheFramesThatStandStill) {
  start(
      {R"(frames.static=[{"parent":"base_link","child":"dvl_link","position_m":[0.5,0.0,-0.25],"rpy_deg":[180,0,0]}])"});
  Peer tf("read", kGraph, {"tf", "rt/tf_static", "latched"});
  const auto words = words_of(tf.output());
  ASSERT_EQ(words.size(), 12U);
  EXPECT_EQ(words[1], "base_link");
  EXPECT_EQ(words[2], "dvl_link");
  EXPECT_NEAR(number(words, 5), 0.5, 1e-12);
  EXPECT_NEAR(number(words, 7), -0.25, 1e-12);
  EXPECT_NEAR(std::abs(number(words, 8)), 1.0, 1e-12) << "half a turn about forward";
}

TEST_F(Ros2Gateway, SpeaksNorthEastDownWhereAsked) {
  start({"frames.convention=ned_frd", "frames.map=map_ned", "frames.odom=odom_ned",
         "frames.base_link=base_link_frd", "frames.origin_lat_deg=36.4", "frames.origin_lon_deg=-121.5",
         "frames.origin_altitude_m=-3"});
  auto pose = first("pose", "rt/fathom/pose");
  EXPECT_EQ(pose["frame_id"].at(0), "map_ned");
  EXPECT_GT(number(pose["position"], 0), 0.0) << "north first";
  EXPECT_NEAR(number(pose["orientation"], 3), 1.0, 1e-9);
  auto imu = first("imu", "rt/fathom/imu");
  EXPECT_NEAR(number(imu["linear_acceleration"], 2), -9.8, 1e-9);
}

TEST_F(Ros2Gateway, MayShareTheDomainOfTheVehicle) {
  start({"ros.domain=" + std::to_string(kVehicle)});
  Peer peer("read", kVehicle, {"odometry", "rt/fathom/odometry"});
  EXPECT_THAT(peer.output(), HasSubstr("child_frame_id base_link"));
}

TEST_F(Ros2Gateway, IsANodeOfHumble) {
  start({"ros.distro=humble", "ros.namespace=/", "ros.node=navigation"});
  Peer peer("graph", kGraph, {}, true);
  const std::string text = peer.output();
  EXPECT_THAT(text, HasSubstr("node / navigation\n"));
  EXPECT_THAT(text, HasSubstr(" rt/odometry nav_msgs::msg::dds_::Odometry_\n")) << "no hash, no namespace";
}

struct Along {
  TimeNs stamp_ns;
  double map_y;   // of odom in map
  double odom_y;  // of base_link in odom
};

/// The transforms that a peer has printed so far, whole lines only.
std::vector<Along> transforms_of(const std::string& text) {
  std::vector<Along> out;
  double map_y = 0.0;
  for (const std::string& line : lines_of(text.substr(0, text.rfind('\n') + 1))) {
    const auto words = words_of(line);
    if (words.size() != 12) continue;
    if (words[1] == "map") map_y = number(words, 6);
    if (words[1] != "odom") continue;
    out.push_back({std::stoll(words[3]) * kNsPerSecond + std::stoll(words[4]), map_y, number(words, 6)});
  }
  return out;
}

// What robot_localization and Nav2 need of tf: time goes on, odom has no step, map has it.
TEST_F(Ros2Gateway, KeepsOdomSmoothOverAStepOfThePosition) {
  start();
  const Peer tf("follow", kGraph, {"tf", "rt/tf"});
  ASSERT_TRUE(wait_until([&] { return transforms_of(tf.so_far()).size() > 20; }, 20.0)) << gateway->err();
  vehicle.step(100.0);
  const std::size_t before = transforms_of(tf.so_far()).size();
  ASSERT_TRUE(wait_until([&] { return transforms_of(tf.so_far()).size() > before + 50; }));
  const std::vector<Along> all = transforms_of(tf.so_far());
  for (std::size_t i = 1; i < all.size(); ++i) {
    EXPECT_GT(all[i].stamp_ns, all[i - 1].stamp_ns);
    const double moved = all[i].odom_y - all[i - 1].odom_y;
    EXPECT_NEAR(moved, to_seconds(all[i].stamp_ns - all[i - 1].stamp_ns), 1e-3) << "1 m/s, whatever happens";
  }
  EXPECT_NEAR(all.front().map_y, 0.0, 0.01);
  EXPECT_NEAR(all.back().map_y, 100.0, 0.02);
}

TEST_F(Ros2Gateway, NeverGoesBackInTimeAtATakeover) {
  start();
  const Peer tf("follow", kGraph, {"tf", "rt/tf"});
  ASSERT_TRUE(wait_until([&] { return transforms_of(tf.so_far()).size() > 20; }, 20.0));
  vehicle.lag(0.5);  // who takes over is behind
  const std::size_t before = transforms_of(tf.so_far()).size();
  ASSERT_TRUE(wait_until([&] { return transforms_of(tf.so_far()).size() > before + 20; }));
  const std::vector<Along> all = transforms_of(tf.so_far());
  for (std::size_t i = 1; i < all.size(); ++i) EXPECT_GT(all[i].stamp_ns, all[i - 1].stamp_ns);
}

TEST_F(Ros2Gateway, TakesInstruments) {
  start({R"(inputs=[
    {"kind":"imu","topic":"/imu/data","sensor":"imu","frame_id":"imu_link","rate_hz":50},
    {"kind":"nav_sat_fix","topic":"/gps/fix","sensor":"gps","frame_id":"gps_link","rate_hz":50},
    {"kind":"fluid_pressure","topic":"/depth","sensor":"depth","frame_id":"depth_link","rate_hz":50,"lat_deg":36.4},
    {"kind":"dvl","topic":"/dvl","sensor":"dvl","frame_id":"dvl_link","rate_hz":50},
    {"kind":"twist","topic":"/log","sensor":"log","frame_id":"log_link","rate_hz":50,"through_water":true}])"});
  std::mutex mutex;
  std::vector<ImuSample> imu;
  std::vector<GpsSample> gps;
  std::vector<DepthSample> depth;
  std::map<std::string, DvlSample> dvl;
  bus::Participant& at = vehicle.participant();
  const auto keep = [&](auto& in) {
    return [&](const auto& sample, const bus::SampleInfo&) {
      const std::lock_guard lock(mutex);
      in.push_back(sample);
    };
  };
  const bus::Reader<ImuSample> imu_reader(at, keep(imu));
  const bus::Reader<GpsSample> gps_reader(at, keep(gps));
  const bus::Reader<DepthSample> depth_reader(at, keep(depth));
  const bus::Reader<DvlSample> dvl_reader(at, [&](const DvlSample& sample, const bus::SampleInfo&) {
    const std::lock_guard lock(mutex);
    dvl[sample.header.sensor.str()] = sample;
  });
  const Peer a("write", kGraph, {"imu", "rt/imu/data"});
  const Peer b("write", kGraph, {"fix", "rt/gps/fix"});
  const Peer c("write", kGraph, {"pressure", "rt/depth"});
  const Peer d("write", kGraph, {"dvl", "rt/dvl"});
  const Peer e("write", kGraph, {"twist", "rt/log"});
  ASSERT_TRUE(wait_until(
      [&] {
        const std::lock_guard lock(mutex);
        return imu.size() > 20 && !gps.empty() && !depth.empty() && dvl.size() == 2;
      },
      20.0))
      << gateway->err();
  const std::lock_guard lock(mutex);
  EXPECT_EQ(imu.back().header.vehicle, Name("auv"));
  EXPECT_EQ(imu.back().header.sensor, Name("imu"));
  EXPECT_EQ(imu.back().angular_rate_B_rad_s, (std::array<double, 3>{0.1, -0.2, -0.3}));
  EXPECT_EQ(imu.back().specific_force_B_m_s2, (std::array<double, 3>{0.5, -0.6, -9.81}));
  for (std::size_t i = 1; i < imu.size(); ++i) {
    EXPECT_EQ(imu[i].header.sequence, imu[i - 1].header.sequence + 1);
    EXPECT_GT(imu[i].header.stamp_ns, imu[i - 1].header.stamp_ns);
    EXPECT_GE(imu[i].header.received_ns, imu[i].header.stamp_ns);
  }
  EXPECT_NEAR(gps.back().latitude_rad, -33.5 * kRadPerDeg, 1e-12);
  EXPECT_EQ(gps.back().fix, GpsFix::fix_3d);
  EXPECT_EQ(gps.back().position_sigma_N_m, (std::array<double, 3>{3.0, 2.0, 5.0}));
  EXPECT_NEAR(depth.back().depth_m, 99.2, 0.3);
  EXPECT_EQ(dvl["dvl"].velocity_D_m_s, (std::array<double, 3>{1.0, 0.25, 0.125}));
  EXPECT_TRUE(std::isnan(dvl["dvl"].sigma_m_s));
  EXPECT_EQ(dvl["log"].mode, DvlMode::water);
  EXPECT_EQ(dvl["log"].velocity_D_m_s, (std::array<double, 3>{1.5, 0.25, -0.5}));
  EXPECT_NEAR(dvl["log"].sigma_m_s, 0.2, 1e-12);
}

TEST_F(Ros2Gateway, SaysWhatItRefuses) {
  start(
      {R"(inputs=[{"kind":"imu","topic":"/imu/data","sensor":"imu","frame_id":"base_link","rate_hz":50}])"});
  std::mutex mutex;
  ServiceStatus last;
  const bus::Reader<ServiceStatus> reader(vehicle.participant(),
                                          [&](const ServiceStatus& s, const bus::SampleInfo&) {
                                            const std::lock_guard lock(mutex);
                                            if (s.header.sensor.view() == "ros2_gateway") last = s;
                                          });
  const Peer peer("write", kGraph, {"imu", "rt/imu/data"});
  ASSERT_TRUE(wait_until(
      [&] {
        const std::lock_guard lock(mutex);
        return last.counter("imu.frame") > 10 && last.state == ServiceState::degraded;
      },
      20.0))
      << gateway->err();
  EXPECT_EQ(last.counter("imu.samples"), 0U);
  EXPECT_THAT(last.text, HasSubstr("imu: nothing usable on /imu/data"));
  EXPECT_TRUE(gateway->says("/imu/data: refused (frame): frame_id is 'imu_link', expected 'base_link'"))
      << gateway->err();
}

TEST_F(Ros2Gateway, DiesAndComesBackWithoutHarm) {
  start();
  std::mutex mutex;
  MonitorStatus monitor;
  const bus::Reader<MonitorStatus> reader(vehicle.participant(),
                                          [&](const MonitorStatus& s, const bus::SampleInfo&) {
                                            const std::lock_guard lock(mutex);
                                            monitor = s;
                                          });
  const auto presence = [&] {
    const std::lock_guard lock(mutex);
    for (const WatchedItem& item : monitor.services) {
      if (item.name.view() == "ros2_gateway") return item.presence;
    }
    return Presence::never_seen;
  };
  Process watch("fathom-monitor", {"--config", test::source_dir() + "/deploy/config/monitor.json", "--set",
                                   "bus.domain=" + std::to_string(kVehicle), "--set",
                                   "bus.profiles_dir=" + test::source_dir() + "/deploy/dds", "--set",
                                   "clock.anchor_file=", "--set", "metrics.enabled=false", "--set",
                                   "journal.path=", "--set", R"(services=[{"name":"ros2_gateway"}])"});
  ASSERT_TRUE(wait_until([&] { return presence() == Presence::present; }, 20.0)) << watch.err();
  const Peer tf("follow", kGraph, {"tf", "rt/tf"});
  ASSERT_TRUE(wait_until([&] { return transforms_of(tf.so_far()).size() > 20; }, 20.0));
  gateway->kill(SIGKILL);
  (void)gateway->wait();
  ASSERT_TRUE(wait_until([&] { return presence() == Presence::missing; }, 20.0));
  const std::size_t before = transforms_of(tf.so_far()).size();
  start();
  ASSERT_TRUE(wait_until([&] { return presence() == Presence::present; }, 20.0));
  ASSERT_TRUE(wait_until([&] { return transforms_of(tf.so_far()).size() > before + 20; }, 20.0));
  const std::vector<Along> all = transforms_of(tf.so_far());
  for (std::size_t i = 1; i < all.size(); ++i) EXPECT_GT(all[i].stamp_ns, all[i - 1].stamp_ns);
  EXPECT_TRUE(vehicle.heard()) << "navigation goes on";
}

}  // namespace
}  // namespace fathom
