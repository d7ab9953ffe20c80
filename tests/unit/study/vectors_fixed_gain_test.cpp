// The published fixed-gain algorithm against the numerical vectors.
#include <complex>

#include "base/units.hpp"
#include "geo/wgs84.hpp"
#include "study/baselines/fixed_gain.hpp"
#include "support/vectors.hpp"

namespace fathom::study::fixed_gain {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using nlohmann::json;
using test::matrix;
using test::relative_error;
using test::vector3;

constexpr double kTolerance = 1e-9;

/// Of a matrix that has two: the roots of its characteristic polynomial.
std::array<std::complex<double>, 2> poles(const Eigen::Matrix2d& m) {
  const double mean = m.trace() / 2.0;
  const std::complex<double> apart =
      std::sqrt(std::complex<double>(mean * mean - m(0, 0) * m(1, 1) + m(0, 1) * m(1, 0)));
  return {mean + apart, mean - apart};
}

class FixedGainVectors : public test::VectorsTest {};

TEST_F(FixedGainVectors, QuaternionRate) {
  const json& q = in("p003_quat_rate").at("lambda_wxyz");
  const geo::Quaternion lambda{q.at(0).get<double>(), q.at(1).get<double>(), q.at(2).get<double>(),
                               q.at(3).get<double>()};
  const auto phi = quaternion_rate(lambda);
  EXPECT_LT(relative_error(phi, matrix(out("p003_quat_rate").at("Phi"))), kTolerance);
  const Vector3d rate = vector3(in("p003_quat_rate").at("w_body"));
  const Eigen::Vector4d slope = 0.5 * phi * rate;
  for (int i = 0; i < 4; ++i) {
    const double expected =
        out("p003_quat_rate").at("lambda_dot").at(static_cast<std::size_t>(i)).get<double>();
    EXPECT_LT(relative_error(slope(i), expected), kTolerance);
  }
  // The same as half the quaternion product with the rate.
  const geo::Quaternion product = lambda * geo::Quaternion{0.0, rate.x(), rate.y(), rate.z()};
  EXPECT_NEAR(slope(0), 0.5 * product.w, 1e-16);
  EXPECT_NEAR(slope(3), 0.5 * product.z, 1e-16);
}

TEST_F(FixedGainVectors, TangentFrame) {
  const json& j = in("p003_Aphi_wphi");
  const json& e = out("p003_Aphi_wphi");
  const double latitude = j.at("lat_deg").get<double>() * kRadPerDeg;
  EXPECT_LT(relative_error(geo::earth_rate_N(latitude), vector3(e.at("u_phi"))), kTolerance);
  EXPECT_LT(relative_error(inertial_to_tangent(latitude, j.at("t").get<double>()), matrix(e.at("A_phi"))),
            kTolerance);
  EXPECT_LT(relative_error(centripetal(latitude, j.at("R").get<double>()), vector3(e.at("w_phi"))),
            kTolerance);
}

TEST_F(FixedGainVectors, Transition) {
  const json& j = in("p003_transition_9");
  const Matrix9 f = transition(j.at("lat_deg").get<double>() * kRadPerDeg, j.at("dt").get<double>(),
                               vector3(j.at("f_nav")));
  const Eigen::MatrixXd expected = matrix(out("p003_transition_9").at("F"));
  // Small entries next to 1 carry its rounding.
  for (int row = 0; row < 9; ++row)
    for (int column = 0; column < 9; ++column)
      EXPECT_NEAR(f(row, column), expected(row, column), 1e-9 * std::abs(expected(row, column)) + 4e-16)
          << row << ' ' << column;
}

TEST_F(FixedGainVectors, FeedbackPoles) {
  const json& j = in("p003_feedback_poles");
  const json& e = out("p003_feedback_poles");
  const Gains gains{j.at("c_w").get<double>(), j.at("c_r").get<double>(), j.at("c_p").get<double>()};
  const double dt_s = j.at("dt").get<double>();
  for (const std::complex<double> pole : poles(closed_loop_rate(gains))) {
    const json& expected = e.at("continuous").at(pole.imag() > 0.0 ? 0 : 1);
    EXPECT_LT(relative_error(pole.real(), expected.at(0).get<double>()), kTolerance);
    EXPECT_LT(relative_error(pole.imag(), expected.at(1).get<double>()), kTolerance);
    EXPECT_LT(relative_error(std::abs(pole), e.at("wn").get<double>()), kTolerance);
    EXPECT_LT(relative_error(-pole.real() / std::abs(pole), e.at("zeta").get<double>()), kTolerance);
  }
  const auto discrete = poles(closed_loop_step(gains, dt_s));
  for (std::size_t i = 0; i < 2; ++i) {
    const double expected = e.at("discrete_eig_abs").at(i).get<double>();
    EXPECT_LT(relative_error(std::abs(discrete[i]), expected), kTolerance);
  }
  EXPECT_LT(relative_error(attitude_factor(gains, dt_s), e.at("attitude_factor_per_step").get<double>()),
            kTolerance);
}

// The transition is the derivative of the motion it belongs to: a point under a force in the turning frame.
TEST(FixedGain, TransitionFollowsTheMotion) {
  const double latitude = 0.64;
  const double dt_s = 0.05;
  const Vector3d force(1.0, -2.0, -9.5);
  const Matrix9 phi = transition(latitude, dt_s, force);
  const Matrix3d a = inertial_to_tangent(latitude, dt_s);
  // Truth - computed: a remaining turn of the frame leaves -f x turn of the force.
  const auto end = [&](const Vector3d& turn, const Vector3d& r, const Vector3d& p) {
    const Vector3d f = force - geo::cross(force, turn);
    Eigen::Matrix<double, 6, 1> out;
    out << a * (r + dt_s * p + 0.5 * dt_s * dt_s * f), a * (p + dt_s * f);
    return out;
  };
  const Vector3d zero = Vector3d::Zero();
  for (int i = 0; i < 3; ++i) {
    const Vector3d unit = Vector3d::Unit(i);
    const Eigen::Matrix<double, 6, 1> by_turn = end(unit, zero, zero) - end(zero, zero, zero);
    EXPECT_LT((phi.block<6, 1>(3, i) - by_turn).norm(), 1e-12) << i;
    EXPECT_LT((phi.block<6, 1>(3, 3 + i) - (end(zero, unit, zero) - end(zero, zero, zero))).norm(), 1e-12);
    EXPECT_LT((phi.block<6, 1>(3, 6 + i) - (end(zero, zero, unit) - end(zero, zero, zero))).norm(), 1e-12);
  }
}

}  // namespace
}  // namespace fathom::study::fixed_gain
