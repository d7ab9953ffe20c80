#pragma once

#include "base/units.hpp"
#include "sim/scenario.hpp"

namespace fathom::test {

inline sim::Scenario base_scenario(sim::VehicleConfig::Kind kind) {
  sim::Scenario out;
  out.name = "test";
  out.vehicle.kind = kind;
  out.start.latitude_rad = 45.0 * kRadPerDeg;
  out.start.longitude_rad = 7.0 * kRadPerDeg;
  out.environment.surface_altitude_m = 20.0;
  out.sensors.of<ImuSample>().enabled = true;
  out.sensors.of<ImuSample>().rate_hz = 100.0;
  return out;
}

/// Rest on a moving surface, a dive with a turn in a current, surfacing.
inline sim::Scenario auv_scenario() {
  sim::Scenario out = base_scenario(sim::VehicleConfig::Kind::auv);
  out.start.depth_m = 0.14;
  out.start.rpy_rad = {0.0, 0.0, 1.0};
  out.environment.current_N_m_s = {0.2, -0.3};
  out.environment.current_from_s = 10.0;
  out.environment.wave_height_m = 0.02;
  out.environment.wave_tilt_rad = 0.4 * kRadPerDeg;
  out.environment.turbulence_m_s = 0.02;
  out.environment.water_depth_m = 40.0;
  out.mission = {{0.0, 0.0, 1.0, 0.0},
                 {15.0, 2.0, 1.0, 0.0},
                 {40.0, kUnknown, 2.5, 6.0},
                 {90.0, kUnknown, kUnknown, 0.0}};
  return out;
}

inline sim::Scenario arm_scenario() {
  sim::Scenario out = base_scenario(sim::VehicleConfig::Kind::rotating_arm);
  out.start.depth_m = 1.0;
  out.mission = {{0.0, 0.0}, {10.0, 3.0}};
  return out;
}

inline sim::Scenario aircraft_scenario() {
  sim::Scenario out = base_scenario(sim::VehicleConfig::Kind::aircraft);
  out.start.depth_m = -800.0;
  out.start.speed_m_s = 50.0;
  out.start.rpy_rad = {0.0, 0.05, 1.0};
  out.environment.wind_N_m_s = {4.0, -3.0};
  out.environment.turbulence_m_s = 0.4;
  out.mission = {{0.0, 50.0, 1.0, -800.0, 0.0, 0.0},
                 {20.0, 50.0, 1.0, -900.0, 0.0, 0.0},
                 {60.0, 50.0, 1.0, -900.0, 45.0 * kRadPerDeg, 0.0},
                 {90.0, 50.0, 1.0, -900.0, 0.0, 8.0 * kRadPerDeg}};
  return out;
}

inline sim::Scenario air_drop_scenario() {
  sim::Scenario out = base_scenario(sim::VehicleConfig::Kind::air_drop);
  out.start.depth_m = -380.0;
  out.start.speed_m_s = 61.7;
  out.start.rpy_rad = {0.04, -0.05, 0.8};
  out.environment.turbulence_m_s = 0.03;
  out.mission = {{0.0, 17.0, 0.8, 80.0}};
  return out;
}

}  // namespace fathom::test
