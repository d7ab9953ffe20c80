#pragma once

#include <array>
#include <cstdint>

#include "ros2/messages/geometry.hpp"

namespace fathom::ros2 {

/// REP-145. A covariance whose first element is -1: there is no such measurement; all zeros: not known.
struct Imu {
  static constexpr const char* kType = "sensor_msgs/msg/Imu";
  Header header;
  Quaternion orientation;
  Covariance3 orientation_covariance{};
  Vector3 angular_velocity;  ///< rad/s
  Covariance3 angular_velocity_covariance{};
  Vector3 linear_acceleration;  ///< m/s^2; at rest +g along up
  Covariance3 linear_acceleration_covariance{};
  static void fields(auto& walk, auto& m) {
    walk("header", m.header);
    walk("orientation", m.orientation);
    walk("orientation_covariance", m.orientation_covariance);
    walk("angular_velocity", m.angular_velocity);
    walk("angular_velocity_covariance", m.angular_velocity_covariance);
    walk("linear_acceleration", m.linear_acceleration);
    walk("linear_acceleration_covariance", m.linear_acceleration_covariance);
  }
};

struct NavSatStatus {
  static constexpr const char* kType = "sensor_msgs/msg/NavSatStatus";
  static constexpr std::int8_t kNoFix = -1;
  static constexpr std::int8_t kFix = 0;
  static constexpr std::int8_t kGroundBasedFix = 2;
  static constexpr std::uint16_t kGps = 1;
  std::int8_t status = kNoFix;
  std::uint16_t service = 0;
  static void fields(auto& walk, auto& m) {
    walk("status", m.status);
    walk("service", m.service);
  }
};

struct NavSatFix {
  static constexpr const char* kType = "sensor_msgs/msg/NavSatFix";
  static constexpr std::uint8_t kUnknownCovariance = 0;
  static constexpr std::uint8_t kKnownCovariance = 3;
  Header header;
  NavSatStatus status;
  double latitude = 0.0;              ///< deg
  double longitude = 0.0;             ///< deg
  double altitude = 0.0;              ///< above the WGS-84 ellipsoid, m
  Covariance3 position_covariance{};  ///< east, north, up, m^2
  std::uint8_t position_covariance_type = kUnknownCovariance;
  static void fields(auto& walk, auto& m) {
    walk("header", m.header);
    walk("status", m.status);
    walk("latitude", m.latitude);
    walk("longitude", m.longitude);
    walk("altitude", m.altitude);
    walk("position_covariance", m.position_covariance);
    walk("position_covariance_type", m.position_covariance_type);
  }
};

struct FluidPressure {
  static constexpr const char* kType = "sensor_msgs/msg/FluidPressure";
  Header header;
  double fluid_pressure = 0.0;  ///< absolute, Pa
  double variance = 0.0;        ///< Pa^2; 0: not known
  static void fields(auto& walk, auto& m) {
    walk("header", m.header);
    walk("fluid_pressure", m.fluid_pressure);
    walk("variance", m.variance);
  }
};

/// x forward, z where the instrument points. A covariance of -1: not known.
struct Dvl {
  static constexpr const char* kType = "marine_acoustic_msgs/msg/Dvl";
  static constexpr std::uint8_t kBottom = 1;
  static constexpr std::uint8_t kWater = 2;
  Header header;
  std::uint8_t velocity_mode = 0;
  std::uint8_t dvl_type = 0;
  Vector3 velocity;  ///< m/s
  Covariance3 velocity_covar{};
  double altitude = 0.0;    ///< above the bottom, m
  double course_gnd = 0.0;  ///< rad
  double speed_gnd = 0.0;   ///< m/s
  std::uint8_t num_good_beams = 0;
  float sound_speed = 0.0F;  ///< m/s
  bool beam_ranges_valid = false;
  bool beam_velocities_valid = false;
  std::array<Vector3, 4> beam_unit_vec{};  ///< outward
  std::array<double, 4> range{};           ///< along the beam, m
  std::array<float, 4> range_covar{};
  std::array<float, 4> beam_quality{};
  std::array<float, 4> beam_velocity{};  ///< m/s
  std::array<float, 4> beam_velocity_covar{};
  static void fields(auto& walk, auto& m) {
    walk("header", m.header);
    walk("velocity_mode", m.velocity_mode);
    walk("dvl_type", m.dvl_type);
    walk("velocity", m.velocity);
    walk("velocity_covar", m.velocity_covar);
    walk("altitude", m.altitude);
    walk("course_gnd", m.course_gnd);
    walk("speed_gnd", m.speed_gnd);
    walk("num_good_beams", m.num_good_beams);
    walk("sound_speed", m.sound_speed);
    walk("beam_ranges_valid", m.beam_ranges_valid);
    walk("beam_velocities_valid", m.beam_velocities_valid);
    walk("beam_unit_vec", m.beam_unit_vec);
    walk("range", m.range);
    walk("range_covar", m.range_covar);
    walk("beam_quality", m.beam_quality);
    walk("beam_velocity", m.beam_velocity);
    walk("beam_velocity_covar", m.beam_velocity_covar);
  }
};

}  // namespace fathom::ros2
