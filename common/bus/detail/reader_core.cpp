#include "bus/detail/reader_core.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <mutex>
#include <optional>
#include <set>
#include <span>
#include <utility>

#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/DataReaderListener.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>

#include "base/clock.hpp"
#include "bus/detail/arrival_of.hpp"
#include "bus/detail/in_order.hpp"
#include "bus/detail/key_deadlines.hpp"
#include "bus/detail/lost_samples.hpp"
#include "bus/detail/participant_impl.hpp"
#include "bus/detail/qos/conflicts.hpp"
#include "bus/detail/qos/profiles.hpp"
#include "bus/detail/sample_type.hpp"
#include "bus/detail/workarounds/dds_log.hpp"
#include "bus/detail/workarounds/take_pace.hpp"
#include "bus/reader.hpp"

namespace fathom::bus::detail {
using rtps::InstanceHandle_t;

namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

constexpr std::chrono::seconds kRest(30);              // from one renewal of a reader to the next
constexpr DurationNs kSlowest_ns = 10 * kNsPerSecond;  // the longest deadline that a reader follows

enum Work : int { kRenew, kHandOver, kHandOverAtLast, kFollow, kTakeMore };  // of the WorkQueue

}  // namespace

struct ReaderCore::Impl final : dds::DataReaderListener {
  using Deadlines = KeyDeadlines<InstanceHandle_t>;

  Impl(Participant::Impl& bus_in, const TopicOps& ops_in, Handler handler_in, const ReaderOptions& options_in,
       bool raw_in)
      : bus(bus_in),
        ops(ops_in),
        place{ops_in, raw_in},
        follows(!options_in.deadline_ns),
        options(options_in),
        qos(reader_qos(*bus.subscriber, ops.topic, options)),
        handler(std::move(handler_in)),
        requested(summarise(qos.reliability(), qos.durability(), qos.deadline(), qos.ownership(),
                            qos.liveliness())),
        counts(requested.reliability > 0 && qos.durability().kind == dds::VOLATILE_DURABILITY_QOS &&
               requested.ownership == dds::SHARED_OWNERSHIP_QOS) {
    slot.sample = place.create();
    slot.raw = raw_in;
    if (!make()) {
      end();
      throw BusError("reader of " + std::string(ops.topic) + ": Fast DDS could not create it" +
                     bus.why_not(ops.topic));
    }
    bus.check_types(ops.topic);
  }

  ~Impl() override { end(); }

  /// A callback may ask for work until Fast DDS has given its reader up.
  void end() {
    {
      const std::lock_guard lock(reader_mutex);
      ended = true;
    }
    bus.delivery_watch->leave(this);
    close();
    bus.work_queue.forget(this);
    place.destroy()(slot.sample);
  }

  /// Fast DDS calls back before it has returned the reader that it makes: work that such a call asks for
  /// waits until the reader is known. Without that it would make a second one, and one of the two would be
  /// left behind, which still calls back when we are gone.
  void later(int kind, std::function<void()> work, milliseconds delay = milliseconds(0)) {
    const auto locked = [this, work = std::move(work)] {
      const std::lock_guard lock(reader_mutex);
      if (!ended) work();
    };
    bus.work_queue.run(this, locked, kind, delay);
  }

  /// The first one. False: Fast DDS made none.
  bool make() {
    const std::lock_guard lock(reader_mutex);
    open();
    return reader != nullptr;
  }

