#include "bus/detail/writer_core.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <shared_mutex>
#include <thread>
#include <utility>
#include <vector>

#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/DataWriterListener.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>

#include "bus/detail/participant_impl.hpp"
#include "bus/detail/qos/conflicts.hpp"
#include "bus/detail/qos/profiles.hpp"
#include "bus/detail/sample_type.hpp"
#include "bus/detail/topic_ops.hpp"
#include "bus/detail/workarounds/dds_log.hpp"
#include "bus/detail/workarounds/scheduling.hpp"
#include "bus/writer.hpp"

namespace fathom::bus::detail {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

// How long a writer's end waits for its readers at least: two heartbeats of the profiles and the answer.
constexpr DurationNs kLastWords_ns = 150 * kNsPerMillisecond;

// What is done about a successor is looked at so often.
constexpr milliseconds kLook(50);

// For so long everybody who reads has to have been heard without a break before the successor begins: that
// its readers are known here is no proof that they know it. Discovery repeats what was lost after a second.
constexpr milliseconds kToBeSure(2500);
constexpr DurationNs kBreak_ns = 600 * kNsPerMillisecond;  // each says something every 400 ms

// Where one writer is heard at a time, nothing of the old one may be under way when the successor begins, for
// it would not be heard any more. So long an instant is waited for at which that is so by itself; after that
// the successor's first sample has to wait, now and then and for half a deadline at most.
constexpr milliseconds kByItself(5000);
constexpr DurationNs kMayWait_ns = 15 * kNsPerMillisecond;

// Somebody who never says that it got anything does not keep a successor away for ever.
constexpr milliseconds kPatience(60'000);

// How long the news that a writer left takes to a reader, where nothing is lost.
constexpr milliseconds kToBeGone(3);

// How long a reader that requests a shorter deadline than is offered has, to follow.
constexpr milliseconds kToFollow(2000);

// WorkQueue, beside what is done about a successor.
constexpr int kConflict = 1;

// How long the old one is kept: until all it wrote has arrived, or is too old to be had (the profiles'
// depth), and at least until the successor is heard.
constexpr milliseconds kDepth(5000);
constexpr milliseconds kToBeHeard(1000);

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
    bus.work_queue.forget(this);
    if (const DurationNs patience_ns = bus.patience_ns; offered.reliability > 0 && patience_ns > 0) {
      const auto began = steady_clock::now();
      (void)all_arrived(*writer.load(), patience_ns);
      bus.patience_ns -= std::chrono::nanoseconds(steady_clock::now() - began).count();
    }
    retire(old);
    retire(next);
    retire(writer);
    bus.work_queue.forget(this);  // what a callback asked for meanwhile
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
    // reader would then ignore.
    if (offered.reliability > 0) (void)all_arrived(*old, kLastWords_ns);
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

  static bool all_arrived(dds::DataWriter& of, DurationNs within_ns) {
    const auto [seconds, rest_ns] = std::lldiv(within_ns, kNsPerSecond);
    return done(of.wait_for_acknowledgments(
        {static_cast<std::int32_t>(seconds), static_cast<std::uint32_t>(rest_ns)}));
  }

  using Step = void (Impl::*)();
  void then(Step step, milliseconds delay = kLook) {
    if (!closing)
      bus.work_queue.run(
          this, [this, step] { (this->*step)(); }, 0, delay);
  }

  /// Another Fast DDS writer goes on in the place of this one (WriterOptions::successor_after). First step;
  /// the old one is as good, but for those who come anew, so that nothing of this has to succeed.
  void begin_succession() {
    next = create();
    if (next == nullptr) {
      succeeding = false;
      return;
    }
    began = calm_since = steady_clock::now();
    then(&Impl::await_successor);
  }

  void await_successor() {
    const auto now = steady_clock::now();
    if (readers_of(*next) < matched || !everybody_is_heard()) calm_since = now;
    const bool at_last = now - began >= kPatience;
    if (!at_last && now - calm_since < kToBeSure) return then(&Impl::await_successor);
    const bool by_itself = !at_last && now - calm_since < kToBeSure + kByItself;
    if (!(exclusive() ? take_over_at_rest(by_itself, at_last) : take_over())) {
      return then(&Impl::await_successor);
    }
    if (old != nullptr) old->set_listener(nullptr);
    do {
      matched = readers_of(*writer.load());
    } while (matched != readers_of(*writer.load()));
    changed_at = steady_clock::now();
    then(&Impl::await_end_of_old);
  }

  void await_end_of_old() {
    const auto age = steady_clock::now() - changed_at;
    const bool is_done = old == nullptr || (age >= kToBeHeard && all_arrived(*old, 0));
    if (!is_done && age < kDepth) return then(&Impl::await_end_of_old);
    {
      const std::unique_lock lock(writer_mutex);
      predecessor = rtps::SampleIdentity::unknown();
    }
    retire(std::exchange(old, nullptr));
    succeeding = false;
  }

  [[nodiscard]] bool everybody_is_heard() {
    const std::lock_guard lock(mutex);
    bool all = true;  // each is asked about, or it would never count
    for (const WriterGuid& reader : readers) {
      const GuidPrefix of = prefix_of(reader);
      const bool own = of == prefix_of(to_guid(next->guid()));
      all = (own || bus.delivery_watch->is_heard(of, kBreak_ns)) && all;
    }
    return all;
  }

  /// What the old one has under way arrives beside what the successor writes, which says what it comes after.
  bool take_over() {
    const std::unique_lock lock(writer_mutex);
    predecessor.writer_guid(writer.load()->guid()).sequence_number(newest());
    change();
    return true;
  }

  bool take_over_at_rest(bool by_itself, bool at_last) {
    constexpr DurationNs kChance_ns = 100 * kNsPerMillisecond;
    if (by_itself && !all_arrived(*writer.load(), kChance_ns)) return false;
    const std::unique_lock lock(writer_mutex);
    const DurationNs may_wait_ns = std::min(kMayWait_ns, offered.deadline_ns / 2);
    if (!all_arrived(*writer.load(), by_itself ? 0 : may_wait_ns) && !at_last) return false;
    const bool is_lower = next->guid().entityId < writer.load()->guid().entityId;
    change();
    if (is_lower) return true;
    // The ids have begun anew: the old one is the stronger of the two as long as it is there.
    old->set_listener(nullptr);
    retire(std::exchange(old, nullptr));
    std::this_thread::sleep_for(kToBeGone);
    return true;
  }

  /// Precondition: writer_mutex held.
  void change() {
    old = writer.exchange(std::exchange(next, nullptr));
    newest_number = 0;
  }

  [[nodiscard]] rtps::SequenceNumber_t newest() const {
    const std::uint64_t number = newest_number;
    return {static_cast<std::int32_t>(number >> 32U), static_cast<std::uint32_t>(number)};
  }

  void on_publication_matched(dds::DataWriter* of, const dds::PublicationMatchedStatus& status) override {
    const dds::DataWriter* const current = writer;
    const bool of_current = current == nullptr || of == current;
    if (of_current) matched = status.current_count;
    WriterGuid reader{};
    for (std::size_t i = 0; i < reader.size(); ++i) reader[i] = status.last_subscription_handle.value[i];
    const std::lock_guard lock(mutex);
    if (status.current_count_change > 0) {
      readers.insert(reader);
    } else if (of_current) {
      readers.erase(reader);
    }
  }

  void on_offered_incompatible_qos(dds::DataWriter*,
                                   const dds::OfferedIncompatibleQosStatus& status) override {
    const Policy policy = policy_of(status.last_policy_id);
    const auto occurrences = static_cast<std::uint64_t>(status.total_count_change);
    if (policy != Policy::deadline) return report_conflict(policy, occurrences, "another participant");
    // Our readers follow a longer deadline than they presumed, which is no conflict.
    const auto work = [this, occurrences] { report_conflict(Policy::deadline, occurrences); };
    if (!closing) bus.work_queue.run(this, work, kConflict, kToFollow);
  }

  /// `whoever`: who is named where discovery knows nobody; empty: nobody, the conflict is over.
  void report_conflict(Policy policy, std::uint64_t occurrences, const std::string& whoever = {}) {
    std::set<std::string> readers = bus.peers.readers_in_conflict(ops.topic, policy, offered);
    if (readers.empty() && !whoever.empty()) readers.insert(whoever);
    report_conflicts(bus.events, ops.topic, readers, policy, offered, false, occurrences);
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

  /// The number of a sample, among those of its writer; several threads may write.
  void note(std::uint64_t number) {
    std::uint64_t known = newest_number;
    while (number > known && !newest_number.compare_exchange_weak(known, number)) {
    }
  }

  bool write(const void* sample, const std::vector<std::uint8_t>* wire = nullptr) {
    if (bus.samples_as) ask_for_short_turns();
    SampleSlot slot;
    slot.sample = const_cast<void*>(sample);
    slot.wire = wire;
    bool written = false;
    {
      const std::shared_lock lock(writer_mutex);
      rtps::WriteParams with;
      with.related_sample_identity(predecessor);
      written = done(writer.load()->write(&slot, with));
      if (written) note(static_cast<std::uint64_t>(with.sample_identity().sequence_number().to64long()));
    }
    if (successors && ++count % options.successor_after == 0 && !succeeding.exchange(true)) {
      then(&Impl::begin_succession, milliseconds(0));
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
  std::set<WriterGuid> readers;    // matched
  std::shared_mutex writer_mutex;  // the writer does not change while it is held
  std::atomic<dds::DataWriter*> writer = nullptr;
  std::atomic<std::uint64_t> newest_number = 0;  // of its samples
  /// The last sample of the old one, while that is there; else unknown.
  rtps::SampleIdentity predecessor = rtps::SampleIdentity::unknown();

  // Of the work_queue.
  std::atomic<bool> succeeding = false;
  dds::DataWriter* next = nullptr;  // created, and not writing yet
  dds::DataWriter* old = nullptr;   // no longer writing
  steady_clock::time_point began;
  steady_clock::time_point calm_since;
  steady_clock::time_point changed_at;
};

WriterCore::WriterCore(Participant& participant, const TopicOps& ops, const WriterOptions& options)
    : impl_(std::make_unique<Impl>(participant.impl(), ops, options)) {}
WriterCore::~WriterCore() = default;
bool WriterCore::write(const void* sample) {
  return impl_->write(sample);
}
bool WriterCore::write_raw(std::vector<std::uint8_t> bytes) {
  const TopicOps& ops = impl_->ops;
  const std::unique_ptr<void, void (*)(void*)> sample(ops.create(), ops.destroy);
  return decode(ops, bytes, sample.get()) && impl_->write(sample.get(), &bytes);
}
int WriterCore::matched_readers() const {
  return impl_->matched;
}
WriterGuid WriterCore::guid() const {
  const std::shared_lock lock(impl_->writer_mutex);
  return to_guid(impl_->writer.load()->guid());
}

}  // namespace fathom::bus::detail
