#include <atomic>
#include <cstddef>
#include <cstdint>
#include <map>
#include <mutex>
#include <set>
#include <utility>

#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/DataWriterListener.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>

#include "bus/detail/dds_log.hpp"
#include "bus/detail/endpoint.hpp"
#include "bus/detail/participant_impl.hpp"
#include "bus/detail/qos.hpp"
#include "bus/detail/sample_type.hpp"

namespace fathom::bus::detail {
namespace {

// How long a writer's end may wait for its readers: two heartbeats of the profiles and the answer.
constexpr std::uint32_t kLastWords_ns = 150'000'000;

}  // namespace

struct WriterCore::Impl final : dds::DataWriterListener {
  Impl(Participant::Impl& bus_in, const TopicOps& ops_in, const WriterOptions& options)
      : bus(bus_in), ops(ops_in), type(ops_in) {
    dds::Topic* topic = bus.topic(ops);
    const dds::DataWriterQos qos = writer_qos(*bus.publisher, ops.topic, options);
    offered =
        summarise(qos.reliability(), qos.durability(), qos.deadline(), qos.ownership(), qos.liveliness());
    dds::StatusMask mask = dds::StatusMask::publication_matched();
    mask << dds::StatusMask::offered_incompatible_qos();
    if (!options.may_rest) mask << dds::StatusMask::offered_deadline_missed();
    writer = bus.publisher->create_datawriter(topic, qos, this, mask);
    if (writer == nullptr) {
      throw BusError("writer of " + std::string(ops.topic) + ": Fast DDS could not create it" +
                     bus.why_not(ops.topic));
    }
    guid = to_guid(writer->guid());
    bus.check_types(ops.topic);
  }

  ~Impl() override {
    if (writer == nullptr) return;
    // The news that a writer left travels apart from its samples and may overtake the last of them, which the
    // reader would then ignore. A reader that died is not waited for any longer.
    if (offered.reliability > 0) writer->wait_for_acknowledgments({0, kLastWords_ns});
    writer->set_listener(nullptr);
    // What a dead reader never took would be released one by one while the heartbeat still walks over it,
    // which may then never end (Fast DDS 2.9.1).
    std::size_t removed = 0;
    writer->clear_history(&removed);
    bus.publisher->delete_datawriter(writer);
  }

  void on_publication_matched(dds::DataWriter*, const dds::PublicationMatchedStatus& status) override {
    matched = status.current_count;
  }

  void on_offered_incompatible_qos(dds::DataWriter*,
                                   const dds::OfferedIncompatibleQosStatus& status) override {
    const Policy policy = policy_of(status.last_policy_id);
    std::set<std::string> readers = bus.peers.readers_in_conflict(ops.topic, policy, offered);
    if (readers.empty()) readers.insert("another participant");
    auto occurrences = static_cast<std::uint64_t>(status.total_count_change);
    for (const std::string& name : readers) {
      bus.events.report(BusEventKind::incompatible_qos, ops.topic, name + " reads, " + to_string(policy),
                        "the reader of " + name + " requests another " + to_string(policy) +
                            " than this writer offers (" + value_text(policy, offered) + ")",
                        std::exchange(occurrences, 0));
    }
  }

  void on_offered_deadline_missed(dds::DataWriter*, const dds::OfferedDeadlineMissedStatus& status) override {
    const std::string key = missed(status.last_instance_handle);
    bus.events.report(
        BusEventKind::deadline_missed, ops.topic, "own:" + key,
        "this service wrote nothing about " + key + " for " + duration_text(offered.deadline_ns),
        status.total_count_change);
  }

  struct Instance {
    rtps::InstanceHandle_t handle;
    bool missed = false;
  };

  /// Remembers which key the handle of a deadline stands for, and notices recovery.
  void track_deadline(const SampleSlot& slot) {
    const std::string key = ops.key_text(slot.sample);
    {
      const std::lock_guard lock(mutex);
      const auto [found, is_new] = instances.try_emplace(key);
      if (is_new) found->second.handle = type.handle_of(&slot);
      if (!found->second.missed) return;
      found->second.missed = false;
    }
    bus.events.recovered(BusEventKind::deadline_missed, ops.topic, "own:" + key);
  }

  std::string missed(const rtps::InstanceHandle_t& handle) {
    const std::lock_guard lock(mutex);
    for (auto& [key, instance] : instances) {
      if (instance.handle == handle) {
        instance.missed = true;
        return key;
      }
    }
    return "an unknown key";
  }

  bool write(const void* sample) {
    SampleSlot slot{const_cast<void*>(sample), true};
    const bool written = done(writer->write(&slot));
    if (offered.deadline_ns != kForever) track_deadline(slot);  // nobody waits for this
    if (written) {
      if (failed.exchange(false)) bus.events.recovered(BusEventKind::write_failed, ops.topic, "");
    } else {
      failed = true;
      bus.events.report(BusEventKind::write_failed, ops.topic, "",
                        "a sample about " + ops.key_text(sample) +
                            " found no room in the writer's history, or its readers did not keep up");
    }
    return written;
  }

  Participant::Impl& bus;
  const TopicOps& ops;
  SampleType type;  // for keys only; Fast DDS owns its own
  QosSummary offered;
  WriterGuid guid{};
  std::atomic<int> matched = 0;
  std::atomic<bool> failed = false;
  std::mutex mutex;
  std::map<std::string, Instance> instances;
  dds::DataWriter* writer = nullptr;
};

WriterCore::WriterCore(Participant& participant, const TopicOps& ops, const WriterOptions& options)
    : impl_(std::make_unique<Impl>(participant.impl(), ops, options)) {}
WriterCore::~WriterCore() = default;
bool WriterCore::write(const void* sample) {
  return impl_->write(sample);
}
int WriterCore::matched_readers() const {
  return impl_->matched;
}
const WriterGuid& WriterCore::guid() const {
  return impl_->guid;
}

}  // namespace fathom::bus::detail
