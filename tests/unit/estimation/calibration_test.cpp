#include "estimation/hydro/calibration.hpp"

#include <cmath>
#include <cstring>

#include <gtest/gtest.h>

#include "geo/so3.hpp"
#include "support/vehicles/analytic_vehicle.hpp"
#include "support/vehicles/small_vehicle.hpp"

namespace fathom::estimation::hydro {
namespace {

using Eigen::Vector3d;

constexpr double kDt_s = 0.1;

/// Fins and shaft speed at work, turns both ways, a current; velocities with noise.
std::vector<CalibrationPoint> log_of(const HydroCoefficients& truth, double duration_s,
                                     const Vector3d& current_N, double noise_m_s) {
  const VehicleModel vehicle(truth);
  test::Normal normal(17);
  std::vector<CalibrationPoint> log;
  Vector6 nu = Vector6::Zero();
  nu[0] = 1.4;
  geo::Quaternion q = geo::from_rpy({0.0, 0.0, 0.4});
  constexpr int kParts = 10;
  for (int i = 0; i < static_cast<int>(duration_s / kDt_s); ++i) {
    const double t = i * kDt_s;
    CalibrationPoint point;
    point.dt_s = kDt_s;
    point.controls = {std::fmod(t, 80.0) < 40.0 ? 1200.0 : 800.0, 0.15 * std::sin(0.11 * t),
                      0.08 * std::sin(0.23 * t)};
    Vector3d turned = Vector3d::Zero();
    for (int k = 0; k < kParts; ++k) {
      const Vector3d gamma = geo::to_matrix(q).row(2).transpose();
      const Vector6 after = vehicle.step(nu, gamma, point.controls, kDt_s / kParts);
      const Vector3d rate = 0.5 * (nu.tail<3>() + after.tail<3>());
      nu = after;
      q = geo::normalized(q * geo::exp(rate * (kDt_s / kParts)));
      turned += rate / kParts;
    }
    point.omega_B_rad_s = turned;
    point.C_NB = geo::to_matrix(q);
    point.V_ground_B_m_s = nu.head<3>() + point.C_NB.transpose() * current_N + normal.vector(noise_m_s);
    point.vouched = true;
    log.push_back(point);
  }
  log.front().dt_s = 0.0;
  return log;
}

HydroCoefficients vehicle_with_fins() {
  HydroCoefficients c = test::small_vehicle();
  c.x_G = c.y_G = 0.0;
  c.K_pp = -5.0;
  c.Y_uudr = 12.0;
  c.Z_uuds = -12.0;
  c.N_uudr = c.M_uuds = -8.0;
  c.N_ur = c.M_uq = -12.0;
  return c;
}

const CalibratedCoefficient* find(const Calibration& found, const char* name) {
  for (const CalibratedCoefficient& one : found.found)
    if (std::strcmp(one.entry->name, name) == 0) return &one;
  return nullptr;
}

TEST(Calibration, FindsWhatTheLogShows) {
  const HydroCoefficients truth = vehicle_with_fins();
  HydroCoefficients start = truth;
  start.X_uu *= 1.25;
  start.Y_uv *= 0.75;
  start.Y_uudr *= 1.2;
  start.Z_uw *= 1.2;
  start.X_prop *= 0.85;
  const Vector3d current(0.2, -0.1, 0.0);
  const Calibration found = calibrate(start, log_of(truth, 240.0, current, 0.005));
  ASSERT_EQ(found.failure, "");
  EXPECT_NEAR(found.compared_s, 240.0, 0.2);
  EXPECT_LT(found.residual_after_m_s.maxCoeff(), 0.0065);
  EXPECT_GT(found.residual_before_m_s.maxCoeff(), 0.02);
  for (int i = 0; i < 2; ++i)
    EXPECT_NEAR(found.current_N_m_s(i), current(i), 5.0 * found.current_sigma_m_s(i) + 1e-3) << i;
  for (const CalibratedCoefficient& one : found.found) {
    // Sigmas are those of noise; a tenth of a second is taken as a whole, which costs a little more.
    EXPECT_NEAR(one.after, truth.*one.entry->member,
                4.0 * one.sigma + 0.02 * std::abs(truth.*one.entry->member))
        << one.entry->name;
    EXPECT_LE(one.sigma, 0.31 * std::abs(one.before)) << one.entry->name;
  }
  for (const char* name : {"X_uu", "X_prop", "Y_uv"}) {
    const CalibratedCoefficient* one = find(found, name);
    ASSERT_NE(one, nullptr) << name;
    EXPECT_TRUE(one->observable) << name << " " << one->sigma;
  }
  // Moments are not looked at.
  EXPECT_EQ(find(found, "N_uudr"), nullptr);
  EXPECT_EQ(found.coefficients.N_uudr, start.N_uudr);
  EXPECT_EQ(found.coefficients.weight, start.weight);
}

TEST(Calibration, SaysWhatALogLacks) {
  const HydroCoefficients truth = vehicle_with_fins();
  const Calibration small = calibrate(truth, log_of(truth, 30.0, Vector3d::Zero(), 0.005));
  EXPECT_EQ(small.failure, "the DVL stands behind 29 s under water, expected at least 60 s");
  EXPECT_EQ(small.coefficients.X_uu, truth.X_uu);
  // Straight ahead at one speed, nothing is known of turning.
  auto straight = log_of(truth, 100.0, Vector3d::Zero(), 0.002);
  for (CalibrationPoint& point : straight) {
    point.controls = {1200.0, 0.0, 0.0};
    point.omega_B_rad_s.setZero();
    point.C_NB.setIdentity();
    point.V_ground_B_m_s = {2.0, 0.0, 0.0};
  }
  const Calibration found = calibrate(truth, straight);
  ASSERT_EQ(found.failure, "");
  EXPECT_FALSE(find(found, "Y_uudr")->observable);
  EXPECT_FALSE(find(found, "Y_rdot")->observable);
}

}  // namespace
}  // namespace fathom::estimation::hydro
