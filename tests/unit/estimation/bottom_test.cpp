#include "estimation/engine/bottom.hpp"

#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "base/units.hpp"
#include "estimation/engine/fusion_engine.hpp"
#include "geo/so3.hpp"
#include "geo/wgs84.hpp"

namespace fathom::estimation {
namespace {

constexpr TimeNs kBegin = 1'700'000'000 * kNsPerSecond;

EngineConfig config_with(const std::array<double, 3>& lever_B_m) {
  EngineConfig config;
  config.imu.nominal_rate_hz = 100.0;
  config.altimeter.lever_B_m = lever_B_m;
  config.altimeter.fresh_s = 1.0;
  return config;
}

/// A vehicle that keeps its attitude and goes down at a constant speed.
class Diver {
 public:
  Diver(const EngineConfig& config, double pitch_rad, double down_m_s) : engine_(config) {
    InitialState start;
    start.stamp_ns = kBegin;
    start.latitude_rad = 0.6;
    start.longitude_rad = 0.2;
    start.altitude_m = -20.0;
    start.velocity_N_m_s = {0.0, 0.0, down_m_s};
    start.rpy_rad = {0.0, pitch_rad, 0.0};
    engine_.start_from(start);
    const geo::LocalEarth earth({0.6, 0.2, -20.0});
    const Eigen::Matrix3d c = geo::to_matrix(geo::from_rpy({0.0, pitch_rad, 0.0}));
    rate_B_ = geo::arr(Eigen::Vector3d(c.transpose() * earth.earth_rate_N));
    force_B_ = geo::arr(Eigen::Vector3d(
        c.transpose() *
        (geo::cross(2.0 * earth.earth_rate_N, Eigen::Vector3d(0.0, 0.0, down_m_s)) - earth.gravity_N())));
  }

  void until(double t_s) {
    for (; step_ <= std::llround(t_s * 100.0); ++step_) {
      ImuSample imu;
      imu.header.stamp_ns = imu.header.received_ns = kBegin + step_ * 10'000'000;
      imu.header.sequence = static_cast<std::uint64_t>(step_);
      imu.angular_rate_B_rad_s = rate_B_;
      imu.specific_force_B_m_s2 = force_B_;
      engine_.add(imu);
    }
  }
  void hear(double t_s, double altitude_m, bool vertical = false) {
    AltimeterSample sample;
    sample.header.sensor = "altimeter";
    sample.header.stamp_ns = sample.header.received_ns = kBegin + from_seconds(t_s);
    sample.altitude_m = altitude_m;
    sample.vertical = vertical;
    engine_.add(sample);
  }
  [[nodiscard]] double altitude_m() const { return engine_.nav_state().altitude_above_bottom_m; }
  [[nodiscard]] FusionEngine& engine() { return engine_; }

