#pragma once

#include "estimation/hydro/coefficients.hpp"

namespace fathom::test {

/// A slender vehicle of round numbers, with every cross term in use.
inline estimation::hydro::HydroCoefficients small_vehicle() {
  estimation::hydro::HydroCoefficients c;
  c.weight = 490.5;
  c.buoyancy = 495.0;
  c.I_xx = 0.5;
  c.I_yy = c.I_zz = 8.0;
  c.x_G = 0.02;
  c.y_G = 0.01;
  c.z_G = 0.03;
  c.X_uu = -3.0;
  c.X_udot = -1.5;
  c.X_prop = 12.0;
  c.Y_vv = c.Z_ww = -200.0;
  c.Y_vdot = c.Z_wdot = -50.0;
  c.Y_rdot = c.N_vdot = 2.0;
  c.Z_qdot = c.M_wdot = -2.0;
  c.Y_pdot = c.K_vdot = 0.3;
  c.K_rdot = c.N_pdot = 0.05;
  c.Y_uv = c.Z_uw = -40.0;
  c.K_pp = -0.2;
  c.K_pdot = -0.1;
  c.M_qq = c.N_rr = -150.0;
  c.M_qdot = c.N_rdot = -6.0;
  c.propulsor_rpm = 1200.0;
  return c;
}

}  // namespace fathom::test
