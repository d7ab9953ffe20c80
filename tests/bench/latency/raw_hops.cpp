#include "bench/latency/raw_hops.hpp"

#include <chrono>
#include <cstdint>
#include <cstring>
#include <functional>
#include <mutex>
#include <stdexcept>
#include <thread>
#include <utility>

#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/DataReaderListener.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/topic/Topic.hpp>
#include <fastdds/dds/topic/TopicDataType.hpp>
#include <fastdds/dds/topic/TypeSupport.hpp>
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <fastrtps/utils/IPLocator.h>

namespace fathom::test {
namespace {

namespace dds = eprosima::fastdds::dds;
namespace rtps = eprosima::fastrtps::rtps;

constexpr std::uint32_t kDomain = 97;

using Bytes = std::vector<unsigned char>;

/// So many bytes, as they are.
class BytesType final : public dds::TopicDataType {
 public:
  BytesType(const char* name, std::size_t size) : size_(size) {
    setName(name);
    m_typeSize = static_cast<std::uint32_t>(size);
    m_isGetKeyDefined = false;
    auto_fill_type_information(false);
    auto_fill_type_object(false);
  }
  bool serialize(void* data, rtps::SerializedPayload_t* payload) override {
    std::memcpy(payload->data, static_cast<Bytes*>(data)->data(), size_);
    payload->length = static_cast<std::uint32_t>(size_);
    return true;
  }
  bool deserialize(rtps::SerializedPayload_t* payload, void* data) override {
    if (payload->length != size_) return false;
    std::memcpy(static_cast<Bytes*>(data)->data(), payload->data, size_);
    return true;
  }
  std::function<std::uint32_t()> getSerializedSizeProvider(void* /*data*/) override {
    return [this] { return m_typeSize; };
  }
  void* createData() override { return new Bytes(size_); }
  void deleteData(void* data) override { delete static_cast<Bytes*>(data); }
  bool getKey(void* /*data*/, rtps::InstanceHandle_t* /*handle*/, bool /*force_md5*/) override {
    return false;
  }

 private:
  std::size_t size_;
};

/// A writer of one topic and a reader of another, in a participant of their own.
class Presence final : public dds::DataReaderListener {
 public:
  struct Way {
    const char* topic;
    std::size_t bytes;
  };

  Presence(Way out, Way in, std::function<void(const Bytes&)> arrived)
      : arrived_(std::move(arrived)), buffer_(in.bytes) {
    dds::DomainParticipantQos qos;
    const auto udp = std::make_shared<eprosima::fastdds::rtps::UDPv4TransportDescriptor>();
    udp->interfaceWhiteList = {"127.0.0.1"};
    udp->non_blocking_send = true;
    qos.transport().use_builtin_transports = false;
    qos.transport().user_transports = {udp};
    rtps::Locator_t peer;
    rtps::IPLocator::createLocator(LOCATOR_KIND_UDPv4, "127.0.0.1", 0, peer);
    qos.wire_protocol().builtin.initialPeersList.push_back(peer);
    participant_ = dds::DomainParticipantFactory::get_instance()->create_participant(kDomain, qos);
    if (participant_ == nullptr) throw std::runtime_error("no participant");
    const auto topic = [this](const Way& way) {
      dds::TypeSupport type(new BytesType(way.topic, way.bytes));
      type.register_type(participant_);
      return participant_->create_topic(way.topic, way.topic, dds::TOPIC_QOS_DEFAULT);
    };
    dds::DataWriterQos writer_qos;
    writer_qos.reliability().kind = dds::RELIABLE_RELIABILITY_QOS;
    writer_qos.history().depth = 64;
    writer_qos.data_sharing().off();
    writer_ =
        participant_->create_publisher(dds::PUBLISHER_QOS_DEFAULT)->create_datawriter(topic(out), writer_qos);
    dds::DataReaderQos reader_qos;
    reader_qos.reliability().kind = dds::RELIABLE_RELIABILITY_QOS;
    reader_qos.history().depth = 64;
    reader_qos.data_sharing().off();
    reader_ = participant_->create_subscriber(dds::SUBSCRIBER_QOS_DEFAULT)
                  ->create_datareader(topic(in), reader_qos, this);
    if (writer_ == nullptr || reader_ == nullptr) throw std::runtime_error("no endpoints");
  }
  ~Presence() override {
    reader_->set_listener(nullptr);
    participant_->delete_contained_entities();
    dds::DomainParticipantFactory::get_instance()->delete_participant(participant_);
  }
  Presence(const Presence&) = delete;
  Presence& operator=(const Presence&) = delete;

  void write(Bytes& bytes) { writer_->write(&bytes); }
  [[nodiscard]] bool matched() const {
    dds::PublicationMatchedStatus out;
    dds::SubscriptionMatchedStatus in;
    writer_->get_publication_matched_status(out);
    reader_->get_subscription_matched_status(in);
    return out.current_count > 0 && in.current_count > 0;
  }
  void on_data_available(dds::DataReader* reader) override {
    dds::SampleInfo info;
    while (reader->take_next_sample(&buffer_, &info) == eprosima::fastrtps::types::ReturnCode_t::RETCODE_OK) {
      if (info.valid_data) arrived_(buffer_);
    }
  }

 private:
  std::function<void(const Bytes&)> arrived_;
  Bytes buffer_;
  dds::DomainParticipant* participant_ = nullptr;
  dds::DataWriter* writer_ = nullptr;
  dds::DataReader* reader_ = nullptr;
};

std::int64_t now_ns() {
  return std::chrono::steady_clock::now().time_since_epoch().count();
}

}  // namespace

struct RawHops::Impl {
  Impl(std::size_t first_bytes, std::size_t second_bytes)
      : out(first_bytes),
        presence({"raw_first", first_bytes}, {"raw_second", second_bytes}, [this](const Bytes& bytes) {
          std::int64_t sent_ns = 0;
          std::memcpy(&sent_ns, bytes.data(), sizeof sent_ns);
          const double us = 1e-3 * static_cast<double>(now_ns() - sent_ns);
          const std::lock_guard lock(mutex);
          rounds_us.push_back(us);
        }) {}

  std::mutex mutex;
  std::vector<double> rounds_us;
  Bytes out;
  Presence presence;  ///< last: its listener uses the others
};

RawHops::RawHops(std::size_t first_bytes, std::size_t second_bytes)
    : impl_(std::make_unique<Impl>(first_bytes, second_bytes)) {}
RawHops::~RawHops() = default;

bool RawHops::matched() const {
  return impl_->presence.matched();
}

void RawHops::send() {
  const std::int64_t sent_ns = now_ns();
  std::memcpy(impl_->out.data(), &sent_ns, sizeof sent_ns);
  impl_->presence.write(impl_->out);
}

std::vector<double> RawHops::take_round_us() {
  const std::lock_guard lock(impl_->mutex);
  return std::exchange(impl_->rounds_us, {});
}

void RawHops::relay(std::size_t first_bytes, std::size_t second_bytes) {
  Bytes out(second_bytes);
  Presence* self = nullptr;
  std::mutex mutex;
  Presence presence({"raw_second", second_bytes}, {"raw_first", first_bytes}, [&](const Bytes& bytes) {
    const std::lock_guard lock(mutex);
    if (self == nullptr) return;
    std::memcpy(out.data(), bytes.data(), sizeof(std::int64_t));
    self->write(out);
  });
  {
    const std::lock_guard lock(mutex);
    self = &presence;
  }
  while (true) std::this_thread::sleep_for(std::chrono::hours(1));
}

}  // namespace fathom::test
