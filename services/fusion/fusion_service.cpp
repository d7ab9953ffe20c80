#include "fusion/fusion_service.hpp"

#include <algorithm>
#include <functional>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "archive/checkpoint.hpp"
#include "archive/digest.hpp"
#include "bus/reader.hpp"
#include "bus/writer.hpp"
#include "estimation/engine/fusion_engine.hpp"
#include "fusion/checkpoint/build_name.hpp"
#include "fusion/checkpoint/keeper.hpp"
#include "fusion/checkpoint/start.hpp"
#include "fusion/intake/arrival.hpp"
#include "fusion/intake/intake.hpp"
#include "fusion/intake_publisher.hpp"
#include "fusion/life_sign.hpp"
#include "fusion/order_answers.hpp"
#include "fusion/replica/link.hpp"
#include "fusion/verdict_publisher.hpp"

namespace fathom::fusion {
namespace {

bus::WriterOptions nav_state_options(const host::ServiceHost& host, const config::FusionConfig& config) {
  bus::WriterOptions options;
  options.deadline_ns = host.host_duration(from_seconds(3.0 / config.engine.imu.nominal_rate_hz));
  options.ownership_strength = config.ownership_strength;
  options.may_rest = config.standby.enabled;
  return options;
}

// Longer than the scheduler keeps a bridge that is there, shorter than one takes to start again. Of the host.
constexpr DurationNs kImuSilence_ns = 200 * kNsPerMillisecond;

bus::WriterOptions slow_options(const config::FusionConfig& config) {
  bus::WriterOptions options;
  options.may_rest = config.standby.enabled;  // the one that leads speaks for both
  return options;
}

archive::CheckpointLabel label_of(host::ServiceHost& host) {
  return {host.common().vehicle, host.name(), host.config_hash(), build_of_this_executable(),
          host.clock().utc_ns()};
}

/// An engine that is ready for the first sample, and how it came to its state.
struct Started {
  estimation::FusionEngine engine;
  Resumption resumption;
  TimeNs begins_ns = 0;  ///< UTC, of the given state; 0: none, or the instant of the first sample
};

Started started(host::ServiceHost& host, const config::FusionConfig& config,
                const archive::CheckpointLabel& own) {
  Started out{estimation::FusionEngine(config::engine_config(config)), {}};
  out.resumption = resume(out.engine, config.checkpoint, own);
  host.log().write(out.resumption.refused ? runtime::LogLevel::warning : runtime::LogLevel::info,
                   out.resumption.how);
  if (out.resumption.resumed || !config::starts_from_state(config.start.mode)) return out;
  const estimation::InitialState given = config::initial_state(config);
  out.begins_ns = given.stamp_ns;
  if (const std::string wait = wait_for(out.begins_ns, own.stamp_ns); !wait.empty()) host.log().warning(wait);
  out.engine.start_from(given);
  return out;
}

}  // namespace

struct FusionService::Impl {
  Impl(host::ServiceHost& the_host, const config::FusionConfig& config)
      : host(the_host),
        vehicle(config.common.vehicle),
        label(label_of(the_host)),
        intake(vehicle, Name(config.imu_sensor),
               static_cast<DurationNs>(static_cast<double>(kImuSilence_ns) *
                                       std::max(1.0, the_host.clock().rate()))),
        start(started(the_host, config, label)),
        nav_states(host.participant(), nav_state_options(host, config)),
        details(host.participant(), slow_options(config)),
        alignments(host.participant(), slow_options(config)),
        forecasts(host.participant(), slow_options(config)),
        taken(host, mutex, start.resumption),
        link(replica_link(config)),
        verdicts(host, mutex, engine, link ? [this] { return speaks(); } : std::function<bool()>()),
        aiding_readers(listen_to_aiding()),
        commands(host.participant(),
                 [this](const Command& command, const bus::SampleInfo&) { on_command(command); }),
        imu(host.participant(), arrivals_of<ImuSample>()) {
    if (link) link->begin();
    host.on_tick(kNsPerSecond, [this] { publish_slow(); });
    host.on_status([this](ServiceStatus& status) { fill(status); });
    if (!config.checkpoint.path.empty()) {
      keeper.emplace(
          config.checkpoint, label, host.log(),
          [this](TimeNs& stamp_ns, std::vector<std::byte>& archive) { return save(stamp_ns, archive); });
    }
  }

  std::unique_ptr<ReplicaLink> replica_link(const config::FusionConfig& config) {
    if (!config.standby.enabled) return nullptr;
    archive::CheckpointLabel shared = label;
    shared.configuration = config::estimation_hash(config);
    return std::make_unique<ReplicaLink>(host, config, std::move(shared), replica_hooks());
  }

  ~Impl() {
    host.on_tick(kNsPerSecond, [] {});
    host.on_status([](ServiceStatus&) {});
    // What the engine still holds back is judged later by the next start, from the checkpoint, or by another
    // fusion service. Without both it is judged now.
    if (!keeper && !link) {
      {
        const std::lock_guard lock(mutex);
        ended = true;
        engine.finish();
        taken.add_end();
      }
      verdicts.publish();
    }
    taken.publish(true);
  }

