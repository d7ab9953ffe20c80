#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.hpp"

/// How a message of ROS 2 is laid out: the text that its file carries ("ros2msg"), as a tree.
namespace fathom::logs::ros2 {

enum class Basic : std::uint8_t { boolean, i8, u8, i16, u16, i32, u32, i64, u64, f32, f64, string };

[[nodiscard]] std::size_t size_of(Basic type);

/// What a schema may be, whatever its text claims.
inline constexpr std::size_t kLongestText = std::size_t{1} << 20U;
inline constexpr std::size_t kMostNodes = 4096;    ///< fields, those of nested messages each time they occur
inline constexpr std::size_t kMostColumns = 8192;  ///< numbers that one message gives
inline constexpr std::size_t kDeepest = 16;        ///< messages within messages

/// One field. Columns and texts are counted in the order of the bytes.
struct Node {
  enum class Array : std::uint8_t { none, fixed, sequence };
  std::string name;
  Array array = Array::none;
  std::size_t count = 1;       ///< elements of a fixed array; the most of a bounded sequence; else 0 or 1
  bool bounded = false;        ///< a sequence that says how long it is at most
  std::optional<Basic> basic;  ///< nothing: a message within the message, or an array of them
  std::vector<Node> members;   ///< of a message
  std::size_t longest = 0;     ///< of a bounded string; 0: any
  std::size_t kept = 1;        ///< elements that have columns
  std::size_t columns = 0;     ///< of one element
  std::size_t texts = 0;       ///< likewise, strings
};

struct Schema {
  std::string type;                  ///< "sensor_msgs/Imu"
  Node root;                         ///< a message
  std::vector<std::string> columns;  ///< "header.stamp.sec", "position_covariance[3]", "beams.length"
  std::vector<std::string> texts;    ///< "header.frame_id"
};

/// "sensor_msgs/msg/Imu" and "sensor_msgs/Imu" are the same: the latter.
[[nodiscard]] std::string short_type(std::string_view name);

/// Reads the definition of `type` and, behind lines of "===" and "MSG: package/Type", those that it needs.
/// Of a sequence the first `kept` elements get columns. Fails where a definition is missing, contains itself
/// or is larger than the limits above; the error names line or field.
[[nodiscard]] Result<Schema> parse(std::string_view type, std::string_view text, std::size_t kept = 8);

}  // namespace fathom::logs::ros2
