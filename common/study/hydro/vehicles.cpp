#include "study/hydro/vehicles.hpp"

namespace fathom::study::hydro {

using estimation::hydro::coefficient_table;
using estimation::hydro::CoefficientKind;

HydroCoefficients remus100() {
  HydroCoefficients c;
  c.weight = 299.0;
  c.buoyancy = 306.0;
  c.I_xx = 0.177;
  c.I_yy = c.I_zz = 3.45;
  c.z_G = 0.0196;
  c.X_uu = -1.62;
  c.X_udot = -0.93;
  c.X_wq = -35.5;
  c.X_qq = -1.93;
  c.X_vr = 35.5;
  c.X_rr = -1.93;
  c.X_prop = 3.86;
  c.Y_vv = -131.0;
  c.Y_rr = 0.632;
  c.Y_uv = -28.6;
  c.Y_vdot = -35.5;
  c.Y_rdot = 1.93;
  c.Y_ur = 5.22;
  c.Y_wp = 35.5;
  c.Y_pq = 1.93;
  c.Y_uudr = 9.64;
  c.Z_ww = -131.0;
  c.Z_qq = -0.632;
  c.Z_uw = -28.6;
  c.Z_wdot = -35.5;
  c.Z_qdot = -1.93;
  c.Z_uq = -5.22;
  c.Z_vp = -35.5;
  c.Z_rp = 1.93;
  c.Z_uuds = -9.64;
  c.K_pp = -0.13;
  c.K_pdot = -0.0704;
  c.K_prop = -0.543;
  c.M_ww = 3.18;
  c.M_qq = -188.0;
  c.M_uw = 24.0;
  c.M_wdot = -1.93;
  c.M_qdot = -4.88;
  c.M_uq = -2.0;
  c.M_vp = -1.93;
  c.M_rp = 4.86;
  c.M_uuds = -6.15;
  c.N_vv = -3.18;
  c.N_rr = -94.0;
  c.N_uv = -24.0;
  c.N_vdot = 1.93;
  c.N_rdot = -4.88;
  c.N_ur = -2.0;
  c.N_wp = -1.93;
  c.N_pq = -4.86;
  c.N_uudr = -6.15;
  c.propulsor_rpm = 1500.0;
  return c;
}

HydroCoefficients air_dropped() {
  HydroCoefficients c;
  c.weight = 2354.4;
  c.buoyancy = 2011.05;
  c.I_xx = 3.2;
  c.I_yy = c.I_zz = 115.0;
  c.z_G = 0.01;
  c.X_uu = -4.645;
  c.X_udot = -6.0;
  c.X_wq = -200.0;
  c.X_vr = 200.0;
  c.X_prop = 1342.4;
  c.Y_vv = c.Z_ww = -465.0;
  c.Y_uv = c.Z_uw = -140.6;
  c.Y_vdot = c.Z_wdot = -200.0;
  c.Y_ur = 113.2;
  c.Z_uq = -113.2;
  c.Y_uudr = 67.6;
  c.Z_uuds = -67.6;
  c.K_pp = -1.0;
  c.M_qq = c.N_rr = -319.0;
  c.M_uw = 12.8;
  c.N_uv = -12.8;
  c.M_qdot = c.N_rdot = -90.0;
  c.M_uq = c.N_ur = -130.2;
  c.M_uuds = c.N_uudr = -77.7;
  c.propulsor_rpm = 2500.0;
  return c;
}

HydroCoefficients perturbed(const HydroCoefficients& nominal, double share, sim::Random& random) {
  while (true) {
    HydroCoefficients out = nominal;
    for (const auto& one : coefficient_table())
      if (one.kind != CoefficientKind::body) out.*one.member *= random.uniform(1.0 - share, 1.0 + share);
    if (out.validate().empty()) return out;
  }
}

}  // namespace fathom::study::hydro
