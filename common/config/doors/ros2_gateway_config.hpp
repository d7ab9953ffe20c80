#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "base/name.hpp"
#include "base/unknown.hpp"
#include "config/common_config.hpp"
#include "config/registry.hpp"

namespace fathom::config {

enum class RosDistro : std::uint8_t { humble = 0, jazzy = 1, kilted = 2 };
enum class RosConvention : std::uint8_t { enu_flu = 0, ned_frd = 1 };
enum class RosQuality : std::uint8_t { reliable = 0, sensor_data = 1 };
enum class RosAxes : std::uint8_t { standard = 0, flu = 1, frd = 2 };
enum class RosStamp : std::uint8_t { message = 0, arrival = 1 };
enum class RosTransforms : std::uint8_t { both = 0, map_to_odom = 1, odom_to_base_link = 2, none = 3 };

/// Section "ros": the graph of ROS 2 that the gateway is a node of.
struct RosGraphConfig {
  RosDistro distro = RosDistro::jazzy;
  int domain = 0;  ///< ROS_DOMAIN_ID
  std::vector<std::string> interfaces{"127.0.0.1"};
  std::vector<std::string> peers{"127.0.0.1"};
  std::string name_space = "/fathom";
  std::string node = "fathom_gateway";
};

/// A frame that stands still in another one.
struct RosStaticFrame {
  std::string parent;
  std::string child;
  std::array<double, 3> position_m{0.0, 0.0, 0.0};  ///< in the axes of the parent
  std::array<double, 3> rpy_rad{0.0, 0.0, 0.0};
};

/// Section "frames".
struct RosFramesConfig {
  RosConvention convention = RosConvention::enu_flu;
  std::string map = "map";
  std::string odom = "odom";
  std::string base_link = "base_link";
  RosTransforms transforms = RosTransforms::both;
  double origin_latitude_rad = kUnknown;  ///< of map; unknown: where the vehicle is first
  double origin_longitude_rad = kUnknown;
  double origin_altitude_m = kUnknown;
  std::vector<RosStaticFrame> fixed;
};

struct RosOutputConfig {
  std::string topic;     ///< relative to the namespace, or from "/" on; empty: not published
  double rate_hz = 0.0;  ///< at most; 0: with every navigation state
  RosQuality quality = RosQuality::reliable;
};

/// Section "outputs".
struct RosOutputsConfig {
  RosOutputConfig odometry{"odometry", 50.0, RosQuality::reliable};
  RosOutputConfig imu{"imu", 0.0, RosQuality::reliable};
  RosOutputConfig fix{"fix", 10.0, RosQuality::reliable};
  RosOutputConfig velocity{"velocity", 50.0, RosQuality::reliable};
  RosOutputConfig pose{"pose", 10.0, RosQuality::reliable};
  RosOutputConfig geo_pose{"geopose", 10.0, RosQuality::reliable};
  RosOutputConfig tf{"/tf", 50.0, RosQuality::reliable};
  RosOutputConfig diagnostics{"/diagnostics", 1.0, RosQuality::reliable};
  double angular_rate_sigma_rad_s = 0.002;
  double specific_force_sigma_m_s2 = 0.05;
};

/// What a message is and becomes.
enum class RosInputKind : std::uint8_t {
  imu = 0,             ///< sensor_msgs/Imu -> imu
  nav_sat_fix = 1,     ///< sensor_msgs/NavSatFix -> gps
  fluid_pressure = 2,  ///< sensor_msgs/FluidPressure -> depth
  dvl = 3,             ///< marine_acoustic_msgs/Dvl -> dvl
  twist = 4,           ///< geometry_msgs/TwistWithCovarianceStamped -> dvl
  pose = 5,            ///< geometry_msgs/PoseWithCovarianceStamped in map -> fix
};

/// One topic that is an instrument of the vehicle.
struct RosInputConfig {
  RosInputKind kind = RosInputKind::imu;
  std::string topic;
  Name sensor;
  std::string frame_id;  ///< that messages have to name; empty: any
  RosQuality quality = RosQuality::sensor_data;
  RosAxes axes = RosAxes::standard;
  RosStamp stamp = RosStamp::message;
  double oldest_s = 10.0;
  double ahead_s = 0.5;
  double rate_hz = 0.0;        ///< expected; silent for five periods, at least 2 s, it is missed; 0: never
  bool through_water = false;  ///< twist
  double latitude_rad = 0.0;   ///< fluid_pressure
  double atmosphere_Pa = 101'325;  ///< fluid_pressure; 0: of gauge pressure
  double max_angular_rate_rad_s = 35.0;
  double max_specific_force_m_s2 = 400.0;
  double max_speed_m_s = 20.0;
  double max_depth_m = 11'000.0;
};

/// Section "orders".
struct RosOrdersConfig {
  std::string topic;  ///< std_msgs/String; empty: no orders are taken
};

/// deploy/config/ros2_gateway.json
struct Ros2GatewayConfig {
  CommonConfig common;
  RosGraphConfig ros;
  RosFramesConfig frames;
  RosOutputsConfig outputs;
  std::vector<RosInputConfig> inputs;
  RosOrdersConfig orders;
};

/// The full name of a topic: "odometry" in "/fathom" is "/fathom/odometry".
[[nodiscard]] std::string ros_topic(const std::string& name_space, const std::string& topic);

/// Where is said what became of the orders of a topic.
[[nodiscard]] std::string ros_answer_topic(const std::string& topic);

[[nodiscard]] ConfigKind ros2_gateway_kind();

}  // namespace fathom::config
