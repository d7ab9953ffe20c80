#include "estimation/filter/strapdown.hpp"

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

NavSolution mechanise(const NavSolution& start, const CorrectedIncrements& increments) {
  return mechanise(start, geo::LocalEarth(start.position), geo::to_matrix(start.q_NB), increments);
}

NavSolution mechanise(const NavSolution& start, const geo::LocalEarth& earth, const Eigen::Matrix3d& C_NB,
                      const CorrectedIncrements& in) {
  // (STRAP-2)
  const double dt = in.dt_s;
  const geo::Geodetic& p = start.position;
  const Vector3d rate_en = earth.transport_rate_N(start.v_N_m_s);
  const Vector3d rate_in = earth.earth_rate_N + rate_en;

  const Vector3d dv_start_N = C_NB * in.dv_m_s;
  const Vector3d dv_N = dv_start_N - 0.5 * dt * cross(rate_in, dv_start_N);
  const Vector3d gravity_N = earth.gravity_N();
  const Vector3d turning = earth.earth_rate_N + rate_in;
  const Vector3d v_middle = start.v_N_m_s + 0.5 * (dv_N + dt * (gravity_N - cross(turning, start.v_N_m_s)));

  NavSolution end;
  end.v_N_m_s = start.v_N_m_s + dv_N + dt * (gravity_N - cross(turning, v_middle));
  const Vector3d v_mean = 0.5 * (start.v_N_m_s + end.v_N_m_s);
  end.position.altitude_m = p.altitude_m - dt * v_mean.z();
  const double climb = 0.5 * (end.position.altitude_m - p.altitude_m);
  end.position.latitude_rad = p.latitude_rad + dt * v_mean.x() / (earth.meridian_m + climb);
  // The sine and cosine halfway by their series; half a step is less than a thousandth of a radian.
  const double half = 0.5 * (end.position.latitude_rad - p.latitude_rad);
  const double sine = earth.sine + half * (earth.cosine - 0.5 * half * earth.sine);
  const double cosine = earth.cosine - half * (earth.sine + 0.5 * half * earth.cosine);
  const double normal = geo::normal_radius_m(sine) + p.altitude_m + climb;
  end.position.longitude_rad = geo::wrap_pi(p.longitude_rad + dt * v_mean.y() / (normal * cosine));
  end.q_NB = geo::normalized(geo::exp(-dt * rate_in) * start.q_NB * geo::exp(in.rotation_rad));
  return end;
}

}  // namespace fathom::estimation
