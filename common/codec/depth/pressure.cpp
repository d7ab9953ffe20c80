#include "codec/depth/pressure.hpp"

#include <cmath>

namespace fathom::codec {
namespace {

constexpr double kPascalPerDecibar = 1e4;

}  // namespace

double depth_from_pressure(double gauge_Pa, double latitude_rad) {
  const double p_dbar = gauge_Pa / kPascalPerDecibar;
  const double sine = std::sin(latitude_rad);
  const double x = sine * sine;
  const double gravity_m_s2 = 9.780318 * (1.0 + (5.2788e-3 + 2.36e-5 * x) * x) + 1.092e-6 * p_dbar;
  return (((-1.82e-15 * p_dbar + 2.279e-10) * p_dbar - 2.2512e-5) * p_dbar + 9.72659) * p_dbar / gravity_m_s2;
}

double pressure_from_depth(double depth_m, double latitude_rad) {
  // Nearly linear: the fixed-point iteration gains four digits a step.
  constexpr double kPascalPerMetre = 1.0e4;
  double pressure_Pa = depth_m * kPascalPerMetre;
  for (int step = 0; step < 12; ++step) {
    pressure_Pa += (depth_m - depth_from_pressure(pressure_Pa, latitude_rad)) * kPascalPerMetre;
  }
  return pressure_Pa;
}

}  // namespace fathom::codec
