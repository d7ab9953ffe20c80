#include <algorithm>
#include <cmath>
#include <ostream>
#include <string>

#include <gtest/gtest.h>

#include "base/units.hpp"
#include "ecef_integrator.hpp"
#include "geo/wgs84.hpp"
#include "sim/truth_generator.hpp"
#include "sim/vehicles/vehicle.hpp"
#include "vehicles.hpp"

namespace fathom::sim {
namespace {

struct ClosureCase {
  const char* name;
  Scenario scenario;
  double duration_s;
  double rate_hz;
  double position_m;
  double velocity_m_s;
  double attitude_rad;
};

void PrintTo(const ClosureCase& c, std::ostream* out) {
  *out << c.name;
}

class InertialClosure : public testing::TestWithParam<ClosureCase> {};

// Perfect inertial sensors, integrated in another frame, come back to the trajectory.
TEST_P(InertialClosure, IncrementsReproduceTheTrajectory) {
  const ClosureCase& expected = GetParam();
  TruthGenerator truth(expected.scenario, 3);
  test::EcefIntegrator navigator(truth.point());
  const auto steps = static_cast<int>(expected.duration_s * expected.rate_hz);
  double worst_m = 0.0;
  for (int i = 1; i <= steps; ++i) {
    navigator.add(truth.advance_to(i / expected.rate_hz));
    worst_m = std::max(worst_m, navigator.position_error_m(truth.point()));
  }
  RecordProperty("worst_mm", std::to_string(worst_m * 1e3));
  RecordProperty("velocity_mm_s", std::to_string(navigator.velocity_error_m_s(truth.point()) * 1e3));
  RecordProperty("attitude_nrad", std::to_string(navigator.attitude_error_rad(truth.point()) * 1e9));
  EXPECT_LT(worst_m, expected.position_m);
  EXPECT_LT(navigator.velocity_error_m_s(truth.point()), expected.velocity_m_s);
  EXPECT_LT(navigator.attitude_error_rad(truth.point()), expected.attitude_rad);
}

INSTANTIATE_TEST_SUITE_P(
    Vehicles, InertialClosure,
    testing::Values(ClosureCase{"auv", test::auv_scenario(), 600.0, 200.0, 0.01, 1e-4, 1e-6},
                    ClosureCase{"rotating_arm", test::arm_scenario(), 600.0, 100.0, 0.01, 1e-4, 1e-6},
                    ClosureCase{"aircraft", test::aircraft_scenario(), 120.0, 100.0, 0.05, 2e-3, 1e-6},
                    ClosureCase{"air_drop", test::air_drop_scenario(), 60.0, 200.0, 0.05, 2e-3, 1e-6}),
    [](const auto& info) { return info.param.name; });

TEST(Truth, AtRestTheImuSensesGravityAndEarthRate) {
  Scenario scenario = test::arm_scenario();
  scenario.mission = {{0.0, 0.0}};
  TruthGenerator truth(scenario, 1);
  const ImuTruth imu = truth.advance_to(0.01);
  const double lat = scenario.start.latitude_rad;
  const Eigen::Vector3d gravity_N = geo::gravity_N(lat, 19.0);
  EXPECT_NEAR(imu.delta_velocity_B_m_s.z(), -gravity_N.z() * 0.01, 1e-9);
  EXPECT_NEAR(imu.delta_velocity_B_m_s.x(), -gravity_N.x() * 0.01, 1e-12);
  EXPECT_NEAR(imu.delta_angle_B_rad.x(), geo::kEarthRate_rad_s * std::cos(lat) * 0.01, 1e-12);
  EXPECT_NEAR(imu.delta_angle_B_rad.z(), -geo::kEarthRate_rad_s * std::sin(lat) * 0.01, 1e-12);
}

TEST(Truth, TheArmTurnsOnACircle) {
  TruthGenerator truth(test::arm_scenario(), 1);
  for (int i = 1; i <= 3000; ++i) (void)truth.advance_to(i * 0.01);
  const TruthPoint a = truth.point();
  EXPECT_NEAR(a.v_N_m_s.norm(), 3.0, 5e-3);
  // Half a turn later it is a diameter away and at the same depth.
  const double half_turn_s = 3.14159265358979 * 8.0 / a.v_N_m_s.norm();
  (void)truth.advance_to(a.t_s + half_turn_s / 2);
  (void)truth.advance_to(a.t_s + half_turn_s);
  const TruthPoint b = truth.point();
  const auto moved = geo::difference_N({a.latitude_rad, a.longitude_rad, a.altitude_m},
                                       {b.latitude_rad, b.longitude_rad, b.altitude_m});
  EXPECT_NEAR(moved.norm(), 16.0, 0.01);
  EXPECT_NEAR(moved.z(), 0.0, 1e-3);
}

TEST(Truth, TheAuvRestsDivesAndSurfaces) {
  TruthGenerator truth(test::auv_scenario(), 1);
  double deepest_m = 0.0;
  for (int i = 1; i <= 13000; ++i) {
    (void)truth.advance_to(i * 0.01);
    const TruthPoint& now = truth.point();
    deepest_m = std::max(deepest_m, now.depth_m);
    if (now.t_s < 10.0) {
      EXPECT_LT(std::hypot(now.v_N_m_s.x(), now.v_N_m_s.y()), 0.03);
      EXPECT_LT(now.depth_m, 0.3);
    }
    if (now.t_s > 75.0 && now.t_s < 90.0) {
      EXPECT_NEAR(now.depth_m, 6.0, 1.0);
    }
  }
  EXPECT_LT(deepest_m, 7.0);
  EXPECT_LT(truth.point().depth_m, 0.3);
  // Ground velocity is the motion through the water plus the current.
  const TruthPoint& now = truth.point();
  const Eigen::Vector3d water = now.v_N_m_s - now.q_NB * now.V_B_m_s;
  EXPECT_NEAR(water.x(), 0.2, 1e-9);
  EXPECT_NEAR(water.y(), -0.3, 1e-9);
}

TEST(Truth, ThePositiveRudderTurnsToPortAndThePositiveSternPlanePitchesDown) {
  const Scenario scenario = test::auv_scenario();
  const auto auv = make_auv(scenario.vehicle.auv, scenario.environment, 1);
  BodyState state;
  state.depth_m = 10.0;
  state.V_B_m_s = {2.0, 0.0, 0.0};
  state.actuator = {1000.0, 0.1, 0.1};
  const BodyRates rates = auv->dynamics(state);
  EXPECT_LT(rates.omega_dot_B_rad_s2.z(), 0.0);
  EXPECT_LT(rates.omega_dot_B_rad_s2.y(), 0.0);
}

TEST(Truth, TheAirDropEntersTheWaterAndHoldsItsDepth) {
  TruthGenerator truth(test::air_drop_scenario(), 1);
  double entry_s = 0.0;
  double entry_pitch_rad = 0.0;
  double dive_s = 0.0;
  double steepest_near_depth_rad = 0.0;
  for (int i = 1; i <= 4000; ++i) {
    (void)truth.advance_to(i * 0.01);
    const TruthPoint& now = truth.point();
    const double pitch_rad = rpy_of(now.q_NB).y();
    if (entry_s == 0.0 && now.depth_m > 0.0) {
      entry_s = now.t_s;
      entry_pitch_rad = pitch_rad;
    }
    if (entry_s > 0.0 && dive_s == 0.0 && pitch_rad > -30.0 * kRadPerDeg) dive_s = now.t_s;
    if (now.depth_m > 76.0) steepest_near_depth_rad = std::min(steepest_near_depth_rad, pitch_rad);
  }
  EXPECT_NEAR(entry_s, 12.0, 1.0);
  // The order slews from the attitude of the fall to the dive, and from there the flare takes over.
  EXPECT_LT(entry_pitch_rad, -60.0 * kRadPerDeg);
  EXPECT_NEAR(dive_s - entry_s, 3.0, 1.0);
  EXPECT_GT(steepest_near_depth_rad, -6.5 * kRadPerDeg);
  EXPECT_NEAR(truth.point().depth_m, 80.0, 0.5);
  EXPECT_NEAR(truth.point().V_B_m_s.x(), 17.0, 0.2);
  EXPECT_NEAR(truth.point().rpm * 0.0068, 17.0, 0.3);
}

TEST(Truth, TheAircraftTurnsWithoutSideForce) {
  TruthGenerator truth(test::aircraft_scenario(), 1);
  for (int i = 1; i <= 8000; ++i) (void)truth.advance_to(i * 0.01);
  const TruthPoint& now = truth.point();
  EXPECT_NEAR(rpy_of(now.q_NB).x(), 45.0 * kRadPerDeg, 1.0 * kRadPerDeg);
  EXPECT_NEAR(now.f_B_m_s2.z(), -9.8 / std::cos(45.0 * kRadPerDeg), 1.5);
  EXPECT_NEAR(now.f_B_m_s2.y(), 0.0, 1.0);
}

TEST(Truth, InterpolationAgreesWithIntegration) {
  TruthGenerator coarse(test::arm_scenario(), 1);
  TruthGenerator fine(test::arm_scenario(), 1);
  for (int i = 1; i <= 2000; ++i) {
    (void)coarse.advance_to(i * 0.01);
    (void)fine.advance_to(i * 0.01);
  }
  const TruthPoint a = coarse.point();
  (void)coarse.advance_to(20.01);
  (void)fine.advance_to(20.0037);
  const TruthPoint between = interpolate(a, coarse.point(), 20.0037);
  const TruthPoint& exact = fine.point();
  const auto off = geo::difference_N({exact.latitude_rad, exact.longitude_rad, exact.altitude_m},
                                     {between.latitude_rad, between.longitude_rad, between.altitude_m});
  EXPECT_LT(off.norm(), 1e-6);
  EXPECT_LT((between.v_N_m_s - exact.v_N_m_s).norm(), 1e-4);
  EXPECT_LT(between.q_NB.angularDistance(exact.q_NB), 1e-6);
}

TEST(Truth, ALeverArmMovesWithTheBody) {
  TruthGenerator truth(test::arm_scenario(), 1);
  for (int i = 1; i <= 3000; ++i) (void)truth.advance_to(i * 0.01);
  const TruthPoint at = at_lever(truth.point(), {0.0, 1.0, 0.5});
  // Starboard is inside the turn: a radius of 7 instead of 8 m.
  EXPECT_NEAR(at.v_N_m_s.norm(), truth.point().v_N_m_s.norm() * 7.0 / 8.0, 1e-3);
  EXPECT_NEAR(at.depth_m, 1.5, 1e-3);
}

}  // namespace
}  // namespace fathom::sim
