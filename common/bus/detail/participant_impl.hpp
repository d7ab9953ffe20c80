#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <fastdds/dds/domain/DomainParticipant.hpp>

#include "bus/detail/event_book.hpp"
#include "bus/detail/network/delivery_watch.hpp"
#include "bus/detail/network/peer_book.hpp"
#include "bus/detail/network/transport.hpp"
#include "bus/detail/security/stranger_book.hpp"
#include "bus/detail/topic_ops.hpp"
#include "bus/detail/versions/discovery_listener.hpp"
#include "bus/detail/workarounds/dds_log.hpp"
#include "bus/detail/workarounds/scheduling.hpp"
#include "bus/detail/workarounds/work_queue.hpp"
#include "bus/participant.hpp"
#include "security/credentials.hpp"

namespace fathom::bus {

/// The Fast DDS side of a participant: its entities, what discovery tells, and the shared books.
struct Participant::Impl final : detail::DiscoveryListener {
  explicit Impl(const ParticipantOptions& options);
  ~Impl() override;

  /// The topic, created and its type registered at first use. Throws BusError.
  detail::dds::Topic* topic(const detail::TopicOps& ops);

  /// A reader lost sight of this writer. Whether the writer was deleted or its process died is known when the
  /// participant is found to have left (at once) or to have been dropped.
  void writer_unmatched(const WriterGuid& guid, const std::string& topic);
  void writer_matched(const WriterGuid& guid, const std::string& topic);
  /// Reports the participants that use this topic with another type: they will never match.
  void check_types(const std::string& topic);

  void participant_seen(const detail::GuidPrefix& who, const detail::Announcement& announcement) override;
  void participant_gone(const detail::GuidPrefix& who, bool fell_silent) override;
  void writer_seen(const WriterGuid& guid, const detail::RemoteEndpoint& writer) override;
  void writer_gone(const WriterGuid& guid) override;
  void reader_seen(const WriterGuid& guid, const detail::RemoteEndpoint& reader) override;
  void reader_gone(const WriterGuid& guid) override;

  void onParticipantAuthentication(detail::dds::DomainParticipant*,
                                   detail::rtps::ParticipantAuthenticationInfo&& info) override;

  /// An entity id below the one asked for before, and above those that Fast DDS gives by itself. Below it
  /// both as Fast DDS compares two of them and as Cyclone DDS does, which begins with the lower byte. There
  /// are some four hundred; then they begin anew.
  [[nodiscard]] std::int16_t next_lower_id() {
    constexpr int kBoth = 256 + 123;
    const int step = lower_ids_++ % kBoth;
    return static_cast<std::int16_t>(step < 256 ? 0x7FFF - step : 0x7F00 - ((step - 255) << 8));
  }

  /// What Fast DDS could not do about a local writer or reader, with the remedy where it is known.
  [[nodiscard]] std::string why_not(const std::string& topic);
  /// Reports those who have taken too long to prove an identity.
  void judge_waiting();

  detail::EventBook events;
  detail::PeerBook peers;
  const std::shared_ptr<detail::DeliveryWatch> delivery_watch = std::make_shared<detail::DeliveryWatch>();
  const std::shared_ptr<detail::AcknowledgementBook> acknowledgements =
      std::make_shared<detail::AcknowledgementBook>();
  detail::WorkQueue work_queue;
  /// How much longer the ends of all writers together wait for readers: one on a machine that is busy takes
  /// its time, and one that died is not known to have died.
  std::atomic<DurationNs> patience_ns = 2 * kNsPerSecond;
  detail::StrangerBook strangers;
  std::optional<detail::Scheduling> samples_as;      ///< of threads that carry samples; nothing: as chores
  std::optional<security::Credentials> credentials;  ///< nothing: the network is not protected
  detail::dds::DomainParticipant* participant = nullptr;
  detail::dds::Publisher* publisher = nullptr;
  detail::dds::Subscriber* subscriber = nullptr;

 private:
  struct Unmatched {
    WriterGuid guid;
    std::string topic;
    std::chrono::steady_clock::time_point when;
  };
  void refuse_datagram(const std::string& address);
  void participant_dropped(const detail::GuidPrefix& prefix);
  void meet(const detail::GuidPrefix& prefix, const Peer& peer, const detail::Announcement& announcement);
  void part(const detail::GuidPrefix& prefix);
  void report(const Stranger& stranger);
  void on_dds_error(const std::string& message);
  void close();

  const std::shared_ptr<detail::LowPriorityPeers> low_priority_peers_ =
      std::make_shared<detail::LowPriorityPeers>();
  std::atomic<int> lower_ids_ = 0;  // given
  int number_ = -1;                 // among the participants of this process

  std::mutex mutex_;
  std::map<std::string, detail::dds::Topic*> topics_;  // owned by participant
  std::map<std::string, std::string> types_;           // of local topics
  std::vector<Unmatched> unmatched_;

  std::mutex strangers_mutex_;
  std::set<std::string> reported_strangers_;
  bool denied_ = false;                      ///< our own permissions do not allow what was tried last
  std::optional<detail::DdsErrors> errors_;  // last: gone before what it touches
};

}  // namespace fathom::bus
