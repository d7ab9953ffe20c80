#include "fusion/replica/link.hpp"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include "bus/reader.hpp"
#include "bus/writer.hpp"
#include "fusion/replica/leader_watch.hpp"
#include "fusion/replica/replica.hpp"
#include "fusion/replica/state_parts.hpp"

namespace fathom::fusion {
namespace {

constexpr DurationNs kTick_ns = 50 * kNsPerMillisecond;
constexpr DurationNs kTell_ns = 200 * kNsPerMillisecond;
constexpr DurationNs kGive_ns = 500 * kNsPerMillisecond;
constexpr double kSilenceOfListening =
    0.4;  // the silence of a known leader shows sooner than the lack of any leader
constexpr DurationNs kQuarrel_ns = 2 * kNsPerSecond;
constexpr DurationNs kLeastGap_ns = 100 * kNsPerMillisecond;
constexpr DurationNs kLate_ns = 250 * kNsPerMillisecond;
constexpr DurationNs kHold_ns = 2 * kNsPerSecond;
constexpr DurationNs kHoldSilence_ns = 100 * kNsPerMillisecond;
constexpr DurationNs kLeaderPatience_ns = 2 * kNsPerSecond;  // of the host: ten accounts
constexpr int kSaidAfterTicks = 6;                           // a shorter state is a hiccup of the scheduler

/// Options in vehicle time, as the clock runs. On the host they are never shorter, because its scheduling is
/// no faster in an accelerated run.
Replica::Options replica_options(const Clock& clock, const config::FusionConfig& config) {
  const double rate = std::max(1.0, clock.rate());
  const auto at_least = [rate](DurationNs host_ns) {
    return static_cast<DurationNs>(static_cast<double>(host_ns) * rate);
  };
  const DurationNs period_ns = from_seconds(1.0 / config.engine.imu.nominal_rate_hz);
  Replica::Options out;
  out.listen_ns = at_least(from_seconds(config.standby.listen_s));
  out.silence_ns = at_least(from_seconds(kSilenceOfListening * config.standby.listen_s));
  out.quarrel_ns = at_least(kQuarrel_ns);
  out.gap_ns = at_least(std::max(kLeastGap_ns, 3 * period_ns));
  out.late_ns = at_least(kLate_ns);
  out.pause_ns = 3 * period_ns;  // the deadline of the navigation state
  out.hold_ns = at_least(kHold_ns);
  out.hold_silence_ns = at_least(std::max(kHoldSilence_ns, 6 * period_ns));
  out.strength = config.ownership_strength;
  return out;
}

bus::ReaderOptions heard_options(const host::ServiceHost& host, const config::FusionConfig& config) {
  bus::ReaderOptions options;
  options.deadline_ns = host.host_duration(from_seconds(3.0 / config.engine.imu.nominal_rate_hz));
  options.profile_suffix = "deep";  // each state is compared
  return options;
}

}  // namespace

struct ReplicaLink::Impl {
  Impl(host::ServiceHost& the_host, const config::FusionConfig& config, archive::CheckpointLabel the_label,
       Hooks the_hooks)
      : host(the_host),
        label(std::move(the_label)),
        strength(config.ownership_strength),
        hooks(std::move(the_hooks)),
        replica(replica_options(host.clock(), config), host.clock().monotonic_ns()),
        accounts(host.participant()),
        states(host.participant()),
        peers(host.participant(),
              [this](const ReplicaStatus& peer, const bus::SampleInfo& info) { on_told(peer, info); }),
        heard(
            host.participant(),
            [this](const NavState& state, const bus::SampleInfo& info) { on_heard(state, info); },
            heard_options(host, config)) {}

  ~Impl() { end(); }

  void end() {
    {
      const std::lock_guard lock(thread_mutex);
      stop = true;
    }
    wake.notify_all();
    if (thread.joinable()) thread.join();
    taker.reset();  // whoever takes a state over is waited for
  }

  [[nodiscard]] bool mine(const SampleHeader& header) const { return header.sensor == Name(host.name()); }

  void on_told(const ReplicaStatus& peer, const bus::SampleInfo& info) {
    if (peer.header.vehicle != Name(label.vehicle)) return;
    const std::lock_guard lock(mutex);
    if (mine(peer.header)) {
      if (info.writer_guid != accounts.guid()) namesake_ns = host.clock().monotonic_ns();
      return;
    }
    replica.told(peer, host.clock().monotonic_ns());
    leader.told(peer, info.writer_guid, steady.monotonic_ns());
  }

  void on_heard(const NavState& state, const bus::SampleInfo& info) {
    if (state.header.vehicle != Name(label.vehicle)) return;
    const std::lock_guard lock(mutex);
    replica.heard(state, mine(state.header), host.clock().monotonic_ns());
    if (!mine(state.header)) leader.heard(state.header.sensor, info.writer_guid, steady.monotonic_ns());
  }

