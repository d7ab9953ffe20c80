#pragma once

#include <Eigen/Core>

namespace fathom::sim {

/// Errors of one axis of a triad of gyros or accelerometers and the two angles by which it is tilted towards
/// the axes that follow it (x: y, z; y: z, x; z: x, y).
struct AxisError {
  double bias = 0.0;
  double scale = 0.0;
  double gamma_1_rad = 0.0;  ///< rotation about the next axis
  double gamma_2_rad = 0.0;  ///< rotation about the one after it
};

/// What an axis reads (SENS-1): `bias + (1 + scale)(x + gamma_2 y - gamma_1 z) + noise`.
[[nodiscard]] inline double axis_output(const Eigen::Vector3d& truth, int axis, const AxisError& error,
                                        double noise) {
  const double next = truth((axis + 1) % 3);
  const double after = truth((axis + 2) % 3);
  return error.bias +
         (1.0 + error.scale) * (truth(axis) + error.gamma_2_rad * next - error.gamma_1_rad * after) + noise;
}

/// What a propulsor says about the speed (SENS-2): its rate times a factor known but for `factor_error`.
[[nodiscard]] inline double propulsor_speed(double rpm, double factor_m_s, double factor_error_m_s,
                                            double noise_m_s) {
  return (factor_m_s + factor_error_m_s) * rpm + noise_m_s;
}

}  // namespace fathom::sim
