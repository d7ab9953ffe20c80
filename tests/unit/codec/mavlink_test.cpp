// Telemetry of an autopilot: a stream that node-mavlink wrote (of a submarine, system 4), and what is left
// out of it.

#include <cmath>
#include <fstream>
#include <iterator>
#include <numbers>

#include <gtest/gtest.h>

#include "base/units.hpp"
#include "mavlink/frame.hpp"
#include "mavlink/messages.hpp"
#include "support/codec/decode_run.hpp"
#include "support/paths.hpp"

namespace fathom::test {
namespace {

constexpr double kG = 9.80665;

ByteVector recorded() {
  std::ifstream in(vectors_dir() + "/mavlink/telemetry.bin", std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST(MavlinkTelemetry, EveryMessageBecomesASample) {
  const DecodeRun run = decode_whole("mavlink", recorded(), {});
  EXPECT_TRUE(run.rejected.empty());
  EXPECT_EQ(run.totals.skipped_bytes, 0U);
  const auto headings = run.all<HeadingSample>();
  ASSERT_EQ(headings.size(), 10U) << "neither the gimbal's nor those of another vehicle";
  for (std::size_t i = 0; i < headings.size(); ++i) {
    const double yaw = -1.5 + 0.25 * static_cast<double>(i);
    EXPECT_NEAR(headings[i].heading_rad, yaw < 0.0 ? yaw + 2.0 * std::numbers::pi : yaw, 1e-6);
  }
  const auto inertial = run.all<ImuSample>();
  ASSERT_EQ(inertial.size(), 10U);
  EXPECT_NEAR(inertial[3].specific_force_B_m_s2[0], 0.013 * kG, 1e-9);
  EXPECT_NEAR(inertial[3].specific_force_B_m_s2[2], -kG, 1e-9);
  EXPECT_NEAR(inertial[3].angular_rate_B_rad_s[2], 0.1, 1e-9);
  EXPECT_NEAR(inertial[3].temperature_degC, 25.0, 1e-9);
  const auto fixes = run.all<GpsSample>();
  ASSERT_EQ(fixes.size(), 10U);
  EXPECT_EQ(fixes[4].fix, GpsFix::none);
  EXPECT_FALSE(known(fixes[4].latitude_rad));
  EXPECT_EQ(fixes[5].fix, GpsFix::rtk_fixed);
  EXPECT_NEAR(fixes[5].latitude_rad / kRadPerDeg, -33.4999995, 1e-10);
  EXPECT_NEAR(fixes[5].altitude_m, 33.5, 1e-9);
  EXPECT_NEAR(fixes[5].altitude_msl_m, 12.5, 1e-9);
  EXPECT_NEAR(fixes[5].velocity_N_m_s[1], 1.5, 1e-9) << "east";
  EXPECT_FALSE(known(fixes[5].velocity_N_m_s[2]));
  EXPECT_NEAR(fixes[5].position_sigma_N_m[0], 1.5 / std::numbers::sqrt2, 1e-9);
  EXPECT_NEAR(fixes[0].velocity_N_m_s[0], 0.0, 1e-12) << "who stands needs no course";
  const auto depths = run.all<DepthSample>();
  ASSERT_EQ(depths.size(), 10U) << "the barometer in the hull is none";
  EXPECT_NEAR(depths[0].depth_m, 0.0, 1e-3);
  EXPECT_NEAR(depths[9].pressure_Pa, 101'325.0 + 90'000.0, 0.1);
  EXPECT_NEAR(depths[9].depth_m, 8.95, 0.05);
  const auto heights = run.all<AltimeterSample>();
  ASSERT_EQ(heights.size(), 8U) << "one was out of range, one did not look down";
  EXPECT_NEAR(heights[0].altitude_m, 12.34, 1e-9);
  EXPECT_NEAR(heights[0].sigma_m, 0.1, 1e-9);
  for (const codec::Decoded& decoded : run.samples) {
    ASSERT_TRUE(decoded.time.clock_ns.has_value());
    EXPECT_GE(*decoded.time.clock_ns, 100 * kNsPerSecond);
    EXPECT_LE(*decoded.time.clock_ns, 101 * kNsPerSecond);
  }
}

// The ground station, or a second vehicle on the same radio, may be heard first.
TEST(MavlinkTelemetry, OfTheSystemThatIsNamedAloneWhoeverIsHeardFirst) {
  ByteVector bytes = mavlink::frame_of(mavlink::Attitude{}, {7, 1}, 0);
  const ByteVector vehicle = recorded();
  bytes.insert(bytes.end(), vehicle.begin(), vehicle.end());
  EXPECT_EQ(decode_whole("mavlink", bytes, {}).all<HeadingSample>().size(), 1U) << "of the stranger";
  codec::CodecOptions options;
  options.mavlink_system = 4;
  EXPECT_EQ(decode_whole("mavlink", bytes, options).all<HeadingSample>().size(), 10U);
  options.mavlink_system = 7;
  EXPECT_EQ(decode_whole("mavlink", bytes, options).all<HeadingSample>().size(), 1U);
}

TEST(MavlinkTelemetry, TimeSinceTheEpochIsUtc) {
  mavlink::GpsRawInt fix;
  fix.fix_type = 3;
  fix.time_usec = 1'777'000'000'000'000;
  const DecodeRun run = decode_whole("mavlink", mavlink::frame_of(fix, {1, 1}, 0), {});
  ASSERT_EQ(run.samples.size(), 1U);
  EXPECT_EQ(run.samples[0].time.utc_ns, 1'777'000'000 * kNsPerSecond);
}

TEST(MavlinkTelemetry, WhatCannotBeIsRefusedWithAReason) {
  const auto reason = [](const auto& message) {
    const DecodeRun run = decode_whole("mavlink", mavlink::frame_of(message, {1, 1}, 0), {});
    EXPECT_TRUE(run.samples.empty());
    return run.rejected.empty() ? std::optional<codec::RejectReason>() : run.rejected.front().reason;
  };
  mavlink::Attitude attitude;
  attitude.yaw = 7.0F;
  EXPECT_EQ(reason(attitude), codec::RejectReason::out_of_range);
  attitude.yaw = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(reason(attitude), codec::RejectReason::out_of_range);
  mavlink::ScaledPressure2 pressure;
  pressure.press_abs = -5.0F;
  EXPECT_EQ(reason(pressure), codec::RejectReason::out_of_range);
  mavlink::GpsRawInt fix;
  fix.fix_type = 3;
  fix.lat = 900'000'001;
  EXPECT_EQ(reason(fix), codec::RejectReason::out_of_range);
}

}  // namespace
}  // namespace fathom::test