  /// Precondition: reader_mutex held.
  void open() {
    dds::StatusMask mask = dds::StatusMask::data_available();
    mask << dds::StatusMask::subscription_matched() << dds::StatusMask::requested_deadline_missed()
         << dds::StatusMask::requested_incompatible_qos() << dds::StatusMask::sample_lost()
         << dds::StatusMask::sample_rejected();
    dds::Topic* topic = bus.topic(ops);
    closed = false;
    // Joined before Fast DDS knows it, for writers may be matched at once.
    bus.delivery_watch->join(this, requested.ownership == dds::EXCLUSIVE_OWNERSHIP_QOS,
                             [this] { later(kRenew, [this] { renew(); }); });
    reader = bus.subscriber->create_datareader(topic, qos, this, mask);
    if (reader == nullptr) return bus.delivery_watch->leave(this);
    const WriterGuid guid = to_guid(reader->guid());
    bus.delivery_watch->is_entity(this, to_entity_id(std::span(guid).subspan(12)));
  }

  /// Whoever is in the handler now is waited for; whoever comes later sees `closed`.
  void close() {
    closed = true;
    { const std::scoped_lock wait(handler_mutex, mutex); }
    if (reader == nullptr) return;
    reader->set_listener(nullptr);
    bus.subscriber->delete_datareader(reader);
    reader = nullptr;
  }

  /// Another Fast DDS reader in the place of one that hands nothing over. Not too often, for whoever can make
  /// a reader deaf may go on doing so, and the topic's other writers have to find the new one.
  void renew() {
    const auto now = steady_clock::now();
    if (renewed && now - *renewed < kRest) return;
    renewed = now;
    replace();
    bus.events.report(
        BusEventKind::sample_lost, ops.topic, "deaf",
        reader == nullptr
            ? "samples came in and were not handed over, and no other reader could be made" + last_dds_error()
            : "samples came in and were not handed over: another reader was made");
    bus.events.recovered(BusEventKind::sample_lost, ops.topic, "deaf");
  }

  /// Precondition: reader_mutex held. `reader` is null where no other one could be made.
  void replace() {
    bus.delivery_watch->leave(this);
    close();
    {
      const std::lock_guard lock(mutex);
      order.all_unmatched();
      lost.clear();
      writers.clear();
      deadlines.clear();
      matched = 0;
    }
    {
      const std::lock_guard lock(handler_mutex);
      while (const auto held = next_held()) hand_over(*held, held->sample.get());
    }
    open();
  }

  /// Where nobody asked for a deadline, a reader requests no more than the topic's slowest writer promises:
  /// a fusion whose inertial unit is slow publishes less often than the profile presumes, and would have no
  /// reader at all. False: there is no such writer. The deadline doubles at least, so that nobody can make a
  /// reader begin anew without end.
  bool follow_slowest() {
    if (!follows) return false;
    const QosSummary now = wants();
    const DurationNs offered = bus.peers.longest_deadline(ops.topic, kSlowest_ns);
    if (offered <= now.deadline_ns) return false;
    const auto follow = [this, deadline_ns = std::max(offered, 2 * now.deadline_ns)] {
      {
        const std::lock_guard lock(mutex);
        requested.deadline_ns = deadline_ns;
      }
      options.deadline_ns = deadline_ns;
      qos = reader_qos(*bus.subscriber, ops.topic, options);
      replace();
      if (reader == nullptr) {
        bus.events.report(BusEventKind::incompatible_qos, ops.topic, "deadline",
                          "no reader could be made that requests no more than is offered" + last_dds_error());
      }
    };
    later(kFollow, follow);
    return true;
  }

  QosSummary wants() {
    const std::lock_guard lock(mutex);
    return requested;
  }

  void on_data_available(dds::DataReader* from) override {
    if (bus.samples_as) carry_samples(*bus.samples_as);
    receive(from);
  }

  /// Fast DDS holds its reader while it calls back, and to take a sample that reader is needed: who calls
  /// back does not wait for who takes. Whoever is taking looks again.
  void receive(dds::DataReader* from) {
    arrived = true;
    while (arrived && !pace.rests(steady_clock::now()) && handler_mutex.try_lock()) {
      const std::lock_guard lock(handler_mutex, std::adopt_lock);
      arrived = false;
      take_all(*from);
    }
  }

