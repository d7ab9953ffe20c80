#include "estimation/strapdown.hpp"

#include <cmath>

namespace fathom::estimation {

using Eigen::Vector3d;
using geo::cross;

CorrectedIncrements correct(const Increments& in, double fraction) {
  // (STRAP-1)
  CorrectedIncrements out;
  out.dt_s = fraction * in.dt_s;
  out.rotation_rad = fraction * (in.dtheta_rad + cross(in.dtheta_before_rad, in.dtheta_rad) / 12.0);
  out.dv_m_s =
      fraction * in.dv_m_s + 0.5 * fraction * fraction * cross(in.dtheta_rad, in.dv_m_s) +
      fraction * (cross(in.dtheta_before_rad, in.dv_m_s) + cross(in.dv_before_m_s, in.dtheta_rad)) / 12.0;
  return out;
}

NavSolution mechanise(const NavSolution& start, const CorrectedIncrements& in) {
  // (STRAP-2)
  const double dt = in.dt_s;
  const geo::Geodetic& p = start.position;
  const geo::Radii r = geo::radii(p.latitude_rad);
  const Vector3d rate_ie = geo::earth_rate_N(p.latitude_rad);
  const Vector3d rate_en = geo::transport_rate_N(p, start.v_N_m_s);
  const Vector3d rate_in = rate_ie + rate_en;

  const Vector3d dv_start_N = geo::to_matrix(start.q_NB) * in.dv_m_s;
  const Vector3d dv_N = dv_start_N - 0.5 * dt * cross(rate_in, dv_start_N);
  const Vector3d gravity_N(0.0, 0.0, geo::gravity(p.latitude_rad, p.altitude_m));
  const Vector3d turning = 2.0 * rate_ie + rate_en;
  const Vector3d v_middle = start.v_N_m_s + 0.5 * (dv_N + dt * (gravity_N - cross(turning, start.v_N_m_s)));

  NavSolution end;
  end.v_N_m_s = start.v_N_m_s + dv_N + dt * (gravity_N - cross(turning, v_middle));
  const Vector3d v_mean = 0.5 * (start.v_N_m_s + end.v_N_m_s);
  end.position.altitude_m = p.altitude_m - dt * v_mean.z();
  const double altitude = 0.5 * (p.altitude_m + end.position.altitude_m);
  end.position.latitude_rad = p.latitude_rad + dt * v_mean.x() / (r.meridian_m + altitude);
  const double latitude = 0.5 * (p.latitude_rad + end.position.latitude_rad);
  end.position.longitude_rad = geo::wrap_pi(
      p.longitude_rad + dt * v_mean.y() / ((geo::radii(latitude).normal_m + altitude) * std::cos(latitude)));
  end.q_NB = geo::normalized(geo::exp(-dt * rate_in) * start.q_NB * geo::exp(in.rotation_rad));
  return end;
}

}  // namespace fathom::estimation
