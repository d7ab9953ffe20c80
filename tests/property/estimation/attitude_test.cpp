#include <gtest/gtest.h>

#include "estimation/strapdown.hpp"
#include "geo/so3.hpp"

namespace fathom::estimation {
namespace {

using Eigen::Vector3d;

constexpr double kStep_s = 0.1;
constexpr int kDay = 24 * 3600 * 10;  ///< steps

double length(const geo::Quaternion& q) {
  return std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
}

TEST(Attitude, KeepsItsLengthForADayOfTurning) {
  NavSolution nav;
  nav.position = {0.9, 0.1, 0.0};
  nav.q_NB = geo::from_rpy({0.1, 0.2, 0.3});
  Increments in;
  in.dt_s = kStep_s;
  for (int k = 0; k < kDay; ++k) {
    const double t = k * kStep_s;
    in.dtheta_before_rad = in.dtheta_rad;
    in.dv_before_m_s = in.dv_m_s;
    in.dtheta_rad = Vector3d(0.02 * std::sin(1.3 * t), 0.03 * std::cos(0.7 * t), 0.01);
    in.dv_m_s = geo::to_matrix(nav.q_NB).transpose() *
                Vector3d(0.02 * std::cos(0.01 * t), 0.02 * std::sin(0.01 * t), -0.98);
    nav = mechanise(nav, correct(in));
    // The vertical channel of an inertial navigator is unstable by nature; something always holds it.
    nav.position.altitude_m = 0.0;
    nav.v_N_m_s.z() = 0.0;
    ASSERT_NEAR(length(nav.q_NB), 1.0, 4e-16 * 2) << k;
  }
  const Eigen::Matrix3d c = geo::to_matrix(nav.q_NB);
  EXPECT_LT((c * c.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff(), 1e-14);
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

}  // namespace
}  // namespace fathom::estimation
