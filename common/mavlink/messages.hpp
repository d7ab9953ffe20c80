#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <tuple>

#include "mavlink/definition.hpp"

/// The messages that we say or read, with the names, the order and the units of the common dialect.
namespace fathom::mavlink {

/// Who is there and how it is.
struct Heartbeat {
  std::uint8_t type = 0;       ///< MAV_TYPE
  std::uint8_t autopilot = 0;  ///< MAV_AUTOPILOT
  std::uint8_t base_mode = 0;
  std::uint32_t custom_mode = 0;
  std::uint8_t system_status = 0;  ///< MAV_STATE
  std::uint8_t mavlink_version = 3;

  static constexpr std::uint32_t kId = 0;
  static constexpr std::string_view kName = "HEARTBEAT";
  static constexpr std::size_t kExtensions = 0;
  static constexpr auto kFields =
      std::tuple(Field("type", &Heartbeat::type), Field("autopilot", &Heartbeat::autopilot),
                 Field("base_mode", &Heartbeat::base_mode), Field("custom_mode", &Heartbeat::custom_mode),
                 Field("system_status", &Heartbeat::system_status),
                 Field("mavlink_version", &Heartbeat::mavlink_version));
};

/// What time it is there.
struct SystemTime {
  std::uint64_t time_unix_usec = 0;
  std::uint32_t time_boot_ms = 0;

  static constexpr std::uint32_t kId = 2;
  static constexpr std::string_view kName = "SYSTEM_TIME";
  static constexpr std::size_t kExtensions = 0;
  static constexpr auto kFields = std::tuple(Field("time_unix_usec", &SystemTime::time_unix_usec),
                                             Field("time_boot_ms", &SystemTime::time_boot_ms));
};

/// What a receiver says.
struct GpsRawInt {
  std::uint64_t time_usec = 0;  ///< since the epoch or since start
  std::uint8_t fix_type = 0;    ///< GPS_FIX_TYPE
  std::int32_t lat = 0;         ///< 1e-7 deg
  std::int32_t lon = 0;         ///< 1e-7 deg
  std::int32_t alt = 0;         ///< mm above mean sea level
  std::uint16_t eph = 0;        ///< hdop * 100; 65535 unknown
  std::uint16_t epv = 0;
  std::uint16_t vel = 0;                ///< cm/s; 65535 unknown
  std::uint16_t cog = 0;                ///< 0.01 deg; 65535 unknown
  std::uint8_t satellites_visible = 0;  ///< 255 unknown
  std::int32_t alt_ellipsoid = 0;       ///< mm
  std::uint32_t h_acc = 0;              ///< mm
  std::uint32_t v_acc = 0;              ///< mm
  std::uint32_t vel_acc = 0;            ///< mm/s
  std::uint32_t hdg_acc = 0;            ///< 1e-5 deg
  std::uint16_t yaw = 0;                ///< 0.01 deg; 0 unknown

  static constexpr std::uint32_t kId = 24;
  static constexpr std::string_view kName = "GPS_RAW_INT";
  static constexpr std::size_t kExtensions = 6;
  static constexpr auto kFields =
      std::tuple(Field("time_usec", &GpsRawInt::time_usec), Field("fix_type", &GpsRawInt::fix_type),
                 Field("lat", &GpsRawInt::lat), Field("lon", &GpsRawInt::lon), Field("alt", &GpsRawInt::alt),
                 Field("eph", &GpsRawInt::eph), Field("epv", &GpsRawInt::epv), Field("vel", &GpsRawInt::vel),
                 Field("cog", &GpsRawInt::cog), Field("satellites_visible", &GpsRawInt::satellites_visible),
                 Field("alt_ellipsoid", &GpsRawInt::alt_ellipsoid), Field("h_acc", &GpsRawInt::h_acc),
                 Field("v_acc", &GpsRawInt::v_acc), Field("vel_acc", &GpsRawInt::vel_acc),
                 Field("hdg_acc", &GpsRawInt::hdg_acc), Field("yaw", &GpsRawInt::yaw));
};

/// An inertial unit, forward-right-down.
struct ScaledImu {
  std::uint32_t time_boot_ms = 0;
  std::int16_t xacc = 0;         ///< mg
  std::int16_t yacc = 0;         ///< mg
  std::int16_t zacc = 0;         ///< mg
  std::int16_t xgyro = 0;        ///< mrad/s
  std::int16_t ygyro = 0;        ///< mrad/s
  std::int16_t zgyro = 0;        ///< mrad/s
  std::int16_t xmag = 0;         ///< mgauss
  std::int16_t ymag = 0;         ///< mgauss
  std::int16_t zmag = 0;         ///< mgauss
  std::int16_t temperature = 0;  ///< 0.01 deg C; 0 unknown

