#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.hpp"

/// Interfaces of ROS 2 as their IDL describes them.
namespace fathom::ros2 {

/// The numbers that type_description_interfaces gives to types.
enum class Basic : std::uint8_t {
  nested = 1,
  int8 = 2,
  uint8 = 3,
  int16 = 4,
  uint16 = 5,
  int32 = 6,
  uint32 = 7,
  int64 = 8,
  uint64 = 9,
  float32 = 10,
  float64 = 11,
  boolean = 15,
  byte = 16,
  string = 17,
  bounded_string = 21
};
/// Added to the number of an element's type.
enum class Container : std::uint8_t { none = 0, array = 48, bounded_sequence = 96, sequence = 144 };

struct FieldDescription {
  std::string name;
  Basic basic = Basic::nested;
  Container container = Container::none;
  std::uint64_t capacity = 0;         ///< elements of an array; the most of a bounded sequence
  std::uint64_t string_capacity = 0;  ///< of a bounded string
  std::string nested_type;            ///< e.g. "std_msgs/msg/Header"

  bool operator==(const FieldDescription&) const = default;
};

struct TypeDescription {
  std::string name;  ///< e.g. "sensor_msgs/msg/Imu"
  std::vector<FieldDescription> fields;
};

/// By name.
using Interfaces = std::map<std::string, TypeDescription>;

/// Reads the structures of IDL texts: modules PACKAGE, msg, dds_ and structures NAME_, as ROS 2 mangles them.
/// The error names line and expectation: only what ROS 2 makes of messages is understood.
[[nodiscard]] Result<Interfaces> parse_idl(std::string_view text);

/// RIHS01: "RIHS01_" and the SHA-256, hexadecimal, of a type and all it is made of, written as JSON by the
/// rules of rosidl (REP-2016): referenced types sorted by name, constants and defaults left out. The error
/// names a type that is not there.
[[nodiscard]] Result<std::string> type_hash(const Interfaces& interfaces, std::string_view type);

/// ROS 2 by what differs on the wire.
enum class Distro : std::uint8_t {
  humble,  ///< no type hashes, identities of 24 bytes
  jazzy,
  kilted
};

/// A file of ../idl/ros2 as it was when this was built.
struct InterfaceFile {
  std::string_view name;  ///< e.g. "sensor_msgs.idl"
  std::string_view text;
};
[[nodiscard]] std::span<const InterfaceFile> interface_files();

/// The interfaces of this build as `distro` has them.
[[nodiscard]] const Interfaces& interfaces_of(Distro distro);

/// "sensor_msgs/msg/Imu" as DDS knows it: "sensor_msgs::msg::dds_::Imu_".
[[nodiscard]] std::string dds_type_name(std::string_view type);

}  // namespace fathom::ros2