  /// All that aids or informs; the inertial unit is heard last.
  std::vector<std::shared_ptr<void>> listen_to_aiding() {
    std::vector<std::shared_ptr<void>> readers;
    for_each_kind([&](auto kind) {
      using T = typename decltype(kind)::Sample;
      if constexpr (kind.kUse != Use::integrated)
        readers.push_back(std::make_shared<bus::Reader<T>>(host.participant(), arrivals_of<T>()));
    });
    return readers;
  }

  /// Handler of a reader: makes each sample an arrival.
  template <class T>
  typename bus::Reader<T>::Handler arrivals_of() {
    return [this](const T& sample, const bus::SampleInfo& info) {
      take({sample, info.writer_guid, Name(host.participant().writer_name(info.writer_guid)),
            host.clock().monotonic_ns()});
    };
  }

  /// Gives an arrival to the engine. True when there is a new navigation state. Mutex held.
  bool give(const Arrival& arrival) {
    return std::visit(
        [&]<class T>(const T& sample) {
          if constexpr (std::is_same_v<T, ImuSample>) {
            return engine.add(sample);
          } else {
            engine.add(sample, arrival.writer);
            return false;
          }
        },
        arrival.sample);
  }

  void take(const Arrival& arrival) {
    NavState state;
    bool fresh = false;
    std::optional<AlignmentStatus> alignment;
    Intake::Answer answer;
    std::vector<estimation::OrderOutcome> outcomes;
    {
      const std::lock_guard lock(mutex);
      if (ended) return;
      answer = intake.take(arrival);
      if (answer.fate == Intake::Fate::taken) {
        if (arrival.source() == SourceKind::imu) verdicts.set_imu_writer(arrival.writer);
        fresh = give(arrival);
        taken.add(arrival);
        if (fresh) {
          state = engine.nav_state();
          newest_nav_state_ns = host.clock().monotonic_ns();
          if (std::exchange(phase, state.alignment) != state.alignment) engine.fill(alignment.emplace());
        }
        for (estimation::OrderOutcome one; engine.next_outcome(one);) outcomes.push_back(one);
      }
    }
    if (answer.fate == Intake::Fate::other_vehicle) return;
    if (answer.fate == Intake::Fate::other_imu) return refuse(arrival);
    orders.tell(outcomes);
    if (link && answer.missed > 0) link->missed(answer.missed);
    if (fresh && (!link || link->own(state))) {
      nav_states.write(state);
      const std::lock_guard lock(mutex);
      ++counts.nav_states;
    }
    if (alignment) {
      if (speaks()) alignments.write(*alignment);
      host.log().info("alignment: " + std::string(to_string(alignment->phase)));
    }
    verdicts.publish();
    taken.publish();
  }

  /// Inertial samples of another unit, or of another writer of this unit, are never integrated. They get a
  /// verdict.
  void refuse(const Arrival& arrival) {
    Verdict verdict;
    verdict.header = arrival.header();
    verdict.source = arrival.source();
    verdict.kind = verdict.previous = VerdictKind::source_disabled;
    verdict.is_final = true;
    verdict.writer = arrival.writer;
    verdicts.publish(verdict);
  }

  void on_command(const Command& command) {
    if (command.header.vehicle != vehicle || command.kind == CommandKind::acknowledge_alarm) return;
    std::string objection;
    {
      const std::lock_guard lock(mutex);
      ++counts.commands;
      intake.take(command);
      objection = engine.apply(command);
      taken.add(command);
    }
    if (!objection.empty()) orders.refuse(command, objection);
  }

  bool save(TimeNs& stamp_ns, std::vector<std::byte>& archive) {
    if (link && !link->in_step()) return false;  // the checkpoint on the disk may be better
    {
      const std::lock_guard lock(mutex);
      if (!engine.save(archive)) return false;
      stamp_ns = engine.nav_state().header.stamp_ns;
    }
    taken.publish(true);  // whoever goes on from the state can be proved, also when this process dies now
    return true;
  }

  void publish_slow() {
    taken.publish(true);
    NavDetail detail;
    AlignmentStatus alignment;
    Forecast forecast;
    if (!speaks()) return;
    const std::lock_guard one_forecast(forecast_mutex);
    {
      const std::lock_guard lock(mutex);
      if (newest_nav_state_ns == 0) return;
      engine.fill(detail);
      engine.fill(alignment);
      engine.take_forecast();
    }
    engine.fill_taken(forecast);  // milliseconds: navigation goes on meanwhile
    details.write(detail);
    alignments.write(alignment);
    forecasts.write(forecast);
  }

