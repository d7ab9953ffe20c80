#pragma once

#include "estimation/hydro/vehicle_model.hpp"
#include "study/baselines/ins_errors.hpp"

namespace fathom::study::hydro {

using estimation::hydro::Controls;
using estimation::hydro::VehicleModel;

/// The thirteen states of the published filter: motion through the water V and omega (body axes), and the
/// errors (estimate - truth) of the navigator it watches: position north, east (m), velocity north, east,
/// attitude.
enum EmbeddedState : int {
  kV = 0,
  kOmega = 3,
  kPosition = 6,
  kVelocity = 8,
  kPhi = 10,
  kEmbeddedStates = 13
};

/// What the inertial navigator says while the filter takes a step.
struct NavigatorView {
  Eigen::Matrix3d C_NB = Eigen::Matrix3d::Identity();
  Eigen::Vector3d f_N_m_s2 = Eigen::Vector3d::Zero();
  Eigen::Vector3d v_N_m_s = Eigen::Vector3d::Zero();
  double latitude_rad = 0.0;
  double altitude_m = 0.0;
};

/// Right-hand side of the published filter's process (HYD-UKF-1): the vehicle with gravity seen through the
/// attitude error, and the navigator's errors on a sphere, position in metres. Any state vector whose first
/// thirteen places are EmbeddedState may use it.
class EmbeddedDynamics {
 public:
  EmbeddedDynamics(const VehicleModel& model, const NavigatorView& navigator, const Controls& controls,
                   const Sphere& sphere = {});

  using State = Eigen::Matrix<double, kEmbeddedStates, 1>;
  [[nodiscard]] State derivative(const State& x) const;

 private:
  const VehicleModel& model_;
  Eigen::Matrix3d C_BN_;
  Controls controls_;
  Eigen::Matrix<double, 7, 7> errors_;  ///< position, velocity, attitude error among each other
};

}  // namespace fathom::study::hydro
