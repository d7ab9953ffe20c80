#include "bus/detail/versions/discovery_listener.hpp"

#include <algorithm>

#include <fastdds/dds/domain/DomainParticipant.hpp>
#if FATHOM_FASTDDS_MAJOR < 3
#include <fastdds/rtps/builtin/data/ReaderProxyData.h>
#include <fastdds/rtps/builtin/data/WriterProxyData.h>
#include <fastdds/rtps/participant/ParticipantDiscoveryInfo.h>
#include <fastdds/rtps/reader/ReaderDiscoveryInfo.h>
#include <fastdds/rtps/writer/WriterDiscoveryInfo.h>
#else
#include <fastdds/rtps/builtin/data/ParticipantBuiltinTopicData.hpp>
#include <fastdds/rtps/builtin/data/PublicationBuiltinTopicData.hpp>
#include <fastdds/rtps/builtin/data/SubscriptionBuiltinTopicData.hpp>
#include <fastdds/rtps/participant/ParticipantDiscoveryInfo.hpp>
#include <fastdds/rtps/reader/ReaderDiscoveryStatus.hpp>
#include <fastdds/rtps/writer/WriterDiscoveryStatus.hpp>
#endif

#include "bus/detail/qos/profiles.hpp"

namespace fathom::bus::detail {
namespace {

GuidPrefix to_prefix(const rtps::GUID_t& guid) {
  return prefix_of(to_guid(guid));
}

template <class Locators>
std::vector<rtps::Locator_t> all_of(const Locators& locators) {
  return {locators.begin(), locators.end()};
}

std::string text_of(const dds::UserDataQosPolicy& data) {
  const auto& bytes = data.data_vec();
  return {bytes.begin(), bytes.end()};
}

#if FATHOM_FASTDDS_MAJOR < 3

/// Fast DDS 2.9.1 forgets a participant that left on the thread that heard of it, while another may be about
/// to check its lease and asserts that it is not forgotten. That check looks at this flag first, under a lock
/// that is taken for the forgetting, after this; the next participant in its place has the flag set anew.
void check_lease_no_more(const rtps::ParticipantProxyData& left) {
  // A reference to what Fast DDS itself keeps, and not as constant as it is shown.
  const_cast<rtps::ParticipantProxyData&>(left).should_check_lease_duration = false;
}

Announcement announcement_of(const rtps::ParticipantProxyData& data) {
  return {data.m_participantName.to_string(), text_of(data.m_userData), !data.identity_token_.is_nil(),
          all_of(data.metatraffic_locators.unicast), all_of(data.default_locators.unicast)};
}

template <class ProxyData>
RemoteEndpoint endpoint_of(const ProxyData& data) {
  const auto& qos = data.m_qos;
  return {data.topicName().to_string(), data.typeName().to_string(),
          summarise(qos.m_reliability, qos.m_durability, qos.m_deadline, qos.m_ownership, qos.m_liveliness)};
}

#else

Announcement announcement_of(const rtps::ParticipantBuiltinTopicData& data) {
  return {data.participant_name.to_string(), text_of(data.user_data), true,
          all_of(data.metatraffic_locators.unicast), all_of(data.default_locators.unicast)};
}

template <class Data>
RemoteEndpoint endpoint_of(const Data& data) {
  return {data.topic_name.to_string(), data.type_name.to_string(),
          summarise(data.reliability, data.durability, data.deadline, data.ownership, data.liveliness)};
}

#endif

}  // namespace

WriterGuid to_guid(const rtps::GUID_t& guid) {
  WriterGuid bytes{};
  std::copy_n(&guid.guidPrefix.value[0], 12, bytes.begin());
  std::copy_n(&guid.entityId.value[0], 4, bytes.begin() + 12);
  return bytes;
}

#if FATHOM_FASTDDS_MAJOR < 3

void DiscoveryListener::on_participant_discovery(dds::DomainParticipant*,
                                                 rtps::ParticipantDiscoveryInfo&& info) {
  using Info = rtps::ParticipantDiscoveryInfo;
  const GuidPrefix who = to_prefix(info.info.m_guid);
  switch (info.status) {
    case Info::DISCOVERED_PARTICIPANT:
    case Info::CHANGED_QOS_PARTICIPANT:
      return participant_seen(who, announcement_of(info.info));
    case Info::DROPPED_PARTICIPANT:
      return participant_gone(who, true);
    case Info::REMOVED_PARTICIPANT:
      check_lease_no_more(info.info);
      return participant_gone(who, false);
    default:  // 2.11 also tells of those that a listener asked it to ignore
      return;
  }
}

void DiscoveryListener::on_publisher_discovery(dds::DomainParticipant*, rtps::WriterDiscoveryInfo&& info) {
  const WriterGuid guid = to_guid(info.info.guid());
  if (info.status == rtps::WriterDiscoveryInfo::REMOVED_WRITER) return writer_gone(guid);
  writer_seen(guid, endpoint_of(info.info));
}

void DiscoveryListener::on_subscriber_discovery(dds::DomainParticipant*, rtps::ReaderDiscoveryInfo&& info) {
  const WriterGuid guid = to_guid(info.info.guid());
  if (info.status == rtps::ReaderDiscoveryInfo::REMOVED_READER) return reader_gone(guid);
  reader_seen(guid, endpoint_of(info.info));
}

#else

void DiscoveryListener::on_participant_discovery(dds::DomainParticipant* us,
                                                 rtps::ParticipantDiscoveryStatus reason,
                                                 const rtps::ParticipantBuiltinTopicData& data,
                                                 bool& ignore) {
  using Status = rtps::ParticipantDiscoveryStatus;
  // A discovery server of 3.0 and later answers clients of every domain; before, it is called by a GUID
  // prefix that has ours in it.
  ignore = data.domain_id != us->get_domain_id() && data.domain_id != dds::DOMAIN_ID_UNKNOWN;
  if (ignore) return;
  const GuidPrefix who = to_prefix(data.guid);
  switch (reason) {
    case Status::DISCOVERED_PARTICIPANT:
    case Status::CHANGED_QOS_PARTICIPANT:
      return participant_seen(who, announcement_of(data));
    case Status::DROPPED_PARTICIPANT:
      return participant_gone(who, true);
    case Status::REMOVED_PARTICIPANT:
      return participant_gone(who, false);
    case Status::IGNORED_PARTICIPANT:
      return;
  }
}

void DiscoveryListener::on_data_writer_discovery(dds::DomainParticipant*, rtps::WriterDiscoveryStatus reason,
                                                 const rtps::PublicationBuiltinTopicData& data,
                                                 bool& ignore) {
  ignore = false;
  const WriterGuid guid = to_guid(data.guid);
  if (reason == rtps::WriterDiscoveryStatus::REMOVED_WRITER) return writer_gone(guid);
  writer_seen(guid, endpoint_of(data));
}

void DiscoveryListener::on_data_reader_discovery(dds::DomainParticipant*, rtps::ReaderDiscoveryStatus reason,
                                                 const rtps::SubscriptionBuiltinTopicData& data,
                                                 bool& ignore) {
  ignore = false;
  const WriterGuid guid = to_guid(data.guid);
  if (reason == rtps::ReaderDiscoveryStatus::REMOVED_READER) return reader_gone(guid);
  reader_seen(guid, endpoint_of(data));
}

#endif

}  // namespace fathom::bus::detail