  void fill(ServiceStatus& status) {
    LifeSign::Moment moment;
    {
      const std::lock_guard lock(mutex);
      counts.verdicts = verdicts.figures();
      counts.intake = intake.counts();
      moment = {counts, newest_nav_state_ns, phase, intake.imu_unit(), start.resumption.how};
      moment.begins_ns = start.begins_ns;
      moment.newest_stamp_ns = newest_nav_state_ns == 0 ? 0 : engine.nav_state().header.stamp_ns;
    }
    moment.orders = orders.figures();
    if (keeper) moment.checkpoints = keeper->counts();
    life_sign.fill(moment, host.clock(), status);
    if (link) link->fill(status);
  }

  // The engine is given again what has arrived since the state was saved. The service that saved it has
  // published the verdicts and outcomes.
  ReplicaLink::Restored restore(const SharedState& state, const Name& from) {
    const std::lock_guard lock(mutex);
    if (intake.imu_unit() != state.imu_sensor) {
      return {"", "is of inertial unit " + state.imu_sensor.str() + ", and this one listens to " +
                      intake.imu_unit().str()};
    }
    if (std::string why = gap_between(state, intake.log()); !why.empty())
      return {"", "does not reach this one: " + why};
    if (std::string why = engine.restore(state.archive); !why.empty()) return {"", "is none: " + why, true};
    start.begins_ns = 0;
    taken.add_state(state.stamp_ns, archive::digest(state.archive), from);
    for (const Command& order : intake.log().orders()) {
      (void)engine.apply(order);
      taken.add(order, true);
    }
    intake.go_on_from(state.last);
    int told_again = 0;
    const auto leave_verdicts = [&] {
      for (Verdict verdict; engine.next_verdict(verdict);) continue;
    };
    leave_verdicts();
    for (const Arrival& arrival : intake.log().arrivals()) {
      const bool known = arrival.source() == SourceKind::imu &&
                         arrival.header().stamp_ns <= engine.nav_state().header.stamp_ns;
      if (known) continue;
      give(arrival);
      taken.add(arrival, true);
      ++told_again;
      leave_verdicts();
    }
    for (estimation::OrderOutcome outcome; engine.next_outcome(outcome);) continue;
    verdicts.begin_anew();
    phase = engine.nav_state().alignment;
    return {"and " + std::to_string(told_again) + " samples since", ""};
  }

  bool share(SharedState& state) {
    {
      const std::lock_guard lock(mutex);
      state.archive.clear();
      if (!engine.save(state.archive)) return false;
      state.stamp_ns = engine.nav_state().header.stamp_ns;
      state.imu_sensor = intake.imu_unit();
      state.last = intake.last();
    }
    taken.publish(true);  // as in save()
    return true;
  }

  [[nodiscard]] ReplicaLink::Hooks replica_hooks() {
    ReplicaLink::Hooks hooks;
    hooks.save = [this](SharedState& state) { return share(state); };
    hooks.restore = [this](const SharedState& state, const Name& from) { return restore(state, from); };
    hooks.keep_arrivals = [this](bool on) {
      const std::lock_guard lock(mutex);
      intake.keep(on);
    };
    hooks.leads_now = [this] { publish_slow(); };
    return hooks;
  }

  // Of several fusion services the one that leads publishes for all of them. Each one publishes its own
  // navigation state, and DDS chooses.
  [[nodiscard]] bool speaks() const { return !link || link->leads(); }

  host::ServiceHost& host;
  const Name vehicle;
  const archive::CheckpointLabel label;

  std::mutex forecast_mutex;  // guards the taken forecast; locked before the other mutex
  std::mutex mutex;           // guards what follows up to the writers
  Intake intake;
  Started start;
  estimation::FusionEngine& engine = start.engine;
  LifeSign::Counts counts;
  AlignmentPhase phase = AlignmentPhase::none;
  TimeNs newest_nav_state_ns = 0;

  bool ended = false;

  OrderAnswers orders{host.log(), host.clock()};
  LifeSign life_sign;  // used by the thread of the life sign only

  bus::Writer<NavState> nav_states;
  bus::Writer<NavDetail> details;
  bus::Writer<AlignmentStatus> alignments;
  bus::Writer<Forecast> forecasts;
  IntakePublisher taken;

  std::unique_ptr<ReplicaLink> link;  // none where this is the only fusion
  VerdictPublisher verdicts;
  // The link ends here: its hooks use everything above.
  const std::unique_ptr<ReplicaLink, void (*)(ReplicaLink*)> link_end{link.get(),
                                                                      [](auto* it) { it->end(); }};

  // Readers end first: their handlers use everything above.
  std::vector<std::shared_ptr<void>> aiding_readers;
  bus::Reader<Command> commands;
  bus::Reader<ImuSample> imu;

  std::optional<CheckpointKeeper> keeper;  // ends first of all, with a last checkpoint
};

FusionService::FusionService(host::ServiceHost& host, const config::FusionConfig& config)
    : impl_(std::make_unique<Impl>(host, config)) {}

FusionService::~FusionService() = default;

}  // namespace fathom::fusion
