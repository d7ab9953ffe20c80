#pragma once

#include <chrono>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantListener.hpp>

#include "bus/detail/dds_log.hpp"
#include "bus/detail/event_book.hpp"
#include "bus/detail/peer_book.hpp"
#include "bus/detail/scheduling.hpp"
#include "bus/detail/stranger_book.hpp"
#include "bus/detail/topic_ops.hpp"
#include "bus/detail/transport.hpp"
#include "bus/participant.hpp"
#include "security/credentials.hpp"

namespace fathom::bus {

/// The Fast DDS side of a participant: its entities, what discovery tells, and the shared books.
struct Participant::Impl final : eprosima::fastdds::dds::DomainParticipantListener {
  explicit Impl(const ParticipantOptions& options);
  ~Impl() override;

  /// The topic, created and its type registered at first use. Throws BusError.
  eprosima::fastdds::dds::Topic* topic(const detail::TopicOps& ops);

  /// A reader lost sight of this writer. Whether the writer was deleted or its process died is known when the
  /// participant is found to have left (at once) or to have been dropped.
  void writer_unmatched(const WriterGuid& guid, const std::string& topic);
  void writer_matched(const WriterGuid& guid, const std::string& topic);
  /// Reports the participants that use this topic with another type: they will never match.
  void check_types(const std::string& topic);

  void on_participant_discovery(eprosima::fastdds::dds::DomainParticipant*,
                                eprosima::fastrtps::rtps::ParticipantDiscoveryInfo&& info) override;
  void on_publisher_discovery(eprosima::fastdds::dds::DomainParticipant*,
                              eprosima::fastrtps::rtps::WriterDiscoveryInfo&& info) override;
  void on_subscriber_discovery(eprosima::fastdds::dds::DomainParticipant*,
                               eprosima::fastrtps::rtps::ReaderDiscoveryInfo&& info) override;

  void onParticipantAuthentication(eprosima::fastdds::dds::DomainParticipant*,
                                   eprosima::fastrtps::rtps::ParticipantAuthenticationInfo&& info) override;

  /// What Fast DDS could not do about a local writer or reader, with the remedy where it is known.
  [[nodiscard]] std::string why_not(const std::string& topic);
  /// Reports those who have taken too long to prove an identity.
  void judge_waiting();

  detail::EventBook events;
  detail::PeerBook peers;
  detail::StrangerBook strangers;
  std::optional<detail::Scheduling> samples_as;      ///< of threads that carry samples; nothing: as chores
  std::optional<security::Credentials> credentials;  ///< nothing: the network is not protected
  eprosima::fastdds::dds::DomainParticipant* participant = nullptr;
  eprosima::fastdds::dds::Publisher* publisher = nullptr;
  eprosima::fastdds::dds::Subscriber* subscriber = nullptr;

 private:
  struct Unmatched {
    WriterGuid guid;
    std::string topic;
    std::chrono::steady_clock::time_point when;
  };
  void refuse_datagram(const std::string& address);
  /// Whether samples go to this participant after all others.
  void note_order(const detail::GuidPrefix& prefix,
                  const eprosima::fastrtps::rtps::ParticipantDiscoveryInfo& info);
  void participant_dropped(const detail::GuidPrefix& prefix);
  void meet(const detail::GuidPrefix& prefix, const Peer& peer,
            const eprosima::fastrtps::rtps::ParticipantProxyData& data);
  void part(const detail::GuidPrefix& prefix);
  void report(const Stranger& stranger);
  void on_dds_error(const std::string& message);
  void close();

  const std::shared_ptr<detail::Onlookers> onlookers_ = std::make_shared<detail::Onlookers>();
  int number_ = -1;  // among the participants of this process

  std::mutex mutex_;
  std::map<std::string, eprosima::fastdds::dds::Topic*> topics_;  // owned by participant
  std::map<std::string, std::string> types_;                      // of local topics
  std::vector<Unmatched> unmatched_;

  std::mutex strangers_mutex_;
  std::set<std::string> reported_strangers_;
  bool denied_ = false;                      ///< our own permissions do not allow what was tried last
  std::optional<detail::DdsErrors> errors_;  // last: gone before what it touches
};

namespace detail {

/// A Fast DDS GUID or instance handle as plain bytes.
[[nodiscard]] WriterGuid to_guid(const eprosima::fastrtps::rtps::GUID_t& guid);

}  // namespace detail

}  // namespace fathom::bus
