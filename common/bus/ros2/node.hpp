#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "bus/participant.hpp"
#include "bus/reader.hpp"
#include "ros2/interface/description.hpp"

/// Presence in a graph of ROS 2, without ROS: topics, types and discovery as rmw_fastrtps and rmw_cyclonedds
/// have them.
namespace fathom::bus::ros2 {

/// What a participant of ROS 2 adds to ParticipantOptions::user_data.
inline constexpr const char* kUserData = "enclave=/;";

/// QoS by what it is for: a profile of deploy/dds/ros2.xml.
enum class Quality : std::uint8_t {
  reliable,     ///< also heard by those who ask for less
  sensor_data,  ///< best effort
  latched       ///< reliable, and the last one also for those who come late
};

struct NodeOptions {
  std::string name_space = "/";  ///< "/" or "/auv"
  std::string name;
  fathom::ros2::Distro distro = fathom::ros2::Distro::jazzy;
};

/// A node of ROS 2: `ros2 node list` shows it, with all that is published and subscribed through it. The
/// participant is that of one node, with kUserData, and outlives it; the node outlives its publishers and
/// subscriptions.
class Node {
 public:
  /// Throws BusError.
  Node(Participant& participant, const NodeOptions& options);
  ~Node();
  Node(const Node&) = delete;
  Node& operator=(const Node&) = delete;

  struct Impl;
  [[nodiscard]] Impl& impl() { return *impl_; }

 private:
  std::unique_ptr<Impl> impl_;
};

/// Publishes messages of ros2/messages on a topic by its full name, "/tf". Thread-safe.
template <class Message>
class Publisher {
 public:
  /// Throws BusError.
  Publisher(Node& node, const std::string& topic, Quality quality);
  ~Publisher();
  Publisher(const Publisher&) = delete;
  Publisher& operator=(const Publisher&) = delete;

  /// False when the message is larger than this bus sends, or found no room in time.
  bool publish(const Message& message);
  [[nodiscard]] int matched_subscriptions() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Receives them.
template <class Message>
class Subscription {
 public:
  using Handler = std::function<void(const Message& message, const SampleInfo& info)>;

  /// As of Reader: the handler is quick, does not throw and does not destroy the subscription.
  Subscription(Node& node, const std::string& topic, Quality quality, Handler handler);
  ~Subscription();
  Subscription(const Subscription&) = delete;
  Subscription& operator=(const Subscription&) = delete;

  [[nodiscard]] int matched_publishers() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace fathom::bus::ros2
