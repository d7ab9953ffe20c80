#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <set>
#include <shared_mutex>
#include <thread>
#include <utility>

#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/DataWriterListener.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>

#include "bus/detail/dds_log.hpp"
#include "bus/detail/endpoint.hpp"
#include "bus/detail/participant_impl.hpp"
#include "bus/detail/qos.hpp"
#include "bus/detail/sample_type.hpp"
#include "bus/detail/scheduling.hpp"

namespace fathom::bus::detail {
namespace {

using std::chrono::milliseconds;

// How long a writer's end may wait for its readers: two heartbeats of the profiles and the answer.
constexpr std::uint32_t kLastWords_ns = 150'000'000;

// How long the readers of a writer have to find its successor, and how long all the same after that: that
// they are known here is no proof that they know it.
constexpr milliseconds kToBeFound(5000);
constexpr milliseconds kToBeSure(1000);

// Where one writer is heard at a time, how long the successor's first sample may wait for the last of the old
// one to have arrived: what comes after it is not heard. Less than the deadline of a navigation state.
constexpr std::uint32_t kToArrive_ns = 15'000'000;

}  // namespace

struct WriterCore::Impl final : dds::DataWriterListener {
  Impl(Participant::Impl& bus_in, const TopicOps& ops_in, const WriterOptions& options_in)
      : bus(bus_in),
        ops(ops_in),
        type(ops_in),
        options(options_in),
        qos(writer_qos(*bus.publisher, ops.topic, options)),
        offered(summarise(qos.reliability(), qos.durability(), qos.deadline(), qos.ownership(),
                          qos.liveliness())),
        successors(qos.reliability().kind == dds::RELIABLE_RELIABILITY_QOS &&
                   qos.durability().kind == dds::VOLATILE_DURABILITY_QOS && options.successor_after > 0) {
    writer = create();
    if (writer == nullptr) {
      throw BusError("writer of " + std::string(ops.topic) + ": Fast DDS could not create it" +
                     bus.why_not(ops.topic));
    }
    bus.check_types(ops.topic);
  }

  ~Impl() override {
    closing = true;
    bus.errands.forget(this);
    retire(writer);
  }

  [[nodiscard]] bool exclusive() const { return qos.ownership().kind == dds::EXCLUSIVE_OWNERSHIP_QOS; }

  dds::DataWriter* create() {
    dds::StatusMask mask = dds::StatusMask::publication_matched();
    mask << dds::StatusMask::offered_incompatible_qos();
    if (!options.may_rest) mask << dds::StatusMask::offered_deadline_missed();
    dds::DataWriterQos one = qos;
    // Of two that are as strong the one with the lower identity is heard: the successor, from its first
    // sample.
    if (successors && exclusive()) {
      one.endpoint().entity_id = bus.next_lower_id();
    }
    return bus.publisher->create_datawriter(bus.topic(ops), one, this, mask);
  }

  void retire(dds::DataWriter* old) {
    if (old == nullptr) return;
    // The news that a writer left travels apart from its samples and may overtake the last of them, which the
    // reader would then ignore. A reader that died is not waited for any longer.
    if (offered.reliability > 0) old->wait_for_acknowledgments({0, kLastWords_ns});
    old->set_listener(nullptr);
    // What a dead reader never took would be released one by one while the heartbeat still walks over it,
    // which may then never end (Fast DDS 2.9.1).
    std::size_t removed = 0;
    old->clear_history(&removed);
    bus.publisher->delete_datawriter(old);
  }

  static int readers_of(dds::DataWriter& of) {
    dds::PublicationMatchedStatus status;
    of.get_publication_matched_status(status);
    return status.current_count;
  }

  /// False when this writer is about to go.
  [[nodiscard]] bool wait(milliseconds most, const std::function<bool()>& enough) const {
    const auto end = std::chrono::steady_clock::now() + most;
    while (!closing && !enough() && std::chrono::steady_clock::now() < end) {
      std::this_thread::sleep_for(milliseconds(20));
    }
    return !closing;
  }

  /// Another Fast DDS writer goes on in the place of this one (WriterOptions::successor_after).
  void succeed() {
    dds::DataWriter* next = create();
    if (next == nullptr) return;  // the old one is as good, but for those who come anew
    const auto found = [&] { return readers_of(*next) >= matched; };
    if (!wait(kToBeFound, found) || !found() || !wait(kToBeSure, [] { return false; })) return retire(next);
    dds::DataWriter* old = nullptr;
    {
      const std::unique_lock lock(writer_mutex);
      if (exclusive()) writer.load()->wait_for_acknowledgments({0, kToArrive_ns});
      old = writer.exchange(next);
    }
    old->set_listener(nullptr);
    do {
      matched = readers_of(*next);
    } while (matched != readers_of(*next));
    retire(old);
  }

  void on_publication_matched(dds::DataWriter* of, const dds::PublicationMatchedStatus& status) override {
    const dds::DataWriter* const current = writer;
    if (current == nullptr || of == current) matched = status.current_count;
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
    if (bus.samples_as) ask_for_short_turns();
    SampleSlot slot{const_cast<void*>(sample), true};
    bool written = false;
    {
      const std::shared_lock lock(writer_mutex);
      written = done(writer.load()->write(&slot));
    }
    if (successors && ++count % options.successor_after == 0) {
      bus.errands.run(this, [this] { succeed(); });
    }
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
  const WriterOptions options;
  const dds::DataWriterQos qos;
  const QosSummary offered;
  const bool successors;
  std::atomic<bool> closing = false;
  std::atomic<std::uint64_t> count = 0;
  std::atomic<int> matched = 0;
  std::atomic<bool> failed = false;
  std::mutex mutex;
  std::map<std::string, Instance> instances;
  std::shared_mutex writer_mutex;  // the writer does not change while it is held
  std::atomic<dds::DataWriter*> writer = nullptr;
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
WriterGuid WriterCore::guid() const {
  const std::shared_lock lock(impl_->writer_mutex);
  return to_guid(impl_->writer.load()->guid());
}

}  // namespace fathom::bus::detail
