#include <gtest/gtest.h>

#include "estimation/aiding/registry.hpp"

namespace fathom::estimation {
namespace {

using Eigen::Vector3d;

class AirData : public ::testing::Test {
 protected:
  AirData() : sensor_(default_sensor(SourceKind::airspeed, "air0")), index_(groups()) {
    sensor_.sideslip_sigma_rad = 0.1;
    sensor_.attack_sigma_rad = 0.2;
    sensor_.baro_sigma_m = 3.0;
    sample_.airspeed_m_s = 18.7;
    sample_.baro_altitude_m = 110.0;
    // 20 m/s north in an east wind of 5 m/s, flown into the air as it comes.
    state_.nav.position.altitude_m = 0.0;
    state_.nav.v_N_m_s = {20.0, 0.0, 0.0};
    set(Group::current, 1, -5.0);
    state_.nav.q_NB = geo::from_rpy({0.0, 0.0, std::atan2(5.0, 20.0)});
  }
  static StateGroups groups() {
    StateGroups g;
    g.current = g.airspeed_bias = g.airspeed_scale = g.flow_angles = g.baro_bias = true;
    return g;
  }
  void set(Group group, int component, double value) {
    state_.x[static_cast<std::size_t>(index_.of(group) + component)] = value;
  }
  [[nodiscard]] Observation rows(double unused_s = kUnknown) const {
    const AidingState aiding(index_, state_, Vector3d::Zero(), kUnknown);
    const AidingInput input{
        .state = aiding, .sensor = sensor_, .surface_altitude_m = 0.0, .unused_s = unused_s};
    Observation out;
    for (const AidingEntry& entry : aiding_registry())
      if (entry.source == SourceKind::airspeed) (void)entry.observe(input, sample_, out);
    return out;
  }

  SensorConfig sensor_;
  StateIndex index_;
  FilterState state_;
  AirspeedSample sample_;
};

TEST_F(AirData, SpeedFlowAndHeightAreFourRows) {
  set(Group::airspeed_bias, 0, -1.3);
  set(Group::airspeed_scale, 0, -0.03);
  set(Group::baro_bias, 0, 108.0);
  const Observation out = rows();
  ASSERT_EQ(out.rows, 4);
  EXPECT_TRUE(out.each_alone);
  EXPECT_NEAR(out.innovation[0], 0.97 * std::hypot(20.0, 5.0) - 1.3 - 18.7, 1e-12);
  EXPECT_NEAR(out.innovation[1], 0.0, 1e-12);
  EXPECT_NEAR(out.innovation[2], 0.0, 1e-12);
  EXPECT_NEAR(out.innovation[3], -2.0, 1e-12);
  EXPECT_NEAR(out.sigma[1], 0.1 * std::hypot(20.0, 5.0), 1e-12);
}

TEST_F(AirData, AGustLastsLongerThanASample) {
  const Observation noise = rows(0.1);
  sensor_.gust_time_s = 0.9;
  const Observation gusts = rows(0.1);
  // Speed and flow are as wrong again; the barometer is not blown away.
  EXPECT_NEAR(gusts.sigma[0], 3.0 * noise.sigma[0], 1e-12);
  EXPECT_NEAR(gusts.sigma[1], 3.0 * noise.sigma[1], 1e-12);
  EXPECT_NEAR(gusts.sigma[2], 3.0 * noise.sigma[2], 1e-12);
  EXPECT_EQ(gusts.sigma[3], noise.sigma[3]);
  // The first sample, and one behind a pause, meet a gust of their own.
  EXPECT_EQ(rows().sigma[1], noise.sigma[1]);
  EXPECT_EQ(rows(5.0).sigma[1], noise.sigma[1]);
}

TEST_F(AirData, CrabbingWithoutItsWindIsSideslip) {
  set(Group::current, 1, 0.0);
  const double crab = std::atan2(5.0, 20.0);
  EXPECT_NEAR(rows().innovation[1], -20.0 * std::sin(crab), 1e-12);
  set(Group::flow_angles, 0, -std::tan(crab));
  EXPECT_NEAR(rows().innovation[1], 0.0, 1e-12);
}

TEST_F(AirData, OnTheGroundOnlyTheHeightCounts) {
  sample_.airspeed_m_s = -1.3;
  const Observation out = rows();
  ASSERT_EQ(out.rows, 1);
  EXPECT_EQ(out.sigma[0], 3.0);
  sensor_.baro_sigma_m = 0.0;
  EXPECT_EQ(rows().rows, 0);
}

TEST_F(AirData, ThinAirIndicatesLess) {
  // ISA at 3000 m: density 0.7421 of that at sea level.
  state_.nav.position.altitude_m = 3000.0;
  EXPECT_NEAR(rows().innovation[0] + 18.7, std::sqrt(0.7421) * std::hypot(20.0, 5.0), 5e-3);
}

TEST_F(AirData, ATrueAirspeedIsTakenAsItIsAndBeforeTheIndicatedOne) {
  state_.nav.position.altitude_m = 3000.0;
  sample_.true_airspeed_m_s = 21.5;
  const Observation out = rows();
  EXPECT_NEAR(out.innovation[0], std::hypot(20.0, 5.0) - 21.5, 1e-12);
  sample_.airspeed_m_s = kUnknown;
  EXPECT_EQ(rows().innovation[0], out.innovation[0]);
  sample_.true_airspeed_m_s = 800.0;
  EXPECT_EQ(rows().rows, 1);  // the height alone
}

}  // namespace
}  // namespace fathom::estimation