  static constexpr std::uint32_t kId = 26;
  static constexpr std::string_view kName = "SCALED_IMU";
  static constexpr std::size_t kExtensions = 1;
  static constexpr auto kFields = std::tuple(
      Field("time_boot_ms", &ScaledImu::time_boot_ms), Field("xacc", &ScaledImu::xacc),
      Field("yacc", &ScaledImu::yacc), Field("zacc", &ScaledImu::zacc), Field("xgyro", &ScaledImu::xgyro),
      Field("ygyro", &ScaledImu::ygyro), Field("zgyro", &ScaledImu::zgyro), Field("xmag", &ScaledImu::xmag),
      Field("ymag", &ScaledImu::ymag), Field("zmag", &ScaledImu::zmag),
      Field("temperature", &ScaledImu::temperature));
};

/// A barometer; of an underwater vehicle often the second one.
struct ScaledPressure {
  std::uint32_t time_boot_ms = 0;
  float press_abs = 0.0F;        ///< hPa
  float press_diff = 0.0F;       ///< hPa
  std::int16_t temperature = 0;  ///< 0.01 deg C
  std::int16_t temperature_press_diff = 0;

  static constexpr std::uint32_t kId = 29;
  static constexpr std::string_view kName = "SCALED_PRESSURE";
  static constexpr std::size_t kExtensions = 1;
  static constexpr auto kFields = std::tuple(
      Field("time_boot_ms", &ScaledPressure::time_boot_ms), Field("press_abs", &ScaledPressure::press_abs),
      Field("press_diff", &ScaledPressure::press_diff), Field("temperature", &ScaledPressure::temperature),
      Field("temperature_press_diff", &ScaledPressure::temperature_press_diff));
};

/// Roll, pitch and yaw of an autopilot, and their rates.
struct Attitude {
  std::uint32_t time_boot_ms = 0;
  float roll = 0.0F;        ///< rad
  float pitch = 0.0F;       ///< rad
  float yaw = 0.0F;         ///< rad
  float rollspeed = 0.0F;   ///< rad/s
  float pitchspeed = 0.0F;  ///< rad/s
  float yawspeed = 0.0F;    ///< rad/s

  static constexpr std::uint32_t kId = 30;
  static constexpr std::string_view kName = "ATTITUDE";
  static constexpr std::size_t kExtensions = 0;
  static constexpr auto kFields =
      std::tuple(Field("time_boot_ms", &Attitude::time_boot_ms), Field("roll", &Attitude::roll),
                 Field("pitch", &Attitude::pitch), Field("yaw", &Attitude::yaw),
                 Field("rollspeed", &Attitude::rollspeed), Field("pitchspeed", &Attitude::pitchspeed),
                 Field("yawspeed", &Attitude::yawspeed));
};

/// Where local coordinates begin.
struct SetGpsGlobalOrigin {
  std::uint8_t target_system = 0;
  std::int32_t latitude = 0;   ///< 1e-7 deg
  std::int32_t longitude = 0;  ///< 1e-7 deg
  std::int32_t altitude = 0;   ///< mm above mean sea level
  std::uint64_t time_usec = 0;

  static constexpr std::uint32_t kId = 48;
  static constexpr std::string_view kName = "SET_GPS_GLOBAL_ORIGIN";
  static constexpr std::size_t kExtensions = 1;
  static constexpr auto kFields = std::tuple(
      Field("target_system", &SetGpsGlobalOrigin::target_system),
      Field("latitude", &SetGpsGlobalOrigin::latitude), Field("longitude", &SetGpsGlobalOrigin::longitude),
      Field("altitude", &SetGpsGlobalOrigin::altitude), Field("time_usec", &SetGpsGlobalOrigin::time_usec));
};

/// A pose from outside the autopilot.
struct VisionPositionEstimate {
  std::uint64_t usec = 0;
  float x = 0.0F;                      ///< m, north, east, down
  float y = 0.0F;                      ///< m, north, east, down
  float z = 0.0F;                      ///< m, north, east, down
  float roll = 0.0F;                   ///< rad
  float pitch = 0.0F;                  ///< rad
  float yaw = 0.0F;                    ///< rad
  std::array<float, 21> covariance{};  ///< upper triangle of x y z roll pitch yaw; the first NaN: unknown
  std::uint8_t reset_counter = 0;

