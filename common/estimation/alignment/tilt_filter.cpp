#include "estimation/alignment/tilt_filter.hpp"

namespace fathom::estimation {

using Eigen::Matrix3d;
using Eigen::Vector3d;

void TiltFilter::start(const geo::Quaternion& q_NB, const Vector3d& v_N_m_s, double depth_m,
                       const Matrix& covariance) {
  q_NB_ = q_NB;
  v_N_ = v_N_m_s;
  depth_m_ = depth_m;
  bias_.setZero();
  p_ = covariance;
}

void TiltFilter::predict(double dt_s, const Vector3d& rate, const Vector3d& force, const Vector3d& g_N,
                         const Vector& noise, const Vector& keep) {
  // (TILT-2)
  const Matrix3d c_middle = geo::to_matrix(q_NB_ * geo::exp(0.5 * dt_s * rate));
  q_NB_ = geo::normalized(q_NB_ * geo::exp(dt_s * rate));
  v_N_ += dt_s * (c_middle * (force - bias_.segment<3>(kAccel)) + g_N);
  depth_m_ += dt_s * v_N_.z();

  Matrix phi = Matrix::Identity();
  phi.block<3, 3>(kVelocity, kPhi) = dt_s * geo::skew(g_N);
  phi.block<3, 3>(kVelocity, kAccel) = -dt_s * c_middle;
  phi.block<1, 3>(kDepth, kPhi) = -dt_s * geo::skew(v_N_).row(2);
  phi(kDepth, kVelocity + 2) = dt_s;
  for (int i = kAccel; i < kSize; ++i) {
    phi(i, i) = keep(i);
    bias_(i) *= keep(i);
  }
  Matrix moved;
  moved.noalias() = phi * p_;
  p_.noalias() = moved * phi.transpose();
  p_ = (0.5 * (p_ + p_.transpose())).eval();
  p_.diagonal() += noise;
}

TiltFilter::Row TiltFilter::speed_row(double speed_m_s, double sigma_m_s) const {
  // (TILT-3)
  const Matrix3d c_BN = geo::to_matrix(q_NB_).transpose();
  const double along = c_BN.row(0).dot(v_N_);
  const double gain = 1.0 + bias_(kScale);
  Row row;
  row.h.segment<3>(kVelocity) = gain * c_BN.row(0).transpose();
  row.h(kScale) = along;
  row.h(kLogBias) = 1.0;
  row.innovation = speed_m_s - gain * along - bias_(kLogBias);
  row.variance = sigma_m_s * sigma_m_s;
  return row;
}

TiltFilter::Row TiltFilter::side_row(double side_m_s, double sigma_m_s) const {
  const Matrix3d c_BN = geo::to_matrix(q_NB_).transpose();
  Row row;
  row.h.segment<3>(kVelocity) = c_BN.row(1).transpose();
  row.h(kSideBias) = -1.0;
  row.innovation = side_m_s - (c_BN.row(1).dot(v_N_) - bias_(kSideBias));
  row.variance = sigma_m_s * sigma_m_s;
  return row;
}

TiltFilter::Row TiltFilter::heave_row(double heave_m_s, double sigma_m_s) const {
  const Matrix3d c_BN = geo::to_matrix(q_NB_).transpose();
  Row row;
  row.h.segment<3>(kVelocity) = c_BN.row(2).transpose();
  row.h(kHeaveBias) = -1.0;
  row.innovation = heave_m_s - (c_BN.row(2).dot(v_N_) - bias_(kHeaveBias));
  row.variance = sigma_m_s * sigma_m_s;
  return row;
}

TiltFilter::Row TiltFilter::depth_row(double depth_m, double sigma_m) const {
  Row row;
  row.h(kDepth) = 1.0;
  row.innovation = depth_m - depth_m_;
  row.variance = sigma_m * sigma_m;
  return row;
}

TiltFilter::Result TiltFilter::update(const Row* rows, int count, double limit_sigma) {
  // (TILT-4): the rows are independent, so that one after the other is the same as all at once; the estimated
  // error is collected and applied at the end, because all were linearised at the same estimate.
  Result out;
  for (int i = 0; i < count; ++i) {
    const Row& row = rows[i];
    const Vector ph = p_ * row.h;
    const double s = row.h.dot(ph) + row.variance;
    const double rest = row.innovation - row.h.dot(out.x);
    if (!(rest * rest <= limit_sigma * limit_sigma * s)) {  // false for a reading that is not a number
      ++out.refused;
      continue;
    }
    ++out.taken;
    out.squared_distance += rest * rest / s;
    out.x += ph * (rest / s);
    p_ -= ph * ph.transpose() / s;
  }
  p_ = (0.5 * (p_ + p_.transpose())).eval();
  if (out.taken == 0) return out;
  out.rotation_N_rad = out.x.segment<3>(kPhi);
  const geo::Quaternion turn = geo::exp(out.rotation_N_rad);
  q_NB_ = geo::normalized(turn * q_NB_);
  v_N_ = geo::to_matrix(turn) * (v_N_ + out.x.segment<3>(kVelocity));
  depth_m_ += out.x(kDepth);
  bias_.tail<kSize - kAccel>() += out.x.tail<kSize - kAccel>();
  return out;
}

void TiltFilter::widen(double angle_sigma_rad, double velocity_sigma_m_s, double depth_sigma_m) {
  p_.diagonal().segment<3>(kPhi).array() += angle_sigma_rad * angle_sigma_rad;
  p_.diagonal().segment<3>(kVelocity).array() += velocity_sigma_m_s * velocity_sigma_m_s;
  p_(kDepth, kDepth) += depth_sigma_m * depth_sigma_m;
}

void TiltFilter::turn_heading(double angle_rad) {
  const geo::Quaternion turn = geo::exp({0.0, 0.0, angle_rad});
  const Matrix3d c = geo::to_matrix(turn);
  q_NB_ = geo::normalized(turn * q_NB_);
  v_N_ = c * v_N_;
  for (const int at : {static_cast<int>(kPhi), static_cast<int>(kVelocity)}) {
    p_.middleRows<3>(at) = (c * p_.middleRows<3>(at)).eval();
    p_.middleCols<3>(at) = (p_.middleCols<3>(at) * c.transpose()).eval();
  }
}

}  // namespace fathom::estimation
