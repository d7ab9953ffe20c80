#include "bus/ros2/node.hpp"

#include <algorithm>
#include <vector>

#include <fastdds/dds/topic/Topic.hpp>
#include <fastdds/dds/topic/TypeSupport.hpp>

#include "bus/detail/workarounds/dds_log.hpp"
#include "bus/ros2/node_impl.hpp"
#include "ros2/messages/graph.hpp"

namespace fathom::bus::ros2 {
namespace {

constexpr const char* kGraphTopic = "ros_discovery_info";
constexpr const char* kGraphProfile = "ros2/graph";

template <std::size_t Bytes>
fathom::ros2::Gid<Bytes> gid_of(const WriterGuid& guid) {
  static_assert(Bytes >= std::tuple_size_v<WriterGuid>);
  fathom::ros2::Gid<Bytes> out;
  std::copy(guid.begin(), guid.end(), out.data.begin());
  return out;
}

}  // namespace

MessageType::MessageType(const MessageOps& ops)
    : TopicType(fathom::ros2::dds_type_name(ops.type).c_str(), ops.max_bytes, false), ops_(ops) {}

void* MessageType::create() const {
  return new Slot{ops_.create()};
}

void MessageType::destroy(void* data) const {
  auto* slot = static_cast<Slot*>(data);
  ops_.destroy(slot->message);
  delete slot;
}

std::size_t MessageType::encode(const void* data, std::span<char> into) const {
  return ops_.encode(static_cast<const Slot*>(data)->message, into);
}

void MessageType::decode(std::span<char> bytes, void* data) const {
  auto* slot = static_cast<Slot*>(data);
  slot->valid = ops_.decode(bytes, slot->message);
}

detail::Digest MessageType::key(const void* /*data*/, bool /*force_md5*/) const {
  return {};  // messages of ROS 2 have no keys
}

Node::Impl::Impl(Participant::Impl& bus_in, const NodeOptions& options_in)
    : bus(bus_in), options(options_in) {
  const bool humble = options.distro == fathom::ros2::Distro::humble;
  graph_ = std::make_unique<PublisherCore>(*this,
                                           humble ? ops_of<fathom::ros2::ParticipantEntitiesInfo<24>>()
                                                  : ops_of<fathom::ros2::ParticipantEntitiesInfo<16>>(),
                                           kGraphTopic, kGraphProfile);
  const std::lock_guard lock(mutex_);
  announce();
}

Node::Impl::~Impl() = default;

detail::dds::Topic* Node::Impl::topic(const MessageOps& ops, const std::string& name) {
  const std::lock_guard lock(mutex_);
  Known& known = topics_[name];
  const std::string type_name = fathom::ros2::dds_type_name(ops.type);
  if (known.topic != nullptr) {
    if (known.type == type_name) return known.topic;
    throw BusError("topic " + name + ": is there as " + known.type + ", expected the same and not " +
                   type_name);
  }
  const detail::dds::TypeSupport type(new MessageType(ops));
  if (detail::done(type.register_type(bus.participant))) {
    known.topic = bus.participant->create_topic(name, type_name, detail::dds::TOPIC_QOS_DEFAULT);
  }
  if (known.topic == nullptr) {
    topics_.erase(name);
    throw BusError("topic " + name + ": Fast DDS could not create it" + detail::last_dds_error());
  }
  known.type = type_name;
  return known.topic;
}

std::vector<detail::rtps::octet> Node::Impl::user_data(const MessageOps& ops) const {
  if (options.distro == fathom::ros2::Distro::humble) return {};
  const auto hash = fathom::ros2::type_hash(fathom::ros2::interfaces_of(options.distro), ops.type);
  if (!hash) throw BusError(hash.error().message);
  const std::string text = "typehash=" + hash.value() + ";";
  return {text.begin(), text.end()};
}

void Node::Impl::add_writer(const WriterGuid& guid) {
  const std::lock_guard lock(mutex_);
  if (graph_ == nullptr) return;  // the graph's own writer is no part of the node
  writers_.insert(guid);
  announce();
}
void Node::Impl::remove_writer(const WriterGuid& guid) {
  const std::lock_guard lock(mutex_);
  if (writers_.erase(guid) > 0) announce();
}
void Node::Impl::add_reader(const WriterGuid& guid) {
  const std::lock_guard lock(mutex_);
  readers_.insert(guid);
  announce();
}
void Node::Impl::remove_reader(const WriterGuid& guid) {
  const std::lock_guard lock(mutex_);
  if (readers_.erase(guid) > 0) announce();
}

void Node::Impl::announce() {
  if (options.distro == fathom::ros2::Distro::humble) {
    announce_as<24>();
  } else {
    announce_as<16>();
  }
}

template <std::size_t Bytes>
void Node::Impl::announce_as() {
  fathom::ros2::ParticipantEntitiesInfo<Bytes> info;
  info.gid = gid_of<Bytes>(detail::to_guid(bus.participant->guid()));
  fathom::ros2::NodeEntitiesInfo<Bytes> node;
  node.node_namespace = options.name_space;
  node.node_name = options.name;
  for (const WriterGuid& guid : readers_) node.reader_gid_seq.push_back(gid_of<Bytes>(guid));
  for (const WriterGuid& guid : writers_) node.writer_gid_seq.push_back(gid_of<Bytes>(guid));
  info.node_entities_info_seq.push_back(std::move(node));
  graph_->publish(&info);
}

Node::Node(Participant& participant, const NodeOptions& options)
    : impl_(std::make_unique<Impl>(participant.impl(), options)) {}
Node::~Node() = default;

}  // namespace fathom::bus::ros2
