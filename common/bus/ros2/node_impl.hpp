#pragma once

#include <atomic>
#include <map>
#include <mutex>
#include <set>
#include <span>
#include <string>

#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/DataWriterListener.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/DataReaderListener.hpp>

#include "bus/detail/participant_impl.hpp"
#include "bus/detail/versions/topic_type.hpp"
#include "bus/ros2/node.hpp"

namespace fathom::bus::ros2 {

/// What the bus needs to know of a message's type, which is forgotten otherwise.
struct MessageOps {
  const char* type;         ///< e.g. "sensor_msgs/msg/Imu"
  std::uint32_t max_bytes;  ///< that are sent, with encapsulation
  void* (*create)();
  void (*destroy)(void* message);
  std::size_t (*encode)(const void* message, std::span<char> into);
  bool (*decode)(std::span<char> bytes, void* message);
};
template <class Message>
[[nodiscard]] const MessageOps& ops_of();

/// What Fast DDS calls the data: a message, and whether the bytes it was last read from made sense.
struct Slot {
  void* message = nullptr;
  bool valid = true;
};

class MessageType final : public detail::TopicType {
 public:
  explicit MessageType(const MessageOps& ops);

 private:
  [[nodiscard]] void* create() const override;
  void destroy(void* data) const override;
  [[nodiscard]] std::size_t encode(const void* data, std::span<char> into) const override;
  void decode(std::span<char> bytes, void* data) const override;
  [[nodiscard]] detail::Digest key(const void* data, bool force_md5) const override;

  const MessageOps& ops_;
};

/// Publisher without the message's type.
class PublisherCore final : detail::dds::DataWriterListener {
 public:
  PublisherCore(Node::Impl& node, const MessageOps& ops, const std::string& dds_topic, const char* profile);
  ~PublisherCore() override;
  bool publish(const void* message);
  [[nodiscard]] int matched() const { return matched_; }
  [[nodiscard]] WriterGuid guid() const;

 private:
  void on_publication_matched(detail::dds::DataWriter*,
                              const detail::dds::PublicationMatchedStatus& status) override;
  void on_offered_incompatible_qos(detail::dds::DataWriter*,
                                   const detail::dds::OfferedIncompatibleQosStatus& status) override;

  Participant::Impl& bus_;
  std::string topic_;
  std::atomic<int> matched_ = 0;
  std::atomic<bool> failed_ = false;
  detail::dds::DataWriter* writer_ = nullptr;
};

/// Subscription without it.
class SubscriptionCore final : detail::dds::DataReaderListener {
 public:
  using Handler = std::function<void(const void* message, const SampleInfo& info)>;
  SubscriptionCore(Node::Impl& node, const MessageOps& ops, const std::string& dds_topic, const char* profile,
                   Handler handler);
  ~SubscriptionCore() override;
  [[nodiscard]] int matched() const { return matched_; }
  [[nodiscard]] WriterGuid guid() const;

 private:
  void on_data_available(detail::dds::DataReader* from) override;
  void on_subscription_matched(detail::dds::DataReader*,
                               const detail::dds::SubscriptionMatchedStatus& status) override;
  void on_requested_incompatible_qos(detail::dds::DataReader*,
                                     const detail::dds::RequestedIncompatibleQosStatus& status) override;

  Participant::Impl& bus_;
  const MessageOps& ops_;
  std::string topic_;
  std::atomic<int> matched_ = 0;
  std::mutex mutex_;  // held while messages are handed over
  bool closed_ = false;
  Handler handler_;
  Slot slot_;
  detail::dds::DataReader* reader_ = nullptr;
};

struct Node::Impl {
  Impl(Participant::Impl& bus, const NodeOptions& options);
  ~Impl();

  /// The topic, made at first use. Throws BusError, also where it is there with another type.
  detail::dds::Topic* topic(const MessageOps& ops, const std::string& name);
  /// USER_DATA of readers and writers: the hash of the type, where the distribution has hashes.
  [[nodiscard]] std::vector<detail::rtps::octet> user_data(const MessageOps& ops) const;

  void add_writer(const WriterGuid& guid);
  void remove_writer(const WriterGuid& guid);
  void add_reader(const WriterGuid& guid);
  void remove_reader(const WriterGuid& guid);

  Participant::Impl& bus;
  const NodeOptions options;

 private:
  void announce();  // precondition: mutex_ held
  template <std::size_t Bytes>
  void announce_as();

  std::mutex mutex_;
  struct Known {
    detail::dds::Topic* topic = nullptr;
    std::string type;
  };
  std::map<std::string, Known> topics_;
  std::set<WriterGuid> writers_;
  std::set<WriterGuid> readers_;
  std::unique_ptr<PublisherCore> graph_;
};

}  // namespace fathom::bus::ros2
