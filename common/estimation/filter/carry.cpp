#include "estimation/filter/carry.hpp"

#include <algorithm>
#include <utility>

#include "base/units.hpp"
#include "base/wide.hpp"
#include "estimation/filter/error_filter.hpp"
#include "geo/so3.hpp"

namespace fathom::estimation {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

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

/// Three rows <- m times them.
FATHOM_WITHIN void turn3(const Eigen::Matrix3d& m, double* rows, int columns) {
  const double m00 = m(0, 0), m01 = m(0, 1), m02 = m(0, 2);
  const double m10 = m(1, 0), m11 = m(1, 1), m12 = m(1, 2);
  const double m20 = m(2, 0), m21 = m(2, 1), m22 = m(2, 2);
#pragma GCC ivdep
  for (int j = 0; j < columns; ++j) {
    const double a = rows[j];
    const double b = rows[j + kRowStride];
    const double c = rows[j + 2 * kRowStride];
    rows[j] = m00 * a + m01 * b + m02 * c;
    rows[j + kRowStride] = m10 * a + m11 * b + m12 * c;
    rows[j + 2 * kRowStride] = m20 * a + m21 * b + m22 * c;
  }
}

/// The same where m turns about the third axis.
FATHOM_WITHIN void turn2(const Eigen::Matrix3d& m, double* rows, int columns) {
  const double m00 = m(0, 0), m01 = m(0, 1);
  const double m10 = m(1, 0), m11 = m(1, 1);
#pragma GCC ivdep
  for (int j = 0; j < columns; ++j) {
    const double a = rows[j];
    const double b = rows[j + kRowStride];
    rows[j] = m00 * a + m01 * b;
    rows[j + kRowStride] = m10 * a + m11 * b;
  }
}

/// The nine rows of a Carry, from the velocity's first one on.
FATHOM_WITHIN void apply_carry(const Carry& carry, double* rows, int columns) {
  double* attitude = rows + 3 * kRowStride;
  turn2(carry.turn, rows, columns);
  if (!carry.velocity_by_attitude.isZero(0.0)) {
    for (int i = 0; i < 3; ++i) {
      double* target = rows + i * kRowStride;
      const double a = carry.velocity_by_attitude(i, 0);
      const double b = carry.velocity_by_attitude(i, 1);
      const double c = carry.velocity_by_attitude(i, 2);
#pragma GCC ivdep
      for (int j = 0; j < columns; ++j)
        target[j] += a * attitude[j] + b * attitude[j + kRowStride] + c * attitude[j + 2 * kRowStride];
    }
  }
  turn2(carry.turn, attitude, columns);
  turn3(carry.bias_own, rows + 6 * kRowStride, columns);
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
  const Vector3d tilt = Vector3d(force_N.y(), -force_N.x(), 0.0) / kStandardGravity_m_s2;
  out.bias_own = geo::to_matrix(geo::exp(-(C_NB.transpose() * tilt)));
  return out;
}

FATHOM_WIDE void ErrorFilter::carry(const Carry& carry) {
  // (KF-5)
  if (tape_ != nullptr) tape_->carried(carry);
  constexpr int kFirst = Carry::kFirst;
  constexpr int kEnd = kFirst + Carry::kStates;
  double* rows = p_.data() + at(kFirst, 0);
  apply_carry(carry, rows, width());
  // The corner is turned over, so that the same map, applied to it once more, makes it T P T'.
  for (int i = kFirst + 1; i < kEnd; ++i)
    for (int j = kFirst; j < i; ++j) std::swap(p_[at(i, j)], p_[at(j, i)]);
  apply_carry(carry, rows + kFirst, Carry::kStates);
  for (int i = kFirst; i < kEnd; ++i) {
    for (int j = 0; j < kFirst; ++j) p_[at(j, i)] = p_[at(i, j)];
    for (int j = kEnd; j < n_; ++j) p_[at(j, i)] = p_[at(i, j)];
    for (int j = kFirst; j < i; ++j) set(i, j, 0.5 * (p_[at(i, j)] + p_[at(j, i)]));
  }
}

}  // namespace fathom::estimation
