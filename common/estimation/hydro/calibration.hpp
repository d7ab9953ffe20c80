#pragma once

#include <string>
#include <vector>

#include "estimation/hydro/vehicle_model.hpp"

namespace fathom::estimation::hydro {

/// One instant of a log as the calibration takes it, about the origin of the coefficients.
struct CalibrationPoint {
  double dt_s = 0.0;                                        ///< since the point before
  Eigen::Vector3d omega_B_rad_s = Eigen::Vector3d::Zero();  ///< of B relative to N
  Eigen::Matrix3d C_NB = Eigen::Matrix3d::Identity();
  Eigen::Vector3d V_ground_B_m_s = Eigen::Vector3d::Zero();  ///< over ground, along B
  Controls controls;
  bool vouched = false;  ///< a DVL stands behind the velocity, and the vehicle is submerged
};

struct CalibrationConfig {
  double share_sigma = 0.3;         ///< prior of each coefficient, relative to its value
  double current_sigma_m_s = 0.5;   ///< prior of the current, each component
  double velocity_sigma_m_s = 0.5;  ///< prior of the velocity through the water at the beginning
  double least_sigma_m_s = 1e-3;    ///< the residuals are never taken for better than this
  double observable_share = 0.5;    ///< a coefficient is observable where its sigma has shrunk to this share
  int iterations = 12;
};

/// What the log says about one coefficient.
struct CalibratedCoefficient {
  const CoefficientEntry* entry = nullptr;
  double before = 0.0;
  double after = 0.0;
  double sigma = 0.0;  ///< in the unit of the coefficient; the prior's where the log says nothing
  bool observable = false;
};

struct Calibration {
  std::string failure;  ///< empty when it came to an end; else what was wrong and what is expected
  HydroCoefficients coefficients;
  std::vector<CalibratedCoefficient> found;  ///< those of the force rows that are not zero
  Eigen::Vector2d current_N_m_s = Eigen::Vector2d::Zero();
  Eigen::Vector2d current_sigma_m_s = Eigen::Vector2d::Zero();
  double compared_s = 0.0;
  Eigen::Vector3d residual_before_m_s = Eigen::Vector3d::Zero();  ///< rms, current and start fitted
  Eigen::Vector3d residual_after_m_s = Eigen::Vector3d::Zero();
};

/// Fits the hydrodynamic coefficients of the three force rows (those that VelocityModel uses), the current
/// and the velocity at the beginning to a log in which a DVL stood behind the velocity (HYD-5). Turning is
/// taken from the log, so moments are not looked at: those coefficients stay. What is weighed ashore stays
/// too. Precondition: start.validate() is empty. Allocates; not for the vehicle.
[[nodiscard]] Calibration calibrate(const HydroCoefficients& start, const std::vector<CalibrationPoint>& log,
                                    const CalibrationConfig& config = {});

}  // namespace fathom::estimation::hydro