 private:
  FusionEngine engine_;
  std::int64_t step_ = 0;
  std::array<double, 3> rate_B_{};
  std::array<double, 3> force_B_{};
};

TEST(Bottom, IsUnknownUntilHeardAndWhenItIsNoLongerFresh) {
  Diver diver(config_with({0.0, 0.0, 0.0}), 0.0, 0.0);
  diver.until(1.0);
  EXPECT_FALSE(known(diver.altitude_m()));
  diver.hear(1.0, 12.0);
  EXPECT_FALSE(known(diver.altitude_m()));  // from the next inertial sample on
  diver.until(1.01);
  EXPECT_NEAR(diver.altitude_m(), 12.0, 1e-3);
  diver.hear(1.5, kUnknown);  // no bottom: what was heard holds as long as it is fresh
  diver.hear(0.5, 99.0);      // an older one
  diver.until(2.0);
  EXPECT_NEAR(diver.altitude_m(), 12.0, 1e-2);
  diver.until(2.02);
  EXPECT_FALSE(known(diver.altitude_m()));
}

TEST(Bottom, AStampOutOfTheFutureKeepsNobodyOut) {
  Diver diver(config_with({0.0, 0.0, 0.0}), 0.0, 0.0);
  diver.until(1.0);
  diver.hear(1e6, 99.0);
  diver.until(1.1);
  EXPECT_FALSE(known(diver.altitude_m()));
  diver.hear(1.1, 12.0);
  diver.until(1.2);
  EXPECT_NEAR(diver.altitude_m(), 12.0, 1e-2);
}

TEST(Bottom, AStampOutOfTheFutureKeepsNoneOutThatComesRightBehindIt) {
  Diver diver(config_with({0.0, 0.0, 0.0}), 0.0, 0.0);
  diver.hear(1e6, 99.0);
  diver.hear(0.0, 12.0);
  diver.until(0.1);
  EXPECT_NEAR(diver.altitude_m(), 12.0, 1e-2);
  for (int i = 1; i <= 20; ++i) {
    diver.hear(1e6 + i, 99.0);
    diver.hear(0.1 * i, 14.0);
    diver.until(0.1 * i + 0.01);
    EXPECT_NEAR(diver.altitude_m(), 14.0, 1e-2) << i;
  }
}

TEST(Bottom, AStampThatIsNoneGetsAVerdict) {
  Diver diver(config_with({0.0, 0.0, 0.0}), 0.0, 0.0);
  const auto verdicts = [&] {
    std::vector<VerdictKind> out;
    for (Verdict verdict; diver.engine().next_verdict(verdict);) {
      EXPECT_EQ(verdict.source, SourceKind::altimeter);
      EXPECT_TRUE(verdict.is_final);
      out.push_back(verdict.kind);
    }
    return out;
  };
  const auto hear_at = [&](TimeNs stamp_ns) {
    AltimeterSample sample;
    sample.header.stamp_ns = stamp_ns;
    sample.altitude_m = 99.0;
    diver.engine().add(sample);
  };
  for (int i = 0; i < 2; ++i) {
    hear_at(std::numeric_limits<TimeNs>::min());
    hear_at(std::numeric_limits<TimeNs>::max());
    EXPECT_EQ(verdicts(), (std::vector<VerdictKind>{VerdictKind::out_of_range, VerdictKind::out_of_range}));
    diver.until(1.0);  // the first inertial samples
  }
  hear_at(kBegin + 60 * kNsPerSecond);
  EXPECT_EQ(verdicts(), std::vector<VerdictKind>{VerdictKind::from_the_future});
  diver.hear(1.0, 12.0);
  diver.hear(0.5, 99.0);  // an older one is nothing that anybody did wrong
  EXPECT_EQ(verdicts(), std::vector<VerdictKind>{});
  diver.until(1.1);
  EXPECT_NEAR(diver.altitude_m(), 12.0, 1e-2);
}

TEST(Bottom, TiltAndLeverAreTakenOut) {
  Diver diver(config_with({2.0, 0.0, 0.5}), 30.0 * kRadPerDeg, 0.0);
  diver.until(1.0);
  diver.hear(1.0, 10.0);
  diver.until(1.01);
  // The transducer ahead of a raised nose lies higher: 2 sin 30 up, 0.5 cos 30 down.
  const double lower_m = 0.5 * std::cos(30.0 * kRadPerDeg) - 2.0 * std::sin(30.0 * kRadPerDeg);
  EXPECT_NEAR(diver.altitude_m(), 10.0 * std::cos(30.0 * kRadPerDeg) + lower_m, 1e-3);
  diver.hear(1.01, 10.0, true);
  diver.until(1.02);
  EXPECT_NEAR(diver.altitude_m(), 10.0 + lower_m, 1e-3);
}

TEST(Bottom, FollowsTheWayDownSinceTheStamp) {
  Diver diver(config_with({0.0, 0.0, 0.0}), 0.0, 2.0);
  diver.until(1.0);
  diver.hear(1.0, 50.0);
  diver.until(1.5);
  EXPECT_NEAR(diver.altitude_m(), 49.0, 1e-2);
}

TEST(Bottom, AnAxisFarOffTheVerticalSaysNothing) {
  Diver diver(config_with({0.0, 0.0, 0.0}), 65.0 * kRadPerDeg, 0.0);
  diver.until(1.0);
  diver.hear(1.0, 10.0);
  diver.until(1.01);
  EXPECT_FALSE(known(diver.altitude_m()));
}

TEST(Bottom, NothingElseDependsOnIt) {
  Diver with(config_with({0.0, 0.0, 0.0}), 0.1, 0.5);
  Diver without(config_with({0.0, 0.0, 0.0}), 0.1, 0.5);
  with.until(1.0);
  with.hear(0.9, 10.0);
  with.until(2.0);
  without.until(2.0);
  const NavState& a = with.engine().nav_state();
  const NavState& b = without.engine().nav_state();
  EXPECT_EQ(a.latitude_rad, b.latitude_rad);
  EXPECT_EQ(a.velocity_N_m_s, b.velocity_N_m_s);
  EXPECT_EQ(a.position_covariance_N_m2, b.position_covariance_N_m2);
  Verdict verdict;
  EXPECT_FALSE(with.engine().next_verdict(verdict));
}

TEST(Bottom, OnlyTheConfiguredAltimeterIsHeard) {
  EngineConfig config = config_with({0.0, 0.0, 0.0});
  config.altimeter.sensor = "aft";
  Diver diver(config, 0.0, 0.0);
  diver.until(1.0);
  diver.hear(1.0, 12.0);
  diver.until(1.01);
  EXPECT_FALSE(known(diver.altitude_m()));
}

}  // namespace
}  // namespace fathom::estimation
