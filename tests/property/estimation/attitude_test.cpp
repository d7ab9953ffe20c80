#include <gtest/gtest.h>

#include "estimation/filter/strapdown.hpp"
#include "geo/so3.hpp"
#include "support/normal_potential.hpp"

namespace fathom::estimation {
namespace {

using Eigen::Vector3d;

constexpr double kStep_s = 0.1;
constexpr int kDay = 24 * 3600 * 10;  ///< steps

/// The angle between an attitude that turns for an hour as `attitude` says and what the mechanisation makes
/// of the exact increments of its turning, rad.
template <class Attitude>
double drift_rad(double hours, double dt_s, Attitude attitude) {
  NavSolution nav;
  nav.position = {0.9, 0.1, 0.0};
  nav.q_NB = attitude(0.0);
  const NavSolution start = nav;
  const geo::LocalEarth earth(nav.position);
  Increments in;
  in.dt_s = dt_s;
  in.dv_m_s = in.dv_before_m_s = Vector3d(0.0, 0.0, -dt_s * earth.gravity_m_s2);
  // The rate of the body, by differences, and its integral over a step by Simpson's rule.
  const auto rate = [&](double t) {
    constexpr double h = 1e-4;
    const Vector3d turned = geo::log(geo::conjugate(attitude(t - h)) * attitude(t + h)) / (2.0 * h);
    return (turned + geo::to_matrix(attitude(t)).transpose() * earth.earth_rate_N).eval();
  };
  const auto steps = static_cast<int>(hours * 3600.0 / dt_s);
  for (int k = 0; k < steps; ++k) {
    const double t = k * dt_s;
    in.dtheta_before_rad =
        k > 0 ? in.dtheta_rad : (dt_s / 6.0 * (rate(-dt_s) + 4.0 * rate(-0.5 * dt_s) + rate(0.0))).eval();
    in.dtheta_rad = dt_s / 6.0 * (rate(t) + 4.0 * rate(t + 0.5 * dt_s) + rate(t + dt_s));
    nav = mechanise(nav, correct(in));
    nav.position = start.position;  // the attitude alone is looked at
    nav.v_N_m_s.setZero();
  }
  return geo::log(geo::conjugate(attitude(steps * dt_s)) * nav.q_NB).norm();
}

TEST(Attitude, FollowsAConingMotionForAnHour) {
  // Half an angle of 1 degree at 1 Hz: without the coning correction 0.5 a^2 W t = 3.4 rad.
  const auto coning = [](double t) {
    constexpr double kHalfAngle_rad = 0.01745;
    constexpr double kW_rad_s = 6.2832;
    return geo::exp(kHalfAngle_rad * Vector3d(std::cos(kW_rad_s * t), std::sin(kW_rad_s * t), 0.0));
  };
  EXPECT_LT(drift_rad(1.0, 0.01, coning), 1e-4);
}

TEST(Attitude, FollowsAVehicleThatTurnsAndRollsForAnHour) {
  const auto turning = [](double t) {
    return geo::from_rpy({0.3 * std::sin(0.7 * t), 0.2 * std::cos(0.5 * t), 0.05 * t});
  };
  EXPECT_LT(drift_rad(1.0, 0.01, turning), 1e-4);
}

TEST(Attitude, AtRestForADayStaysWhereItWas) {
  // A day of the Earth's rate, known exactly: a whole turn in inertial space and none in N.
  NavSolution nav;
  nav.position = {0.7, 1.0, 0.0};
  nav.q_NB = geo::from_rpy({0.3, -0.2, 2.0});
  const NavSolution start = nav;
  const geo::LocalEarth earth(nav.position);
  const Eigen::Matrix3d c = geo::to_matrix(nav.q_NB);
  Increments in;
  in.dt_s = kStep_s;
  in.dtheta_rad = in.dtheta_before_rad = kStep_s * (c.transpose() * earth.earth_rate_N);
  in.dv_m_s = in.dv_before_m_s = kStep_s * (c.transpose() * Vector3d(0.0, 0.0, -earth.gravity_m_s2));
  for (int k = 0; k < kDay; ++k) {
    nav = mechanise(nav, correct(in));
    nav.position.altitude_m = 0.0;
    nav.v_N_m_s.z() = 0.0;
  }
  EXPECT_LT(geo::log(geo::conjugate(start.q_NB) * nav.q_NB).norm(), 1e-6);
  EXPECT_LT(geo::difference_N(start.position, nav.position).norm(), 5.0);
}

TEST(Strapdown, FreeInertialAtAltitudeStaysWhereGravityIsFelt) {
  // A balloon that stands over the ground feels what the normal potential says, which leans towards the
  // equator.
  for (const double latitude_rad : {-0.785, 0.785}) {
    NavSolution nav;
    nav.position = {latitude_rad, 0.3, 8000.0};
    const NavSolution start = nav;
    const geo::LocalEarth earth(nav.position);
    Increments in;
    in.dt_s = kStep_s;
    in.dtheta_rad = in.dtheta_before_rad = kStep_s * earth.earth_rate_N;
    in.dv_m_s = in.dv_before_m_s = -kStep_s * test::NormalPotential::gravity_N(latitude_rad, 8000.0);
    for (int k = 0; k < 20 * 60 * 10; ++k) {
      nav = mechanise(nav, correct(in));
      nav.position.altitude_m = 8000.0;
      nav.v_N_m_s.z() = 0.0;
    }
    EXPECT_LT(geo::difference_N(start.position, nav.position).norm(), 1.0) << latitude_rad;
  }
}

}  // namespace
}  // namespace fathom::estimation
