#include <atomic>
#include <chrono>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <span>
#include <utility>

#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/DataReaderListener.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>

#include "bus/detail/dds_log.hpp"
#include "bus/detail/endpoint.hpp"
#include "bus/detail/participant_impl.hpp"
#include "bus/detail/qos.hpp"
#include "bus/detail/sample_type.hpp"

namespace fathom::bus::detail {
using rtps::InstanceHandle_t;

namespace {

constexpr std::chrono::seconds kRest(30);  // from one renewal of a reader to the next

}  // namespace

struct ReaderCore::Impl final : dds::DataReaderListener {
  Impl(Participant::Impl& bus_in, const TopicOps& ops_in, Handler handler_in, const ReaderOptions& options)
      : bus(bus_in),
        ops(ops_in),
        qos(reader_qos(*bus.subscriber, ops.topic, options)),
        requested(summarise(qos.reliability(), qos.durability(), qos.deadline(), qos.ownership(),
                            qos.liveliness())),
        handler(std::move(handler_in)) {
    slot.sample = ops.create();
    open();
    if (reader == nullptr) {
      ops.destroy(slot.sample);
      throw BusError("reader of " + std::string(ops.topic) + ": Fast DDS could not create it" +
                     bus.why_not(ops.topic));
    }
    bus.check_types(ops.topic);
  }

  ~Impl() override {
    bus.hearing->leave(this);
    bus.errands.forget(this);
    close();
    ops.destroy(slot.sample);
  }

  void open() {
    dds::StatusMask mask = dds::StatusMask::data_available();
    mask << dds::StatusMask::subscription_matched() << dds::StatusMask::requested_deadline_missed()
         << dds::StatusMask::requested_incompatible_qos() << dds::StatusMask::sample_lost()
         << dds::StatusMask::sample_rejected();
    dds::Topic* topic = bus.topic(ops);
    closed = false;
    // Joined before Fast DDS knows it, for writers may be matched at once.
    bus.hearing->join(this, requested.ownership == dds::EXCLUSIVE_OWNERSHIP_QOS,
                      [this] { bus.errands.run(this, [this] { renew(); }); });
    reader = bus.subscriber->create_datareader(topic, qos, this, mask);
    if (reader == nullptr) return bus.hearing->leave(this);
    const WriterGuid guid = to_guid(reader->guid());
    bus.hearing->is_entity(this, to_entity_id(std::span(guid).subspan(12)));
  }

  void close() {
    closed = true;
    // Whoever is in the handler now is waited for; whoever comes later sees `closed`.
    { const std::lock_guard wait(handler_mutex); }
    if (reader == nullptr) return;
    reader->set_listener(nullptr);
    bus.subscriber->delete_datareader(reader);
    reader = nullptr;
  }

  /// Another Fast DDS reader in the place of one that hands nothing over. Not too often, for whoever can make
  /// a reader deaf may go on doing so, and the topic's other writers have to find the new one.
  void renew() {
    const auto now = std::chrono::steady_clock::now();
    if (renewed && now - *renewed < kRest) return;
    renewed = now;
    bus.hearing->leave(this);
    close();
    {
      const std::lock_guard lock(mutex);
      writers.clear();
      instances.clear();
      matched = 0;
    }
    open();
    bus.events.report(
        BusEventKind::sample_lost, ops.topic, "deaf",
        reader == nullptr
            ? "samples came in and were not handed over, and no other reader could be made" + last_dds_error()
            : "samples came in and were not handed over: another reader was made");
    bus.events.recovered(BusEventKind::sample_lost, ops.topic, "deaf");
  }

  void on_data_available(dds::DataReader* from) override {
    if (bus.samples_as) carry_samples(*bus.samples_as);
    const std::lock_guard lock(handler_mutex);
    dds::SampleInfo info;
    while (!closed && done(from->take_next_sample(&slot, &info))) {
      const WriterGuid guid = to_guid(info.sample_identity.writer_guid());
      bus.hearing->heard(this, guid);
      if (!info.valid_data) continue;  // an instance ended
      if (!slot.valid) {
        const std::string name = bus.peers.name(guid);
        bus.events.report(BusEventKind::invalid_sample, ops.topic, name,
                          name + " sent bytes that are no " + ops.type_name);
        continue;
      }
      handler(slot.sample, {guid, info.source_timestamp.to_ns(), info.reception_timestamp.to_ns()});
      if (requested.deadline_ns != kForever) track_deadline(info.instance_handle, guid);
    }
  }

