// Publishers and subscriptions of each type of message.

#include <utility>

#include "bus/ros2/node_impl.hpp"
#include "bus/ros2/wire.hpp"
#include "ros2/messages/graph.hpp"
#include "ros2/messages/sensors.hpp"

namespace fathom::bus::ros2 {
namespace {

/// The largest message that is sent. Lists are of what this vehicle has; text is short.
constexpr std::uint32_t kOne = 2048;
constexpr std::uint32_t kList = 131'072;

constexpr const char* profile_of(Quality quality) {
  switch (quality) {
    case Quality::reliable:
      return "ros2/reliable";
    case Quality::sensor_data:
      return "ros2/sensor_data";
    case Quality::latched:
      return "ros2/latched";
  }
  return "ros2/reliable";
}

/// As rmw names the topics of publishers and subscriptions.
std::string dds_topic(const std::string& topic) {
  return "rt" + topic;
}

template <class Message>
constexpr std::uint32_t max_bytes() {
  if constexpr (
      requires(Message m) { m.transforms; } || requires(Message m) { m.status.begin(); } ||
      requires(Message m) { m.node_entities_info_seq; }) {
    return kList;
  } else {
    return kOne;
  }
}

}  // namespace

template <class Message>
const MessageOps& ops_of() {
  static constexpr MessageOps kOps{
      Message::kType,
      max_bytes<Message>(),
      [] { return static_cast<void*>(new Message()); },
      [](void* message) { delete static_cast<Message*>(message); },
      [](const void* message, std::span<char> into) {
        return encode(*static_cast<const Message*>(message), into);
      },
      [](std::span<char> bytes, void* message) { return decode(bytes, *static_cast<Message*>(message)); }};
  return kOps;
}

template <class Message>
struct Publisher<Message>::Impl {
  Impl(Node::Impl& of, const std::string& topic, Quality quality)
      : node(of), core(of, ops_of<Message>(), dds_topic(topic), profile_of(quality)) {
    node.add_writer(core.guid());
  }
  ~Impl() { node.remove_writer(core.guid()); }
  Node::Impl& node;
  PublisherCore core;
};
template <class Message>
Publisher<Message>::Publisher(Node& node, const std::string& topic, Quality quality)
    : impl_(std::make_unique<Impl>(node.impl(), topic, quality)) {}
template <class Message>
Publisher<Message>::~Publisher() = default;
template <class Message>
bool Publisher<Message>::publish(const Message& message) {
  return impl_->core.publish(&message);
}
template <class Message>
int Publisher<Message>::matched_subscriptions() const {
  return impl_->core.matched();
}

template <class Message>
struct Subscription<Message>::Impl {
  Impl(Node::Impl& of, const std::string& topic, Quality quality, Handler handler)
      : node(of),
        core(of, ops_of<Message>(), dds_topic(topic), profile_of(quality),
             [handler = std::move(handler)](const void* message, const SampleInfo& info) {
               handler(*static_cast<const Message*>(message), info);
             }) {
    node.add_reader(core.guid());
  }
  ~Impl() { node.remove_reader(core.guid()); }
  Node::Impl& node;
  SubscriptionCore core;
};
template <class Message>
Subscription<Message>::Subscription(Node& node, const std::string& topic, Quality quality, Handler handler)
    : impl_(std::make_unique<Impl>(node.impl(), topic, quality, std::move(handler))) {}
template <class Message>
Subscription<Message>::~Subscription() = default;
template <class Message>
int Subscription<Message>::matched_publishers() const {
  return impl_->core.matched();
}

template const MessageOps& ops_of<fathom::ros2::ParticipantEntitiesInfo<16>>();
template const MessageOps& ops_of<fathom::ros2::ParticipantEntitiesInfo<24>>();

#define FATHOM_ROS2_MESSAGE(Message)               \
  template class Publisher<fathom::ros2::Message>; \
  template class Subscription<fathom::ros2::Message>;

FATHOM_ROS2_MESSAGE(Odometry)
FATHOM_ROS2_MESSAGE(Imu)
FATHOM_ROS2_MESSAGE(NavSatFix)
FATHOM_ROS2_MESSAGE(FluidPressure)
FATHOM_ROS2_MESSAGE(Dvl)
FATHOM_ROS2_MESSAGE(TwistWithCovarianceStamped)
FATHOM_ROS2_MESSAGE(PoseWithCovarianceStamped)
FATHOM_ROS2_MESSAGE(GeoPoseStamped)
FATHOM_ROS2_MESSAGE(TFMessage)
FATHOM_ROS2_MESSAGE(DiagnosticArray)
FATHOM_ROS2_MESSAGE(String)

}  // namespace fathom::bus::ros2
