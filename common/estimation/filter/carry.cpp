#include "estimation/filter/carry.hpp"

#include <algorithm>

#include "estimation/filter/error_filter.hpp"
#include "geo/so3.hpp"

namespace fathom::estimation {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kGravity_m_s2 = 9.80665;
/// A slower vehicle tells no heading by its velocity.
constexpr double kSlow_m_s = 0.1;

/// How much of the velocity error hangs on the heading error as it does where the velocity is known along the
/// vehicle: 1 there, 0 where it is known along N.
double share_along_vehicle(const ErrorFilter& filter, const Vector3d& v_N_m_s) {
  const double heading = filter(8, 8);
  const Vector3d swung(v_N_m_s.y(), -v_N_m_s.x(), 0.0);
  if (!(heading > 0.0) || swung.squaredNorm() < kSlow_m_s * kSlow_m_s) return 0.0;
  const Vector3d found = Vector3d(filter(3, 8), filter(4, 8), filter(5, 8)) / heading;
  return std::clamp(found.dot(swung) / swung.squaredNorm(), 0.0, 1.0);
}

}  // namespace

Eigen::Matrix<double, Carry::kStates, Carry::kStates> Carry::matrix() const {
  Eigen::Matrix<double, kStates, kStates> t = Eigen::Matrix<double, kStates, kStates>::Zero();
  t.block<3, 3>(0, 0) = turn;
  t.block<3, 3>(0, 3) = velocity_by_attitude;
  t.block<3, 3>(3, 3) = turn;
  t.block<3, 3>(6, 6) = bias_own;
  return t;
}

Carry carried(const ErrorFilter& filter, const std::array<double, kMaxStates>& x, const Matrix3d& C_NB,
              const Vector3d& before_N_m_s, const Vector3d& after_N_m_s) {
  // (KF-5)
  Carry out;
  out.turn = geo::to_matrix(geo::exp(Vector3d(0.0, 0.0, x[8])));
  out.velocity_by_attitude =
      share_along_vehicle(filter, before_N_m_s) * geo::skew(after_N_m_s - out.turn * before_N_m_s) * out.turn;
  // The tilt that goes with this much bias where nothing accelerates.
  const Vector3d force_N = C_NB * Vector3d(x[9], x[10], x[11]);
  const Vector3d tilt = Vector3d(force_N.y(), -force_N.x(), 0.0) / kGravity_m_s2;
  out.bias_own = geo::to_matrix(geo::exp(-(C_NB.transpose() * tilt)));
  return out;
}

}  // namespace fathom::estimation
