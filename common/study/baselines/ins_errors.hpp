#pragma once

#include <Eigen/Core>

#include "geo/wgs84.hpp"

namespace fathom::study::hydro {

/// How the errors (estimate - truth) of an inertial navigator on a sphere grow: of latitude, longitude (rad)
/// and altitude (m) `rho`, of the velocity v (m/s, N) and of the attitude phi (rad, N):
///   rho' = P_rho rho + P_v v,  v' = V_rho rho + V_v v + V_phi phi,  phi' = W_rho rho + W_v v + W_phi phi
/// (HYD-INS-1). Instrument errors enter beside them: +C b_a on v', -C b_g on phi'.
struct InsErrorMatrices {
  Eigen::Matrix3d P_rho, P_v, V_rho, V_v, V_phi, W_rho, W_v, W_phi;
};

struct Sphere {
  double radius_m = 6371000.0;
  double rate_rad_s = geo::kEarthRate_rad_s;
};

/// Precondition: not at a pole.
[[nodiscard]] InsErrorMatrices ins_error_matrices(double latitude_rad, double altitude_m,
                                                  const Eigen::Vector3d& v_N_m_s,
                                                  const Eigen::Vector3d& f_N_m_s2, const Sphere& sphere = {});

}  // namespace fathom::study::hydro
