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
  [[nodiscard]] Observation rows() const {
    const AidingState aiding(index_, state_, Vector3d::Zero(), kUnknown);
    Observation out;
    for (const AidingEntry& entry : aiding_registry())
      if (entry.source == SourceKind::airspeed) (void)entry.observe({aiding, sensor_, 0.0}, sample_, out);
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

}  // namespace
}  // namespace fathom::estimation