  /// Precondition: handler_mutex held.
  void take_all(dds::DataReader& from) {
    dds::SampleInfo info;
    auto began = steady_clock::now();
    for (; !closed && done(from.take_next_sample(&slot, &info)); began = steady_clock::now()) {
      const WriterGuid guid = to_guid(info.sample_identity.writer_guid());
      bus.delivery_watch->heard(this, guid);
      const Arrival arrival = arrival_of(guid, info);
      lost.taken(guid, arrival.place.number);
      if (!info.valid_data) continue;  // an instance ended
      if (!slot.valid) {
        const std::string name = bus.peers.name(guid);
        bus.events.report(BusEventKind::invalid_sample, ops.topic, name,
                          name + " sent bytes that are no " + ops.type_name);
        continue;
      }
      const Held now{
          {guid, info.source_timestamp.to_ns(), info.reception_timestamp.to_ns()}, info.instance_handle, {}};
      if (is_next(arrival, now)) hand_over(now, slot.sample);
    }
    const auto rest = pace.found_nothing(began, steady_clock::now());
    if (rest.count() > 0) hand_over_later(kTakeMore, rest);
    if (const std::uint64_t number = closed ? 0 : lost.settle(); number > 0) report_lost(number);
    hand_over_held();
  }

  void report_lost(std::uint64_t number) {
    bus.events.report(BusEventKind::sample_lost, ops.topic, "",
                      "samples are lost: not kept long enough by their writer, or not taken in time", number);
  }

  /// A sample, or what is known of one.
  struct Held {
    SampleInfo info;
    InstanceHandle_t instance;
    std::shared_ptr<void> sample;
  };

  /// False: the sample in the slot comes after others that have not arrived, and is kept for later.
  bool is_next(const Arrival& arrival, const Held& held) {
    const std::lock_guard lock(mutex);
    if (order.may_pass(arrival)) return true;
    Held kept = held;
    kept.sample = {slot.sample, place.destroy()};
    slot.sample = place.create();
    order.keep(arrival, std::move(kept), clock.monotonic_ns());
    return false;
  }

  /// Precondition: handler_mutex held.
  void hand_over(const Held& held, const void* sample) {
    handler(sample, held.info);
    const std::lock_guard lock(mutex);
    if (requested.deadline_ns == kForever) return;
    const auto text = [&] { return place.key_text(sample); };
    const auto recovered = deadlines.heard(held.instance, held.info.writer_guid, text);
    if (recovered) bus.events.recovered(BusEventKind::deadline_missed, ops.topic, *recovered);
  }

  /// Those kept for later whose turn has come. Precondition: handler_mutex held, and all that has arrived was
  /// taken.
  void hand_over_held() {
    while (!closed) {
      const auto held = next_held();
      if (!held) break;
      hand_over(*held, held->sample.get());
    }
    const std::lock_guard lock(mutex);
    constexpr milliseconds kAtLast(InOrder<Held>::kMost_ns / kNsPerMillisecond);
    if (order.keeps()) hand_over_later(kHandOverAtLast, kAtLast);
  }

  std::optional<Held> next_held() {
    const std::lock_guard lock(mutex);
    order.settle();
    return order.keeps() ? order.next(clock.monotonic_ns()) : std::nullopt;
  }

  void hand_over_later(int task, milliseconds delay) {
    const auto work = [this] {
      if (reader != nullptr) receive(reader);
    };
    later(task, work, delay);
  }

  void on_subscription_matched(dds::DataReader*, const dds::SubscriptionMatchedStatus& status) override {
    if (closed) return;
    WriterGuid guid{};
    for (std::size_t i = 0; i < guid.size(); ++i) guid[i] = status.last_publication_handle.value[i];
    {
      const std::lock_guard lock(mutex);
      if (status.current_count_change > 0) {
        writers.insert(guid);
        order.matched(guid);
      } else {
        writers.erase(guid);
        order.unmatched(guid);
      }
      matched = static_cast<int>(writers.size());
      if (order.keeps()) hand_over_later(kHandOver, milliseconds(0));
    }
    if (status.current_count_change > 0) {
      if (counts) lost.matched(guid);
      bus.delivery_watch->matched(this, guid);
      bus.writer_matched(guid, ops.topic);
    } else {
      lost.unmatched(guid);
      bus.delivery_watch->unmatched(this, guid);
      bus.writer_unmatched(guid, ops.topic);
    }
  }

