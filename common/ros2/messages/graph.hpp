#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "ros2/messages/geometry.hpp"

namespace fathom::ros2 {

struct KeyValue {
  static constexpr const char* kType = "diagnostic_msgs/msg/KeyValue";
  std::string key;
  std::string value;
  static void fields(auto& walk, auto& m) {
    walk("key", m.key);
    walk("value", m.value);
  }
};

struct DiagnosticStatus {
  static constexpr const char* kType = "diagnostic_msgs/msg/DiagnosticStatus";
  static constexpr Octet kOk{0};
  static constexpr Octet kWarning{1};
  static constexpr Octet kError{2};
  static constexpr Octet kStale{3};
  Octet level;
  std::string name;
  std::string message;
  std::string hardware_id;
  std::vector<KeyValue> values;
  static void fields(auto& walk, auto& m) {
    walk("level", m.level);
    walk("name", m.name);
    walk("message", m.message);
    walk("hardware_id", m.hardware_id);
    walk("values", m.values);
  }
};

struct DiagnosticArray {
  static constexpr const char* kType = "diagnostic_msgs/msg/DiagnosticArray";
  Header header;
  std::vector<DiagnosticStatus> status;
  static void fields(auto& walk, auto& m) {
    walk("header", m.header);
    walk("status", m.status);
  }
};

/// What a participant of ROS 2 says of its nodes. Humble fills an identity of 16 bytes up to 24.
template <std::size_t Bytes>
struct Gid {
  static constexpr const char* kType = "rmw_dds_common/msg/Gid";
  std::array<std::uint8_t, Bytes> data{};
  static void fields(auto& walk, auto& m) { walk("data", m.data); }
};

template <std::size_t Bytes>
struct NodeEntitiesInfo {
  static constexpr const char* kType = "rmw_dds_common/msg/NodeEntitiesInfo";
  std::string node_namespace;  ///< at most 256 bytes
  std::string node_name;       ///< likewise
  std::vector<Gid<Bytes>> reader_gid_seq;
  std::vector<Gid<Bytes>> writer_gid_seq;
  static void fields(auto& walk, auto& m) {
    walk("node_namespace", m.node_namespace);
    walk("node_name", m.node_name);
    walk("reader_gid_seq", m.reader_gid_seq);
    walk("writer_gid_seq", m.writer_gid_seq);
  }
};

template <std::size_t Bytes>
struct ParticipantEntitiesInfo {
  static constexpr const char* kType = "rmw_dds_common/msg/ParticipantEntitiesInfo";
  Gid<Bytes> gid;
  std::vector<NodeEntitiesInfo<Bytes>> node_entities_info_seq;
  static void fields(auto& walk, auto& m) {
    walk("gid", m.gid);
    walk("node_entities_info_seq", m.node_entities_info_seq);
  }
};

}  // namespace fathom::ros2
