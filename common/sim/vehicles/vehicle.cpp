#include "sim/vehicles/vehicle.hpp"

#include <algorithm>

#include "geo/so3.hpp"

namespace fathom::sim {

std::unique_ptr<Vehicle> make_vehicle(const Scenario& scenario, std::uint64_t seed) {
  const auto& vehicle = scenario.vehicle;
  switch (vehicle.kind) {
    case VehicleConfig::Kind::auv:
      return make_auv(vehicle.auv, scenario.environment, seed);
    case VehicleConfig::Kind::air_drop:
      return make_air_drop(vehicle.air_drop, scenario.environment, seed);
    case VehicleConfig::Kind::aircraft:
      return make_aircraft(vehicle.aircraft, scenario.environment, seed);
    case VehicleConfig::Kind::remus:
      return make_remus(vehicle.remus, scenario.environment, seed);
    case VehicleConfig::Kind::rotating_arm:
      break;
  }
  return make_rotating_arm(vehicle.rotating_arm);
}

Eigen::Vector3d rpy_of(const Eigen::Quaterniond& q_NB) {
  return geo::to_rpy({q_NB.w(), q_NB.x(), q_NB.y(), q_NB.z()});
}

Eigen::Quaterniond q_of_rpy(double roll_rad, double pitch_rad, double yaw_rad) {
  const geo::Quaternion q = geo::from_rpy({roll_rad, pitch_rad, yaw_rad});
  return {q.w, q.x, q.y, q.z};
}

double smooth_step(double x) {
  const double c = std::clamp(x, 0.0, 1.0);
  return c * c * (3.0 - 2.0 * c);
}

double smooth_step_slope(double x) {
  const double c = std::clamp(x, 0.0, 1.0);
  return 6.0 * c * (1.0 - c);
}

}  // namespace fathom::sim