  void on_requested_deadline_missed(dds::DataReader*,
                                    const dds::RequestedDeadlineMissedStatus& status) override {
    DurationNs deadline_ns = 0;
    std::optional<Deadlines::Key> key;
    {
      const std::lock_guard lock(mutex);
      deadline_ns = requested.deadline_ns;
      // A writer that left owes nothing any more; that it was lost is reported as such.
      const auto owes = [&](const WriterGuid& writer) { return writers.contains(writer); };
      key = deadlines.missed(status.last_instance_handle, owes);
    }
    if (!key) return;
    bus.events.report(BusEventKind::deadline_missed, ops.topic, key->text,
                      bus.peers.name(key->writer) + " sent nothing about " + key->text + " for " +
                          duration_text(deadline_ns),
                      status.total_count_change);
  }

  void on_requested_incompatible_qos(dds::DataReader*,
                                     const dds::RequestedIncompatibleQosStatus& status) override {
    const Policy policy = policy_of(status.last_policy_id);
    if (closed || (policy == Policy::deadline && follow_slowest())) return;
    const QosSummary now = wants();
    std::set<std::string> writers_in_conflict = bus.peers.writers_in_conflict(ops.topic, policy, now);
    if (writers_in_conflict.empty()) writers_in_conflict.insert("another participant");
    report_conflicts(bus.events, ops.topic, writers_in_conflict, policy, now, true,
                     static_cast<std::uint64_t>(status.total_count_change));
  }

  void on_sample_lost(dds::DataReader*, const dds::SampleLostStatus& status) override {
    if (!counts) report_lost(static_cast<std::uint64_t>(status.total_count_change));
  }

  void on_sample_rejected(dds::DataReader*, const dds::SampleRejectedStatus& status) override {
    bus.delivery_watch->refused(this);
    bus.events.report(BusEventKind::resource_limit, ops.topic, "",
                      "this reader has no room for more samples or keys", status.total_count_change);
  }

  Participant::Impl& bus;
  const TopicOps& ops;
  const SamplePlace place;
  const SystemClock clock;
  const bool follows;      // the deadline is the topic's slowest writer's
  ReaderOptions options;   // of whoever holds reader_mutex
  dds::DataReaderQos qos;  // likewise
  std::atomic<bool> closed = false;
  std::atomic<int> matched = 0;

  std::atomic<bool> arrived = false;  // something that nobody has looked at
  std::mutex handler_mutex;           // held while samples are taken and handed over
  Handler handler;
  SampleSlot slot;
  TakePace pace;
  LostSamples lost;

  std::mutex mutex;  // of what follows
  QosSummary requested;
  const bool counts;  // what is lost, by the samples' numbers; else Fast DDS does, as far as it can
  std::set<WriterGuid> writers;
  Deadlines deadlines;
  InOrder<Held> order;

  std::mutex reader_mutex;  // taken before the other two; of what follows, as long as work may be left
  bool ended = false;
  dds::DataReader* reader = nullptr;
  std::optional<steady_clock::time_point> renewed;
};

ReaderCore::ReaderCore(Participant& participant, const TopicOps& ops, Handler handler,
                       const ReaderOptions& options, bool raw)
    : impl_(std::make_unique<Impl>(participant.impl(), ops, std::move(handler), options, raw)) {}
ReaderCore::~ReaderCore() = default;
int ReaderCore::matched_writers() const {
  return impl_->matched;
}

}  // namespace fathom::bus::detail