  void run() {
    std::unique_lock lock(thread_mutex);
    TimeNs told_ns = 0;
    TimeNs gave_ns = 0;
    while (!stop) {
      lock.unlock();
      const TimeNs now_ns = steady.monotonic_ns();
      look();
      if (now_ns - told_ns >= kTell_ns) {
        told_ns = now_ns;
        tell();
      }
      if (states.matched_readers() > 0 && now_ns - gave_ns >= kGive_ns) {
        gave_ns = now_ns;
        give();
      }
      lock.lock();
      wake.wait_for(lock, std::chrono::nanoseconds(kTick_ns), [this] { return stop; });
    }
  }

  /// Finds what changed, logs it, and asks for the leader's state when it is wanted.
  void look() {
    ReplicaPhase phase{};
    bool leads = false;
    bool wants = false;
    std::string text;
    {
      const std::lock_guard lock(mutex);
      // Its own writer is one of the matched ones.
      replica.others(std::max(0, heard.matched_writers() - 1), host.clock().monotonic_ns());
      phase = replica.phase();
      leads = replica.leads();
      wants = replica.wants_state();
      text = describe();
    }
    if (wants && !taker) {
      ask();
    } else if (!wants && taker) {
      taker.reset();
      hooks.keep_arrivals(false);
    }
    if (leads != led) {
      led = leads;
      tell();  // before a state is given, because the others take one only from a known leader
      if (leads) hooks.leads_now();
      host.publish_status_soon();
    }
    lasted = text == seen ? lasted + 1 : 0;
    seen = text;
    if (text == said || lasted < kSaidAfterTicks) return;
    said = text;
    host.log().write(phase == ReplicaPhase::behind ? runtime::LogLevel::warning : runtime::LogLevel::info,
                     text);
  }

  /// Asks for the leader's state: the leader sends it to every reader of the topic of states.
  void ask() {
    hooks.keep_arrivals(true);
    try {
      taker.emplace(host.participant(), [this](const EngineStatePart& part, const bus::SampleInfo& info) {
        on_part(part, info);
      });
    } catch (const bus::BusError& error) {
      hooks.keep_arrivals(false);
      refuse("the leader", std::string("cannot be asked for: ") + error.what());  // until the next tick
    }
  }

  /// Precondition: mutex held.
  [[nodiscard]] std::string describe() const {
    if (has_namesake()) {
      return "another fusion is called " + host.name() +
             " as well: neither can tell their states apart, expected an "
             "instance name of its own for each";
    }
    switch (replica.phase()) {
      case ReplicaPhase::listening:
        return "listening for another fusion";
      case ReplicaPhase::behind:
        return "behind " + replica.leader().str() + ": " + replica.reason() + "; catching up";
      case ReplicaPhase::in_step:
        break;
    }
    return replica.leads() ? "leading" : "standing by, in step with " + replica.leader().str();
  }

  /// Precondition: mutex held.
  [[nodiscard]] bool has_namesake() const {
    return namesake_ns && host.clock().monotonic_ns() - *namesake_ns < 3 * kTell_ns;
  }

  void tell() {
    ReplicaStatus status;
    status.header = host.header();
    status.header.sequence = ++sequence;
    status.ownership_strength = strength;
    {
      const std::lock_guard lock(mutex);
      status.phase = replica.phase();
      status.in_step_s = to_seconds(replica.in_step_ns(host.clock().monotonic_ns()));
      status.leads = replica.leads();
      status.missed = replica.missed();
      status.caught_up = replica.times_caught_up();
      status.unprepared = replica.times_unprepared();
    }
    accounts.write(status);
  }

  void give() {
    EngineStatePart part;
    {
      const std::lock_guard lock(mutex);
      if (!replica.leads()) return;
      part.missed = replica.missed();
    }
    if (!hooks.save(state)) return;
    encode(state, archive);
    archive::CheckpointLabel stamped = label;
    stamped.stamp_ns = state.stamp_ns;
    encode(stamped, archive, bytes);
    part.header = host.header();
    part.header.stamp_ns = state.stamp_ns;
    part.header.sequence = parts_sent;
    part.transfer = ++transfers;
    const bool small = send_in_parts(part, bytes, [this](const EngineStatePart& one) {
      parts_sent = one.header.sequence;
      states.write(one);
    });
    if (!small) host.log().error("the state is too large to be given to another fusion");
  }