  static constexpr std::uint32_t kId = 102;
  static constexpr std::string_view kName = "VISION_POSITION_ESTIMATE";
  static constexpr std::size_t kExtensions = 2;
  static constexpr auto kFields = std::tuple(
      Field("usec", &VisionPositionEstimate::usec), Field("x", &VisionPositionEstimate::x),
      Field("y", &VisionPositionEstimate::y), Field("z", &VisionPositionEstimate::z),
      Field("roll", &VisionPositionEstimate::roll), Field("pitch", &VisionPositionEstimate::pitch),
      Field("yaw", &VisionPositionEstimate::yaw), Field("covariance", &VisionPositionEstimate::covariance),
      Field("reset_counter", &VisionPositionEstimate::reset_counter));
};

/// A question about clocks (tc1 = 0) or its answer.
struct Timesync {
  std::int64_t tc1 = 0;  ///< ns
  std::int64_t ts1 = 0;  ///< ns
  std::uint8_t target_system = 0;
  std::uint8_t target_component = 0;

  static constexpr std::uint32_t kId = 111;
  static constexpr std::string_view kName = "TIMESYNC";
  static constexpr std::size_t kExtensions = 2;
  static constexpr auto kFields = std::tuple(Field("tc1", &Timesync::tc1), Field("ts1", &Timesync::ts1),
                                             Field("target_system", &Timesync::target_system),
                                             Field("target_component", &Timesync::target_component));
};

/// A range finder or echo sounder.
struct DistanceSensor {
  std::uint32_t time_boot_ms = 0;
  std::uint16_t min_distance = 0;      ///< cm
  std::uint16_t max_distance = 0;      ///< cm
  std::uint16_t current_distance = 0;  ///< cm
  std::uint8_t type = 0;               ///< MAV_DISTANCE_SENSOR
  std::uint8_t id = 0;
  std::uint8_t orientation = 0;  ///< MAV_SENSOR_ORIENTATION; 25 down
  std::uint8_t covariance = 0;   ///< cm^2; 255 unknown
  float horizontal_fov = 0.0F;
  float vertical_fov = 0.0F;
  std::array<float, 4> quaternion{};
  std::uint8_t signal_quality = 0;  ///< %; 0 unknown

  static constexpr std::uint32_t kId = 132;
  static constexpr std::string_view kName = "DISTANCE_SENSOR";
  static constexpr std::size_t kExtensions = 4;
  static constexpr auto kFields = std::tuple(
      Field("time_boot_ms", &DistanceSensor::time_boot_ms),
      Field("min_distance", &DistanceSensor::min_distance),
      Field("max_distance", &DistanceSensor::max_distance),
      Field("current_distance", &DistanceSensor::current_distance), Field("type", &DistanceSensor::type),
      Field("id", &DistanceSensor::id), Field("orientation", &DistanceSensor::orientation),
      Field("covariance", &DistanceSensor::covariance),
      Field("horizontal_fov", &DistanceSensor::horizontal_fov),
      Field("vertical_fov", &DistanceSensor::vertical_fov), Field("quaternion", &DistanceSensor::quaternion),
      Field("signal_quality", &DistanceSensor::signal_quality));
};

/// The second barometer: of ArduSub that of the water.
struct ScaledPressure2 {
  std::uint32_t time_boot_ms = 0;
  float press_abs = 0.0F;        ///< hPa
  float press_diff = 0.0F;       ///< hPa
  std::int16_t temperature = 0;  ///< 0.01 deg C
  std::int16_t temperature_press_diff = 0;

