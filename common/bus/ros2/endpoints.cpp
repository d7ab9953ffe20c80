// The readers and writers of a node.

#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>

#include "bus/detail/qos/profiles.hpp"
#include "bus/detail/workarounds/dds_log.hpp"
#include "bus/detail/workarounds/scheduling.hpp"
#include "bus/ros2/node_impl.hpp"

namespace fathom::bus::ros2 {

namespace dds = detail::dds;

PublisherCore::PublisherCore(Node::Impl& node, const MessageOps& ops, const std::string& dds_topic,
                             const char* profile)
    : bus_(node.bus), topic_(dds_topic) {
  dds::DataWriterQos qos;
  if (!detail::done(bus_.publisher->get_datawriter_qos_from_profile(profile, qos))) {
    throw BusError("topic " + topic_ + ": the QoS profiles have no data_writer '" + profile + "'");
  }
  qos.user_data().setValue(node.user_data(ops));
  dds::StatusMask mask = dds::StatusMask::publication_matched();
  mask << dds::StatusMask::offered_incompatible_qos();
  writer_ = bus_.publisher->create_datawriter(node.topic(ops, topic_), qos, this, mask);
  if (writer_ == nullptr) {
    throw BusError("writer of " + topic_ + ": Fast DDS could not create it" + detail::last_dds_error());
  }
}

PublisherCore::~PublisherCore() {
  writer_->set_listener(nullptr);
  bus_.publisher->delete_datawriter(writer_);
}

WriterGuid PublisherCore::guid() const {
  return detail::to_guid(writer_->guid());
}

bool PublisherCore::publish(const void* message) {
  Slot slot{const_cast<void*>(message)};
  const bool written = detail::done(writer_->write(&slot));
  if (!written) {
    failed_ = true;
    bus_.events.report(BusEventKind::write_failed, topic_, "",
                       "a message was too large, or found no room in the writer's history");
  } else if (failed_.exchange(false)) {
    bus_.events.recovered(BusEventKind::write_failed, topic_, "");
  }
  return written;
}

void PublisherCore::on_publication_matched(dds::DataWriter*, const dds::PublicationMatchedStatus& status) {
  matched_ = status.current_count;
}

void PublisherCore::on_offered_incompatible_qos(dds::DataWriter*,
                                                const dds::OfferedIncompatibleQosStatus& status) {
  const std::string policy(detail::to_string(detail::policy_of(status.last_policy_id)));
  bus_.events.report(BusEventKind::incompatible_qos, topic_, policy,
                     "a subscription asks for another " + policy + " than is offered here",
                     static_cast<std::uint64_t>(status.total_count_change));
}

SubscriptionCore::SubscriptionCore(Node::Impl& node, const MessageOps& ops, const std::string& dds_topic,
                                   const char* profile, Handler handler)
    : bus_(node.bus), ops_(ops), topic_(dds_topic), handler_(std::move(handler)) {
  dds::DataReaderQos qos;
  if (!detail::done(bus_.subscriber->get_datareader_qos_from_profile(profile, qos))) {
    throw BusError("topic " + topic_ + ": the QoS profiles have no data_reader '" + profile + "'");
  }
  qos.user_data().setValue(node.user_data(ops));
  dds::StatusMask mask = dds::StatusMask::data_available();
  mask << dds::StatusMask::subscription_matched() << dds::StatusMask::requested_incompatible_qos();
  dds::Topic* topic = node.topic(ops, topic_);
  slot_.message = ops_.create();
  reader_ = bus_.subscriber->create_datareader(topic, qos, this, mask);
  if (reader_ == nullptr) {
    ops_.destroy(slot_.message);
    throw BusError("reader of " + topic_ + ": Fast DDS could not create it" + detail::last_dds_error());
  }
}

SubscriptionCore::~SubscriptionCore() {
  {
    const std::lock_guard wait(mutex_);
    closed_ = true;
  }
  reader_->set_listener(nullptr);
  bus_.subscriber->delete_datareader(reader_);
  ops_.destroy(slot_.message);
}

WriterGuid SubscriptionCore::guid() const {
  return detail::to_guid(reader_->guid());
}

void SubscriptionCore::on_data_available(dds::DataReader* from) {
  if (bus_.samples_as) detail::carry_samples(*bus_.samples_as);
  const std::lock_guard lock(mutex_);
  dds::SampleInfo info;
  while (!closed_ && detail::done(from->take_next_sample(&slot_, &info))) {
    if (!info.valid_data) continue;
    const WriterGuid guid = detail::to_guid(info.sample_identity.writer_guid());
    if (!slot_.valid) {
      const std::string name = bus_.peers.name(guid);
      bus_.events.report(BusEventKind::invalid_sample, topic_, name,
                         name + " sent bytes that are no " + ops_.type);
      continue;
    }
    handler_(slot_.message, {guid, info.source_timestamp.to_ns(), info.reception_timestamp.to_ns()});
  }
}

void SubscriptionCore::on_subscription_matched(dds::DataReader*,
                                               const dds::SubscriptionMatchedStatus& status) {
  matched_ = status.current_count;
}

void SubscriptionCore::on_requested_incompatible_qos(dds::DataReader*,
                                                     const dds::RequestedIncompatibleQosStatus& status) {
  const std::string policy(detail::to_string(detail::policy_of(status.last_policy_id)));
  bus_.events.report(BusEventKind::incompatible_qos, topic_, policy,
                     "a publisher offers another " + policy + " than is asked for here",
                     static_cast<std::uint64_t>(status.total_count_change));
}

}  // namespace fathom::bus::ros2