  void on_part(const EngineStatePart& part, const bus::SampleInfo& info) {
    if (part.header.vehicle != Name(label.vehicle) || mine(part.header)) return;
    const std::string from = part.header.sensor.str();
    {
      std::unique_lock lock(mutex);
      const auto objection = leader.objection(part.header.sensor, info.writer_guid, steady.monotonic_ns());
      lock.unlock();
      if (objection.forged) return refuse(from, objection.why, true);
      if (!objection.why.empty()) return;
    }
    auto whole = assembler.add(part, info.writer_guid);
    if (!whole) return;
    auto found = archive::decode(whole->bytes);
    if (!found) return refuse(from, found.error().message, true);
    found.value().label.service = label.service;  // another instance of the same service
    // The age of the state does not matter. The comparison with the leader's states follows afterwards.
    archive::CheckpointLabel own = label;
    own.stamp_ns = found.value().label.stamp_ns;
    const std::string why = objection(found.value().label, own, 0.0);
    if (!why.empty()) return refuse(from, why);
    const auto shared = decode_shared(found.value().archive);
    if (!shared) return refuse(from, shared.error().message, true);
    {
      const std::lock_guard lock(mutex);
      if (!replica.wants_state()) return;
    }
    const Restored taken = hooks.restore(shared.value(), part.header.sensor);
    if (!taken.error.empty()) return refuse(from, taken.error, taken.unsound);
    {
      const std::lock_guard lock(mutex);
      replica.caught_up(whole->head.missed);
    }
    host.log().info("took the state of " + from + ", " + taken.text);
  }

  /// `unsound`: the state is forged or broken, and not only useless here.
  void refuse(const std::string& from, const std::string& why, bool unsound = false) {
    const std::string text = "the state of " + from + " " + why;
    const std::lock_guard lock(mutex);
    if (unsound) ++states_refused;
    if (std::exchange(refused, text) != text) host.log().warning(text);
  }

  host::ServiceHost& host;
  const archive::CheckpointLabel label;
  const std::int32_t strength;
  Hooks hooks;
  const SystemClock steady;

  mutable std::mutex mutex;  // guards what follows up to the thread's own
  Replica replica;
  LeaderWatch leader{kLeaderPatience_ns};
  std::uint64_t states_refused = 0;
  std::string refused;
  std::optional<TimeNs> namesake_ns;  ///< when another service of the same name was last heard

  // Of the thread.
  std::string said;
  std::string seen;
  int lasted = 0;  ///< ticks
  bool led = false;
  std::uint64_t sequence = 0;
  std::uint64_t transfers = 0;
  std::uint64_t parts_sent = 0;
  SharedState state;
  std::vector<std::byte> archive;
  std::vector<std::byte> bytes;

  StateAssembler assembler;  // of the reader of parts

  bus::Writer<ReplicaStatus> accounts;
  bus::Writer<EngineStatePart> states;
  bus::Reader<ReplicaStatus> peers;
  bus::Reader<NavState> heard;
  std::optional<bus::Reader<EngineStatePart>> taker;  // of the thread: exists while a state is wanted

  std::mutex thread_mutex;
  std::condition_variable wake;
  bool stop = false;
  std::thread thread;  // last: it uses everything above
};

ReplicaLink::ReplicaLink(host::ServiceHost& host, const config::FusionConfig& config,
                         archive::CheckpointLabel label, Hooks hooks)
    : impl_(std::make_unique<Impl>(host, config, std::move(label), std::move(hooks))) {}
ReplicaLink::~ReplicaLink() = default;

void ReplicaLink::begin() {
  impl_->thread = std::thread([impl = impl_.get()] { impl->run(); });
}

void ReplicaLink::end() {
  impl_->end();
}

bool ReplicaLink::own(const NavState& state) {
  const std::lock_guard lock(impl_->mutex);
  return impl_->replica.own(state, impl_->host.clock().monotonic_ns());
}

void ReplicaLink::missed(std::uint64_t count) {
  const std::lock_guard lock(impl_->mutex);
  impl_->replica.missed(count, impl_->host.clock().monotonic_ns());
}

bool ReplicaLink::leads() const {
  const std::lock_guard lock(impl_->mutex);
  return impl_->replica.leads();
}

bool ReplicaLink::in_step() const {
  const std::lock_guard lock(impl_->mutex);
  return impl_->replica.phase() == ReplicaPhase::in_step;
}

void ReplicaLink::fill(ServiceStatus& status) const {
  const std::lock_guard lock(impl_->mutex);
  const Replica& replica = impl_->replica;
  status.text += (status.text.empty() ? "" : "; ") + impl_->describe();
  if (!impl_->refused.empty() && replica.wants_state()) status.text += "; " + impl_->refused;
  const bool unfit = replica.wants_state() || impl_->has_namesake();
  if (unfit && status.state == ServiceState::healthy) status.state = ServiceState::degraded;
  status.counters.push_back({"missed_samples", replica.missed()});
  status.counters.push_back({"caught_up", replica.times_caught_up()});
  status.counters.push_back({"unprepared", replica.times_unprepared()});
  status.counters.push_back({"state_refused", impl_->states_refused});
}

}  // namespace fathom::fusion
