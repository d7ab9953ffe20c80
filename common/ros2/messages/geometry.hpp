#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

/// Messages of ROS 2 as plain values. Each names its interface (`kType`) and shows its fields with their
/// names, in the order of idl/ros2: `fields(walk, message)` calls walk(name, field) for each. Tests hold them
/// against the IDL.
namespace fathom::ros2 {

/// Row-major over x, y, z and the rotations about the fixed axes x, y, z.
using Covariance6 = std::array<double, 36>;
/// Row-major over x, y, z.
using Covariance3 = std::array<double, 9>;

/// An octet of IDL: on the wire a uint8, another type to those who compare interfaces.
struct Octet {
  std::uint8_t value = 0;
};

/// Since the Unix epoch; nanosec below 1e9.
struct Time {
  static constexpr const char* kType = "builtin_interfaces/msg/Time";
  std::int32_t sec = 0;
  std::uint32_t nanosec = 0;
  static void fields(auto& walk, auto& m) {
    walk("sec", m.sec);
    walk("nanosec", m.nanosec);
  }
};

struct Header {
  static constexpr const char* kType = "std_msgs/msg/Header";
  Time stamp;
  std::string frame_id;
  static void fields(auto& walk, auto& m) {
    walk("stamp", m.stamp);
    walk("frame_id", m.frame_id);
  }
};

struct String {
  static constexpr const char* kType = "std_msgs/msg/String";
  std::string data;
  static void fields(auto& walk, auto& m) { walk("data", m.data); }
};

struct Vector3 {
  static constexpr const char* kType = "geometry_msgs/msg/Vector3";
  double x = 0.0;
  double y = 0.0;
  double z = 0.0;
  static void fields(auto& walk, auto& m) {
    walk("x", m.x);
    walk("y", m.y);
    walk("z", m.z);
  }
};

struct Point {
  static constexpr const char* kType = "geometry_msgs/msg/Point";
  double x = 0.0;
  double y = 0.0;
  double z = 0.0;
  static void fields(auto& walk, auto& m) {
    walk("x", m.x);
    walk("y", m.y);
    walk("z", m.z);
  }
};

struct Quaternion {
  static constexpr const char* kType = "geometry_msgs/msg/Quaternion";
  double x = 0.0;
  double y = 0.0;
  double z = 0.0;
  double w = 1.0;
  static void fields(auto& walk, auto& m) {
    walk("x", m.x);
    walk("y", m.y);
    walk("z", m.z);
    walk("w", m.w);
  }
};

struct Pose {
  static constexpr const char* kType = "geometry_msgs/msg/Pose";
  Point position;
  Quaternion orientation;
  static void fields(auto& walk, auto& m) {
    walk("position", m.position);
    walk("orientation", m.orientation);
  }
};

struct PoseWithCovariance {
  static constexpr const char* kType = "geometry_msgs/msg/PoseWithCovariance";
  Pose pose;
  Covariance6 covariance{};
  static void fields(auto& walk, auto& m) {
    walk("pose", m.pose);
    walk("covariance", m.covariance);
  }
};

struct PoseWithCovarianceStamped {
  static constexpr const char* kType = "geometry_msgs/msg/PoseWithCovarianceStamped";
  Header header;
  PoseWithCovariance pose;
  static void fields(auto& walk, auto& m) {
    walk("header", m.header);
    walk("pose", m.pose);
  }
};

struct Twist {
  static constexpr const char* kType = "geometry_msgs/msg/Twist";
  Vector3 linear;
  Vector3 angular;
  static void fields(auto& walk, auto& m) {
    walk("linear", m.linear);
    walk("angular", m.angular);
  }
};

struct TwistWithCovariance {
  static constexpr const char* kType = "geometry_msgs/msg/TwistWithCovariance";
  Twist twist;
  Covariance6 covariance{};
  static void fields(auto& walk, auto& m) {
    walk("twist", m.twist);
    walk("covariance", m.covariance);
  }
};

struct TwistWithCovarianceStamped {
  static constexpr const char* kType = "geometry_msgs/msg/TwistWithCovarianceStamped";
  Header header;
  TwistWithCovariance twist;
  static void fields(auto& walk, auto& m) {
    walk("header", m.header);
    walk("twist", m.twist);
  }
};

struct Transform {
  static constexpr const char* kType = "geometry_msgs/msg/Transform";
  Vector3 translation;
  Quaternion rotation;
  static void fields(auto& walk, auto& m) {
    walk("translation", m.translation);
    walk("rotation", m.rotation);
  }
};

/// The pose of child_frame_id in the frame of the header.
struct TransformStamped {
  static constexpr const char* kType = "geometry_msgs/msg/TransformStamped";
  Header header;
  std::string child_frame_id;
  Transform transform;
  static void fields(auto& walk, auto& m) {
    walk("header", m.header);
    walk("child_frame_id", m.child_frame_id);
    walk("transform", m.transform);
  }
};

struct TFMessage {
  static constexpr const char* kType = "tf2_msgs/msg/TFMessage";
  std::vector<TransformStamped> transforms;
  static void fields(auto& walk, auto& m) { walk("transforms", m.transforms); }
};

/// The pose in the frame of the header, the twist in child_frame_id.
struct Odometry {
  static constexpr const char* kType = "nav_msgs/msg/Odometry";
  Header header;
  std::string child_frame_id;
  PoseWithCovariance pose;
  TwistWithCovariance twist;
  static void fields(auto& walk, auto& m) {
    walk("header", m.header);
    walk("child_frame_id", m.child_frame_id);
    walk("pose", m.pose);
    walk("twist", m.twist);
  }
};

/// Degrees, and m above the WGS-84 ellipsoid.
struct GeoPoint {
  static constexpr const char* kType = "geographic_msgs/msg/GeoPoint";
  double latitude = 0.0;
  double longitude = 0.0;
  double altitude = 0.0;
  static void fields(auto& walk, auto& m) {
    walk("latitude", m.latitude);
    walk("longitude", m.longitude);
    walk("altitude", m.altitude);
  }
};

struct GeoPose {
  static constexpr const char* kType = "geographic_msgs/msg/GeoPose";
  GeoPoint position;
  Quaternion orientation;
  static void fields(auto& walk, auto& m) {
    walk("position", m.position);
    walk("orientation", m.orientation);
  }
};

struct GeoPoseStamped {
  static constexpr const char* kType = "geographic_msgs/msg/GeoPoseStamped";
  Header header;
  GeoPose pose;
  static void fields(auto& walk, auto& m) {
    walk("header", m.header);
    walk("pose", m.pose);
  }
};

}  // namespace fathom::ros2
