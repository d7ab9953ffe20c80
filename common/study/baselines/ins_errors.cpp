#include "study/baselines/ins_errors.hpp"

#include <cmath>

#include "geo/so3.hpp"

namespace fathom::study::hydro {

using Eigen::Matrix3d;
using Eigen::Vector3d;

InsErrorMatrices ins_error_matrices(double latitude_rad, double altitude_m, const Vector3d& v_N_m_s,
                                    const Vector3d& f_N_m_s2, const Sphere& sphere) {
  // (HYD-INS-1)
  const double r = sphere.radius_m + altitude_m;
  const double sine = std::sin(latitude_rad);
  const double cosine = std::cos(latitude_rad);
  const double tangent = sine / cosine;
  const double vn = v_N_m_s.x();
  const double ve = v_N_m_s.y();
  const Vector3d rate_ie(sphere.rate_rad_s * cosine, 0.0, -sphere.rate_rad_s * sine);
  const Vector3d rate_en(ve / r, -vn / r, -ve * tangent / r);
  Matrix3d earth = Matrix3d::Zero();  // of rate_ie, by position
  earth.col(0) << -sphere.rate_rad_s * sine, 0.0, -sphere.rate_rad_s * cosine;
  Matrix3d transport = Matrix3d::Zero();  // of rate_en, by position
  transport.col(0) << 0.0, 0.0, -ve / (r * cosine * cosine);
  transport.col(2) << -ve / (r * r), vn / (r * r), ve * tangent / (r * r);
  const Matrix3d v_cross = geo::skew(v_N_m_s);

  InsErrorMatrices out;
  out.P_rho << 0.0, 0.0, -vn / (r * r),                          //
      ve * tangent / (r * cosine), 0.0, -ve / (r * r * cosine),  //
      0.0, 0.0, 0.0;
  out.P_v = Vector3d(1.0 / r, 1.0 / (r * cosine), -1.0).asDiagonal();
  out.W_v << 0.0, 1.0 / r, 0.0, -1.0 / r, 0.0, 0.0, 0.0, -tangent / r, 0.0;
  out.W_rho = earth + transport;
  out.W_phi = -geo::skew(rate_ie + rate_en);
  out.V_rho = v_cross * (2.0 * earth + transport);
  out.V_v = v_cross * out.W_v - geo::skew(2.0 * rate_ie + rate_en);
  out.V_phi = geo::skew(f_N_m_s2);
  return out;
}

}  // namespace fathom::study::hydro
