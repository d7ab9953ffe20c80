#pragma once

#include <string>
#include <vector>

#include <fastdds/dds/domain/DomainParticipantListener.hpp>

#include "bus/detail/network/peer_book.hpp"
#include "bus/detail/versions/names.hpp"

namespace fathom::bus::detail {

/// Whether participants are announced that have not proved an identity. Fast DDS 3 tells of their GUID alone,
/// when it refuses them.
inline constexpr bool kAnnouncesStrangers = FATHOM_FASTDDS_MAJOR < 3;

/// What a participant says of itself.
struct Announcement {
  std::string name;
  std::string user_data;
  bool offers_identity = false;               ///< true where the version does not tell (3.1)
  std::vector<rtps::Locator_t> discovery_at;  ///< unicast
  std::vector<rtps::Locator_t> samples_at;    ///< unicast
};

/// dds::DomainParticipantListener, told of others in the same words by every version of Fast DDS.
class DiscoveryListener : public dds::DomainParticipantListener {
 protected:
  /// It came, or said something new of itself, or the same again.
  virtual void participant_seen(const GuidPrefix& who, const Announcement& announcement) = 0;
  /// It said that it left, or `fell_silent`.
  virtual void participant_gone(const GuidPrefix& who, bool fell_silent) = 0;
  virtual void writer_seen(const WriterGuid& guid, const RemoteEndpoint& writer) = 0;
  virtual void writer_gone(const WriterGuid& guid) = 0;
  virtual void reader_seen(const WriterGuid& guid, const RemoteEndpoint& reader) = 0;
  virtual void reader_gone(const WriterGuid& guid) = 0;

 private:
#if FATHOM_FASTDDS_MAJOR < 3
  void on_participant_discovery(dds::DomainParticipant*, rtps::ParticipantDiscoveryInfo&& info) final;
  void on_publisher_discovery(dds::DomainParticipant*, rtps::WriterDiscoveryInfo&& info) final;
  void on_subscriber_discovery(dds::DomainParticipant*, rtps::ReaderDiscoveryInfo&& info) final;
#else
  void on_participant_discovery(dds::DomainParticipant*, rtps::ParticipantDiscoveryStatus reason,
                                const rtps::ParticipantBuiltinTopicData& data, bool& ignore) final;
  void on_data_writer_discovery(dds::DomainParticipant*, rtps::WriterDiscoveryStatus reason,
                                const rtps::PublicationBuiltinTopicData& data, bool& ignore) final;
  void on_data_reader_discovery(dds::DomainParticipant*, rtps::ReaderDiscoveryStatus reason,
                                const rtps::SubscriptionBuiltinTopicData& data, bool& ignore) final;
#endif
};

/// A Fast DDS GUID or instance handle as plain bytes.
[[nodiscard]] WriterGuid to_guid(const rtps::GUID_t& guid);

}  // namespace fathom::bus::detail