  static constexpr std::uint32_t kId = 137;
  static constexpr std::string_view kName = "SCALED_PRESSURE2";
  static constexpr std::size_t kExtensions = 1;
  static constexpr auto kFields = std::tuple(
      Field("time_boot_ms", &ScaledPressure2::time_boot_ms), Field("press_abs", &ScaledPressure2::press_abs),
      Field("press_diff", &ScaledPressure2::press_diff), Field("temperature", &ScaledPressure2::temperature),
      Field("temperature_press_diff", &ScaledPressure2::temperature_press_diff));
};

/// A receiver for an autopilot that has none.
struct GpsInput {
  std::uint64_t time_usec = 0;
  std::uint8_t gps_id = 0;
  std::uint16_t ignore_flags = 0;  ///< GPS_INPUT_IGNORE_FLAGS
  std::uint32_t time_week_ms = 0;  ///< GPS time
  std::uint16_t time_week = 0;
  std::uint8_t fix_type = 0;  ///< 3: three-dimensional
  std::int32_t lat = 0;       ///< 1e-7 deg
  std::int32_t lon = 0;       ///< 1e-7 deg
  float alt = 0.0F;           ///< m above mean sea level
  float hdop = 0.0F;
  float vdop = 0.0F;
  float vn = 0.0F;              ///< m/s
  float ve = 0.0F;              ///< m/s
  float vd = 0.0F;              ///< m/s
  float speed_accuracy = 0.0F;  ///< m/s
  float horiz_accuracy = 0.0F;  ///< m
  float vert_accuracy = 0.0F;   ///< m
  std::uint8_t satellites_visible = 0;
  std::uint16_t yaw = 0;  ///< 0.01 deg, 36000 north; 0 unknown

  static constexpr std::uint32_t kId = 232;
  static constexpr std::string_view kName = "GPS_INPUT";
  static constexpr std::size_t kExtensions = 1;
  static constexpr auto kFields = std::tuple(
      Field("time_usec", &GpsInput::time_usec), Field("gps_id", &GpsInput::gps_id),
      Field("ignore_flags", &GpsInput::ignore_flags), Field("time_week_ms", &GpsInput::time_week_ms),
      Field("time_week", &GpsInput::time_week), Field("fix_type", &GpsInput::fix_type),
      Field("lat", &GpsInput::lat), Field("lon", &GpsInput::lon), Field("alt", &GpsInput::alt),
      Field("hdop", &GpsInput::hdop), Field("vdop", &GpsInput::vdop), Field("vn", &GpsInput::vn),
      Field("ve", &GpsInput::ve), Field("vd", &GpsInput::vd),
      Field("speed_accuracy", &GpsInput::speed_accuracy), Field("horiz_accuracy", &GpsInput::horiz_accuracy),
      Field("vert_accuracy", &GpsInput::vert_accuracy),
      Field("satellites_visible", &GpsInput::satellites_visible), Field("yaw", &GpsInput::yaw));
};

/// Pose and twist from outside the autopilot.
struct Odometry {
  std::uint64_t time_usec = 0;
  std::uint8_t frame_id = 0;                ///< MAV_FRAME of the pose
  std::uint8_t child_frame_id = 0;          ///< MAV_FRAME of the twist
  float x = 0.0F;                           ///< m
  float y = 0.0F;                           ///< m
  float z = 0.0F;                           ///< m
  std::array<float, 4> q{};                 ///< w first, child into frame
  float vx = 0.0F;                          ///< m/s
  float vy = 0.0F;                          ///< m/s
  float vz = 0.0F;                          ///< m/s
  float rollspeed = 0.0F;                   ///< rad/s
  float pitchspeed = 0.0F;                  ///< rad/s
  float yawspeed = 0.0F;                    ///< rad/s
  std::array<float, 21> pose_covariance{};  ///< upper triangle; the first NaN: unknown
  std::array<float, 21> velocity_covariance{};
  std::uint8_t reset_counter = 0;
  std::uint8_t estimator_type = 0;  ///< MAV_ESTIMATOR_TYPE
  std::int8_t quality = 0;          ///< %; 0 unknown, -1 failed

  static constexpr std::uint32_t kId = 331;
  static constexpr std::string_view kName = "ODOMETRY";
  static constexpr std::size_t kExtensions = 3;
  static constexpr auto kFields =
      std::tuple(Field("time_usec", &Odometry::time_usec), Field("frame_id", &Odometry::frame_id),
                 Field("child_frame_id", &Odometry::child_frame_id), Field("x", &Odometry::x),
                 Field("y", &Odometry::y), Field("z", &Odometry::z), Field("q", &Odometry::q),
                 Field("vx", &Odometry::vx), Field("vy", &Odometry::vy), Field("vz", &Odometry::vz),
                 Field("rollspeed", &Odometry::rollspeed), Field("pitchspeed", &Odometry::pitchspeed),
                 Field("yawspeed", &Odometry::yawspeed), Field("pose_covariance", &Odometry::pose_covariance),
                 Field("velocity_covariance", &Odometry::velocity_covariance),
                 Field("reset_counter", &Odometry::reset_counter),
                 Field("estimator_type", &Odometry::estimator_type), Field("quality", &Odometry::quality));
};

}  // namespace fathom::mavlink
