#include <cmath>
#include <random>
#include <utility>

#include <gtest/gtest.h>

#include "geo/so3.hpp"
#include "geo/wgs84.hpp"
#include "support/normal_potential.hpp"

namespace fathom::geo {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kPi = 3.14159265358979323846;

class Random {
 public:
  double operator()(double low, double high) {
    return low + (high - low) * static_cast<double>(engine_() >> 11) * 0x1p-53;
  }
  Vector3d vector(double size) {
    const double x = (*this)(-size, size);
    const double y = (*this)(-size, size);
    return {x, y, (*this)(-size, size)};
  }

 private:
  std::mt19937_64 engine_{7};
};

/// Earth-centred coordinates: an independent way to measure distances.
Vector3d cartesian(const Geodetic& g) {
  const double n = radii(g.latitude_rad).normal_m;
  const double c = std::cos(g.latitude_rad);
  return {(n + g.altitude_m) * c * std::cos(g.longitude_rad),
          (n + g.altitude_m) * c * std::sin(g.longitude_rad),
          (n * (1.0 - kEccentricitySquared) + g.altitude_m) * std::sin(g.latitude_rad)};
}

TEST(Wgs84, DifferenceIsTheDistanceOnTheEllipsoid) {
  Random random;
  for (int i = 0; i < 200; ++i) {
    const Geodetic a{random(-1.4, 1.4), random(-kPi, kPi), random(-5000.0, 10000.0)};
    const Vector3d step = random.vector(300.0);
    const Geodetic b = moved_by(a, step);
    const double straight = (cartesian(b) - cartesian(a)).norm();
    EXPECT_NEAR(straight, step.norm(), 2e-4 * step.norm() * step.norm() / 1000.0 + 1e-6);
  }
}

TEST(Wgs84, MovingByADifferenceArrives) {
  Random random;
  for (int i = 0; i < 200; ++i) {
    const Geodetic a{random(-1.4, 1.4), random(-kPi, kPi), random(-5000.0, 10000.0)};
    const Vector3d step = random.vector(10'000.0);
    const Vector3d back = difference_N(a, moved_by(a, step));
    EXPECT_LT((back - step).norm(), 1e-5);
  }
}

TEST(Wgs84, DifferenceCrossesTheDateLine) {
  const Geodetic west{0.2, kPi - 1e-6, 0.0};
  const Geodetic east{0.2, -kPi + 1e-6, 0.0};
  EXPECT_NEAR(difference_N(west, east).y(), 2e-6 * radii(0.2).normal_m * std::cos(0.2), 1e-6);
  EXPECT_NEAR(moved_by(west, difference_N(west, east)).longitude_rad, east.longitude_rad, 1e-12);
}

TEST(Wgs84, TransportRateTurnsTheLocalFrame) {
  // The down axis of N, carried along: its rate must be that of the transport rate, by finite differences.
  const Geodetic at{0.7, 0.3, 1000.0};
  const Vector3d v(80.0, -120.0, 0.0);
  const auto frame = [](const Geodetic& g) {
    const double sl = std::sin(g.latitude_rad), cl = std::cos(g.latitude_rad);
    const double so = std::sin(g.longitude_rad), co = std::cos(g.longitude_rad);
    Matrix3d c;  // columns: north, east, down along Earth axes
    c << -sl * co, -so, -cl * co, -sl * so, co, -cl * so, cl, 0.0, -sl;
    return c;
  };
  const double dt = 1.0;
  const Matrix3d before = frame(moved_by(at, -0.5 * dt * v));
  const Matrix3d after = frame(moved_by(at, 0.5 * dt * v));
  const Vector3d turned = log(from_matrix(before.transpose() * after)) / dt;
  EXPECT_LT((turned - transport_rate_N(at, v)).norm(), 1e-9);
}

TEST(Wgs84, AnglesWrap) {
  EXPECT_DOUBLE_EQ(wrap_pi(kPi), kPi);
  EXPECT_DOUBLE_EQ(wrap_pi(-kPi), kPi);
  EXPECT_NEAR(wrap_pi(7.0), 7.0 - 2.0 * kPi, 1e-15);
  EXPECT_NEAR(wrap_two_pi(-0.1), 2.0 * kPi - 0.1, 1e-15);
  EXPECT_GE(wrap_two_pi(-1e-18), 0.0);
  EXPECT_LT(wrap_two_pi(-1e-18), 2.0 * kPi);
}

TEST(So3, LogarithmUndoesExponential) {
  Random random;
  for (int i = 0; i < 500; ++i) {
    const Vector3d r = random.vector(i % 2 == 0 ? 1.7 : 1e-6);
    EXPECT_LT((log(exp(r)) - r).norm(), 1e-13 + 1e-12 * r.norm());
  }
  EXPECT_EQ(log(exp(Vector3d::Zero())).norm(), 0.0);
}

TEST(So3, MatrixAndQuaternionAgree) {
  Random random;
  for (int i = 0; i < 500; ++i) {
    const Quaternion q = exp(random.vector(3.0));
    const Matrix3d c = to_matrix(q);
    EXPECT_LT((c * c.transpose() - Matrix3d::Identity()).norm(), 1e-14);
    EXPECT_LT((to_matrix(from_matrix(c)) - c).norm(), 1e-14);
    const Quaternion p = exp(random.vector(3.0));
    EXPECT_LT((to_matrix(q * p) - c * to_matrix(p)).norm(), 1e-14);
    EXPECT_LT((to_matrix(conjugate(q)) - c.transpose()).norm(), 1e-14);
  }
}

TEST(So3, EulerAnglesGoThereAndBack) {
  Random random;
  for (int i = 0; i < 500; ++i) {
    const Vector3d rpy(random(-3.1, 3.1), random(-1.55, 1.55), random(-3.1, 3.1));
    EXPECT_LT((to_rpy(from_rpy(rpy)) - rpy).norm(), 1e-9);
  }
  // Straight up: roll and yaw are not apart, but the attitude is still the same.
  const Quaternion q = from_rpy({0.4, 0.5 * kPi, 0.1});
  EXPECT_LT((to_matrix(from_rpy(to_rpy(q))) - to_matrix(q)).norm(), 1e-7);
}

TEST(So3, SkewIsTheCrossProduct) {
  Random random;
  const Vector3d a = random.vector(2.0);
  const Vector3d b = random.vector(2.0);
  EXPECT_LT((skew(a) * b - cross(a, b)).norm(), 1e-15);
  EXPECT_NEAR(cross(a, b).dot(a), 0.0, 1e-14);
}

TEST(So3, TheShortestTurnTakesOneDirectionIntoAnother) {
  const Vector3d up(0.0, 0.0, 2.0);
  for (const Vector3d& to : {Vector3d(0.3, -0.4, 0.7), Vector3d(0.0, 0.0, 5.0), Vector3d(1e-9, 0.0, -1.0),
                             Vector3d(0.0, 0.0, -1.0), Vector3d(1.0, 0.0, 0.0)}) {
    for (const auto& [a, b] : {std::pair{up, to}, {to, up}, {Vector3d(-to), to}}) {
      const Quaternion q = turn_between(a, b);
      EXPECT_NEAR(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z, 1.0, 1e-14);
      EXPECT_LT((to_matrix(q) * a.normalized() - b.normalized()).norm(), 1e-8) << a << " " << b;
      const double angle_rad = std::atan2(cross(a, b).norm(), a.dot(b));
      EXPECT_NEAR(log(q).norm(), angle_rad, 2e-8);
    }
  }
}

TEST(Gravity, IsTheGradientOfTheNormalPotentialAtEveryAltitude) {
  for (const double latitude : {-1.2, -0.6, 0.0, 0.3, 0.785, 1.1, 1.5}) {
    for (const double altitude : {0.0, 100.0, 2000.0, 8000.0, 12000.0}) {
      const Eigen::Vector3d expected = test::NormalPotential::gravity_N(latitude, altitude);
      const Eigen::Vector3d own = gravity_N(latitude, altitude);
      EXPECT_NEAR(own.x(), expected.x(), 0.01 * std::abs(expected.x()) + 2e-9) << latitude << " " << altitude;
      EXPECT_EQ(own.y(), 0.0);
      // The second order of altitude leaves a millionth.
      EXPECT_NEAR(own.z(), expected.z(), 2e-6) << latitude << " " << altitude;
      const LocalEarth earth({latitude, 0.5, altitude});
      EXPECT_LT((earth.gravity_N() - own).norm(), 1e-14);
    }
  }
}

}  // namespace
}  // namespace fathom::geo
