#include "bus/foreign.hpp"

#include <algorithm>
#include <atomic>
#include <map>
#include <mutex>
#include <tuple>
#include <utility>

#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/DataReaderListener.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>

#include "bus/detail/participant_impl.hpp"
#include "bus/detail/qos/profiles.hpp"
#include "bus/detail/sample_type.hpp"
#include "bus/detail/workarounds/scheduling.hpp"
#include "bus/topics.hpp"

namespace fathom::bus {
namespace {

using detail::RawSample;

/// A type of which the name is known and nothing else.
class ForeignType final : public detail::TopicType {
 public:
  explicit ForeignType(const ForeignTopic& topic) : TopicType(topic.type.c_str(), kUsualBytes, topic.keyed) {}

 private:
  static constexpr std::uint32_t kUsualBytes = 1024;  // more is made room for

  [[nodiscard]] void* create() const override { return new RawSample(); }
  void destroy(void* data) const override { delete static_cast<RawSample*>(data); }
  [[nodiscard]] std::size_t encode(const void*, std::span<char>) const override { return 0; }
  void decode(std::span<char> bytes, void* data) const override {
    static_cast<RawSample*>(data)->assign(bytes.begin(), bytes.end());
  }
  /// Where a writer does not tell it, all samples are of one instance.
  [[nodiscard]] detail::Digest key(const void*, bool) const override { return {}; }
};

bool is_ours(const std::string& topic) {
  const auto known = all_topics();
  return std::any_of(known.begin(), known.end(), [&](const TopicInfo& one) { return topic == one.topic; });
}

}  // namespace

std::vector<ForeignTopic> foreign_topics(Participant& participant) {
  std::map<std::pair<std::string, std::string>, ForeignTopic> found;
  participant.impl().peers.for_each_writer([&](const WriterGuid& guid, const detail::RemoteEndpoint& writer) {
    if (is_ours(writer.topic)) return;
    // RTPS 9.3.1.2: the kind of entity stands in its last byte.
    constexpr std::uint8_t kKindBits = 0x3F;
    constexpr std::uint8_t kWriterWithKey = 0x02;
    const ForeignTopic now{writer.topic,
                           writer.type,
                           (guid.back() & kKindBits) == kWriterWithKey,
                           writer.qos.reliability > 0,
                           writer.qos.durability > 0,
                           writer.qos.ownership > 0};
    const auto [at, is_new] = found.try_emplace({writer.topic, writer.type}, now);
    if (is_new) return;
    at->second.reliable = at->second.reliable && now.reliable;
    at->second.latched = at->second.latched && now.latched;
  });
  std::vector<ForeignTopic> out;
  out.reserve(found.size());
  for (auto& [name, topic] : found) out.push_back(std::move(topic));
  return out;
}

struct ForeignReader::Impl final : detail::dds::DataReaderListener {
  Impl(Participant::Impl& bus_in, const ForeignTopic& topic_in, Handler handler_in)
      : bus(bus_in), handler(std::move(handler_in)) {
    detail::dds::DataReaderQos qos;
    if (!detail::done(bus.subscriber->get_datareader_qos_from_profile("foreign", qos)))
      throw BusError("topic " + topic_in.topic + ": the QoS profiles have no data_reader 'foreign'");
    if (!topic_in.reliable) qos.reliability().kind = detail::dds::BEST_EFFORT_RELIABILITY_QOS;
    if (topic_in.latched) qos.durability().kind = detail::dds::TRANSIENT_LOCAL_DURABILITY_QOS;
    if (topic_in.exclusive) qos.ownership().kind = detail::dds::EXCLUSIVE_OWNERSHIP_QOS;
    detail::dds::StatusMask mask = detail::dds::StatusMask::data_available();
    mask << detail::dds::StatusMask::subscription_matched();
    const detail::dds::TypeSupport type(new ForeignType(topic_in));
    if (detail::done(type.register_type(bus.participant)))
      topic = bus.participant->create_topic(topic_in.topic, topic_in.type, detail::dds::TOPIC_QOS_DEFAULT);
    if (topic != nullptr) reader = bus.subscriber->create_datareader(topic, qos, this, mask);
    if (reader == nullptr) {
      if (topic != nullptr) bus.participant->delete_topic(topic);
      throw BusError("reader of " + topic_in.topic + ": Fast DDS could not create it" +
                     bus.why_not(topic_in.topic));
    }
  }
  ~Impl() override {
    {
      const std::lock_guard wait(mutex);
      closed = true;
    }
    reader->set_listener(nullptr);
    bus.subscriber->delete_datareader(reader);
    bus.participant->delete_topic(topic);
  }

  void on_data_available(detail::dds::DataReader* from) override {
    if (bus.samples_as) detail::carry_samples(*bus.samples_as);
    const std::lock_guard lock(mutex);
    detail::dds::SampleInfo info;
    while (!closed && detail::done(from->take_next_sample(&sample, &info))) {
      if (!info.valid_data) continue;
      handler(sample, {detail::to_guid(info.sample_identity.writer_guid()), info.source_timestamp.to_ns(),
                       info.reception_timestamp.to_ns()});
    }
  }
  void on_subscription_matched(detail::dds::DataReader*,
                               const detail::dds::SubscriptionMatchedStatus& status) override {
    matched = status.current_count;
  }

  Participant::Impl& bus;
  std::atomic<int> matched = 0;
  std::mutex mutex;  // held while samples are handed over
  bool closed = false;
  Handler handler;
  RawSample sample;
  detail::dds::Topic* topic = nullptr;
  detail::dds::DataReader* reader = nullptr;
};

ForeignReader::ForeignReader(Participant& participant, const ForeignTopic& topic, Handler handler)
    : impl_(std::make_unique<Impl>(participant.impl(), topic, std::move(handler))) {}
ForeignReader::~ForeignReader() = default;
int ForeignReader::matched_writers() const {
  return impl_->matched;
}

}  // namespace fathom::bus