  void on_subscription_matched(dds::DataReader*, const dds::SubscriptionMatchedStatus& status) override {
    if (closed) return;
    WriterGuid guid{};
    for (std::size_t i = 0; i < guid.size(); ++i) guid[i] = status.last_publication_handle.value[i];
    {
      const std::lock_guard lock(mutex);
      if (status.current_count_change > 0) {
        writers.insert(guid);
      } else {
        writers.erase(guid);
      }
      matched = static_cast<int>(writers.size());
    }
    if (status.current_count_change > 0) {
      bus.hearing->matched(this, guid);
      bus.writer_matched(guid, ops.topic);
    } else {
      bus.hearing->unmatched(this, guid);
      bus.writer_unmatched(guid, ops.topic);
    }
  }

  void on_requested_deadline_missed(dds::DataReader*,
                                    const dds::RequestedDeadlineMissedStatus& status) override {
    std::string key;
    WriterGuid guid{};
    {
      const std::lock_guard lock(mutex);
      const auto found = instances.find(status.last_instance_handle);
      // A writer that left owes nothing any more; that it was lost is reported as such.
      if (found == instances.end() || !writers.contains(found->second.writer)) return;
      found->second.missed = true;
      key = found->second.key;
      guid = found->second.writer;
    }
    bus.events.report(
        BusEventKind::deadline_missed, ops.topic, key,
        bus.peers.name(guid) + " sent nothing about " + key + " for " + duration_text(requested.deadline_ns),
        status.total_count_change);
  }

  void on_requested_incompatible_qos(dds::DataReader*,
                                     const dds::RequestedIncompatibleQosStatus& status) override {
    const Policy policy = policy_of(status.last_policy_id);
    std::set<std::string> writers_in_conflict = bus.peers.writers_in_conflict(ops.topic, policy, requested);
    if (writers_in_conflict.empty()) writers_in_conflict.insert("another participant");
    auto occurrences = static_cast<std::uint64_t>(status.total_count_change);
    for (const std::string& name : writers_in_conflict) {
      bus.events.report(BusEventKind::incompatible_qos, ops.topic, name + " writes, " + to_string(policy),
                        "the writer of " + name + " offers another " + to_string(policy) +
                            " than this reader requests (" + value_text(policy, requested) + ")",
                        std::exchange(occurrences, 0));
    }
  }

  void on_sample_lost(dds::DataReader*, const dds::SampleLostStatus& status) override {
    bus.events.report(BusEventKind::sample_lost, ops.topic, "",
                      "samples did not arrive and are no longer to be had",
                      static_cast<std::uint64_t>(status.total_count_change));
  }

  void on_sample_rejected(dds::DataReader*, const dds::SampleRejectedStatus& status) override {
    bus.hearing->refused(this);
    bus.events.report(BusEventKind::resource_limit, ops.topic, "",
                      "this reader has no room for more samples or keys", status.total_count_change);
  }

  struct Instance {
    std::string key;
    WriterGuid writer{};
    bool missed = false;
  };

  /// Remembers whose sample an instance was last, and notices recovery. Called with slot filled.
  void track_deadline(const InstanceHandle_t& handle, const WriterGuid& guid) {
    std::string key;
    {
      const std::lock_guard lock(mutex);
      Instance& instance = instances[handle];
      if (instance.key.empty()) instance.key = ops.key_text(slot.sample);
      instance.writer = guid;
      if (!instance.missed) return;
      instance.missed = false;
      key = instance.key;
    }
    bus.events.recovered(BusEventKind::deadline_missed, ops.topic, key);
  }

  Participant::Impl& bus;
  const TopicOps& ops;
  const dds::DataReaderQos qos;
  const QosSummary requested;
  std::atomic<bool> closed = false;
  std::atomic<int> matched = 0;

  std::mutex handler_mutex;  // held while samples are handed over
  Handler handler;
  SampleSlot slot;

  std::mutex mutex;  // of what follows
  std::set<WriterGuid> writers;
  std::map<InstanceHandle_t, Instance> instances;

  dds::DataReader* reader = nullptr;
  std::optional<std::chrono::steady_clock::time_point> renewed;
};

ReaderCore::ReaderCore(Participant& participant, const TopicOps& ops, Handler handler,
                       const ReaderOptions& options)
    : impl_(std::make_unique<Impl>(participant.impl(), ops, std::move(handler), options)) {}
ReaderCore::~ReaderCore() = default;
int ReaderCore::matched_writers() const {
  return impl_->matched;
}

}  // namespace fathom::bus::detail
