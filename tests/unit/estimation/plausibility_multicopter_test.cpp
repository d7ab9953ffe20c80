// A multicopter accelerates by tilting: the force that it feels stays along its own down axis, whatever
// gravity does.
#include <array>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "base/units.hpp"
#include "estimation/engine/fusion_engine.hpp"
#include "geo/so3.hpp"
#include "geo/wgs84.hpp"
#include "samples/alignment/help.hpp"
#include "sim/random.hpp"

namespace fathom::estimation {
namespace {

using Eigen::Vector3d;

/// To and fro across its nose, which points north-east: no turns, rolls of 25 degrees.
struct Zigzag {
  static constexpr TimeNs kStart_ns = 1'700'000'000 * kNsPerSecond;
  static constexpr double kStep_s = 0.01;
  static constexpr geo::Geodetic kOrigin{36.4 * kRadPerDeg, 127.4 * kRadPerDeg, 50.0};
  static constexpr double kPeriod_s = 5.0;
  static constexpr double kMost_m_s2 = 4.6;
  static constexpr double kRate_rad_s = 2.0 * M_PI / kPeriod_s;
  static constexpr double kYaw_rad = 0.8;

  [[nodiscard]] static double acceleration_m_s2(double t_s) {
    return kMost_m_s2 * std::sin(kRate_rad_s * t_s);
  }
  [[nodiscard]] static double roll_rad(double t_s) {
    return std::atan2(acceleration_m_s2(t_s), kStandardGravity_m_s2);
  }
  [[nodiscard]] static Vector3d velocity_N_m_s(double t_s) {
    return -kMost_m_s2 / kRate_rad_s * std::cos(kRate_rad_s * t_s) * across_N();
  }
  [[nodiscard]] static Vector3d position_N_m(double t_s) {
    return -kMost_m_s2 / (kRate_rad_s * kRate_rad_s) * std::sin(kRate_rad_s * t_s) * across_N();
  }
  [[nodiscard]] static Vector3d across_N() { return {-std::sin(kYaw_rad), std::cos(kYaw_rad), 0.0}; }

  [[nodiscard]] static EngineConfig config();
  [[nodiscard]] static ImuSample felt(double t_s, sim::Random& random);
  [[nodiscard]] static GpsSample fix(double t_s, sim::Random& random);
};

EngineConfig Zigzag::config() {
  EngineConfig out;
  out.alignment.mode = StartMode::given;
  out.imu.nominal_rate_hz = 1.0 / kStep_s;
  out.sensors.push_back(default_sensor(SourceKind::gps, "gps"));
  return out;
}

ImuSample Zigzag::felt(double t_s, sim::Random& random) {
  ImuSample out;
  out.header.sensor = "imu";
  out.header.stamp_ns = out.header.received_ns = kStart_ns + from_seconds(t_s);
  const double middle_s = t_s - 0.5 * kStep_s;
  const double roll_rate = (roll_rad(t_s) - roll_rad(t_s - kStep_s)) / kStep_s;
  const double thrust = std::hypot(acceleration_m_s2(middle_s), kStandardGravity_m_s2);
  out.angular_rate_B_rad_s = {roll_rate, 0.0, 0.0};
  out.specific_force_B_m_s2 = {0.0, 0.0, -thrust};
  for (double& one : out.angular_rate_B_rad_s) one += 1e-3 * random.normal();
  for (double& one : out.specific_force_B_m_s2) one += 0.3 * random.normal();
  return out;
}

GpsSample Zigzag::fix(double t_s, sim::Random& random) {
  GpsSample out;
  out.header.sensor = "gps";
  out.header.stamp_ns = out.header.received_ns = kStart_ns + from_seconds(t_s);
  out.fix = GpsFix::rtk_fixed;
  Vector3d position = position_N_m(t_s);
  Vector3d velocity = velocity_N_m_s(t_s);
  for (int i = 0; i < 3; ++i) {
    position[i] += 0.03 * random.normal();
    velocity[i] += 0.05 * random.normal();
  }
  const geo::Geodetic place = geo::moved_by(kOrigin, position);
  out.latitude_rad = place.latitude_rad;
  out.longitude_rad = place.longitude_rad;
  out.altitude_m = place.altitude_m;
  out.velocity_N_m_s = geo::arr(velocity);
  return out;
}

std::string found_in_zigzag(std::uint64_t seed) {
  FusionEngine engine(Zigzag::config());
  InitialState start;
  start.latitude_rad = Zigzag::kOrigin.latitude_rad;
  start.longitude_rad = Zigzag::kOrigin.longitude_rad;
  start.altitude_m = Zigzag::kOrigin.altitude_m;
  start.velocity_N_m_s = geo::arr(Zigzag::velocity_N_m_s(0.0));
  start.rpy_rad = {0.0, 0.0, Zigzag::kYaw_rad};
  engine.start_from(start);
  sim::Random random(seed, "multicopter");
  AlignmentStatus status;
  for (int k = 1; k <= 12'000; ++k) {
    const double t_s = k * Zigzag::kStep_s;
    if (k % 10 == 0) engine.add(Zigzag::fix(t_s, random));
    engine.add(Zigzag::felt(t_s, random));
    if (k % 50 != 0) continue;
    engine.fill(status);
    if (const AlignmentCondition* found = implausible(status)) return std::string(found->name.view());
  }
  return std::string(to_string(status.phase));
}

TEST(Plausibility, AMulticopterThatGoesToAndFroIsLeftAlone) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed)
    EXPECT_EQ(found_in_zigzag(seed), "aligned") << "seed " << seed;
}

}  // namespace
}  // namespace fathom::estimation
