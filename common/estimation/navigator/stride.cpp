#include "estimation/navigator/stride.hpp"

#include "base/units.hpp"

namespace fathom::estimation {

using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

/// A vehicle that turns further than this is no longer what it was on the mean.
constexpr double kFurthest_rad = 0.1;
/// Steps that are shorter than nominal by jitter of their stamps fill a stride as well.
constexpr double kFull = 0.99;

}  // namespace

SquaredInputs::SquaredInputs(const Matrix3d& C_NB, const Vector3d& rate_B_rad_s, const Vector3d& force_B_m_s2)
    : rate_B(rate_B_rad_s.cwiseAbs2()),
      // Gravity is always there and looks like a bias; only the changing part of the force counts.
      force_B((force_B_m_s2 + kStandardGravity_m_s2 * C_NB.row(2).transpose()).cwiseAbs2()),
      // What is felt at rest and level is part of the biases.
      felt((force_B_m_s2 + Vector3d(0.0, 0.0, kStandardGravity_m_s2)).squaredNorm()) {}

void Stride::add(double dt_s, const Matrix3d& C_NB, const Vector3d& rate_B_rad_s,
                 const Vector3d& force_B_m_s2) {
  const SquaredInputs squares(C_NB, rate_B_rad_s, force_B_m_s2);
  dt_s_ += dt_s;
  C_NB_s_ += dt_s * C_NB;
  turn_B_rad_ += dt_s * rate_B_rad_s;
  dv_B_m_s_ += dt_s * force_B_m_s2;
  dv_N_m_s_ += dt_s * (C_NB * force_B_m_s2);
  squares_s_.rate_B += dt_s * squares.rate_B;
  squares_s_.force_B += dt_s * squares.force_B;
  squares_s_.felt += dt_s * squares.felt;
}

bool Stride::is_due(double longest_s) const {
  return dt_s_ > kFull * longest_s || turn_B_rad_.squaredNorm() > kFurthest_rad * kFurthest_rad;
}

SquaredInputs Stride::squares() const {
  SquaredInputs out;
  out.rate_B = squares_s_.rate_B / dt_s_;
  out.force_B = squares_s_.force_B / dt_s_;
  out.felt = squares_s_.felt / dt_s_;
  return out;
}

}  // namespace fathom::estimation
