#include "fusion/fusion_service.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <mutex>
#include <optional>
#include <span>
#include <string>

#include "bus/reader.hpp"
#include "bus/writer.hpp"
#include "estimation/fusion_engine.hpp"
#include "fusion/arrival_book.hpp"
#include "fusion/checkpoint.hpp"
#include "fusion/checkpoint_keeper.hpp"

namespace fathom::fusion {
namespace {

// What the life sign counts; guarded by the engine's mutex.
struct Counts {
  std::array<std::uint64_t, kVerdictKinds> verdicts{};
  std::uint64_t imu_samples = 0;
  std::uint64_t nav_states = 0;
  std::uint64_t other_vehicle = 0;
  std::uint64_t commands = 0;
};

constexpr SourceKind source_of(const GpsSample&) {
  return SourceKind::gps;
}
constexpr SourceKind source_of(const DvlSample&) {
  return SourceKind::dvl;
}
constexpr SourceKind source_of(const DepthSample&) {
  return SourceKind::depth;
}
constexpr SourceKind source_of(const HeadingSample&) {
  return SourceKind::heading;
}
constexpr SourceKind source_of(const UsblSample&) {
  return SourceKind::usbl;
}
constexpr SourceKind source_of(const AirspeedSample&) {
  return SourceKind::airspeed;
}
constexpr SourceKind source_of(const PropulsionSample&) {
  return SourceKind::propulsion;
}
constexpr SourceKind source_of(const FinsSample&) {
  return SourceKind::fins;
}

bus::WriterOptions nav_state_options(const host::ServiceHost& host, const config::FusionConfig& config) {
  bus::WriterOptions options;
  options.deadline_ns = host.host_duration(from_seconds(3.0 / config.engine.imu.nominal_rate_hz));
  options.ownership_strength = config.ownership_strength;
  return options;
}

CheckpointLabel label_of(host::ServiceHost& host) {
  return {host.common().vehicle, host.name(), host.config_hash(), build_of_this_executable(),
          host.clock().utc_ns()};
}

/// An engine that is ready for the first sample, and how it came to its state.
struct Started {
  estimation::FusionEngine engine;
  std::string how;
};

Started started(host::ServiceHost& host, const config::FusionConfig& config, const CheckpointLabel& own) {
  Started out{estimation::FusionEngine(config::engine_config(config)), "started afresh"};
  const config::CheckpointConfig& kept = config.checkpoint;
  if (!kept.path.empty()) {
    const auto refuse = [&](const std::string& why) { out.how += ": checkpoint " + kept.path + " " + why; };
    const auto bytes = read_file(kept.path);
    const auto found = bytes ? decode(bytes.value()) : Result<Checkpoint>(bytes.error());
    if (!found) {
      refuse(found.error().message);
    } else if (const std::string why = objection(found.value().label, own, kept.max_age_s); !why.empty()) {
      refuse(why);
    } else if (!out.engine.restore(found.value().image)) {
      refuse("holds no state of this engine");
    } else {
      std::array<char, 96> text{};
      std::snprintf(text.data(), text.size(), "resumed from a checkpoint %.2f s old",
                    to_seconds(own.stamp_ns - found.value().label.stamp_ns));
      out.how = text.data();
      host.log().info(out.how);
      return out;
    }
  }
  host.log().info(out.how);
  if (config::starts_from_state(config.start.mode)) out.engine.start_from(config::initial_state(config));
  return out;
}

}  // namespace

struct FusionService::Impl {
  Impl(host::ServiceHost& the_host, const config::FusionConfig& config)
      : host(the_host),
        vehicle(config.common.vehicle),
        label(label_of(the_host)),
        imu_sensor(config.imu_sensor),
        start(started(the_host, config, label)),
        nav_states(host.participant(), nav_state_options(host, config)),
        details(host.participant()),
        verdicts(host.participant()),
        alignments(host.participant()),
        forecasts(host.participant()),
        gps(host.participant(), aiding<GpsSample>()),
        dvl(host.participant(), aiding<DvlSample>()),
        depth(host.participant(), aiding<DepthSample>()),
        heading(host.participant(), aiding<HeadingSample>()),
        usbl(host.participant(), aiding<UsblSample>()),
        airspeed(host.participant(), aiding<AirspeedSample>()),
        propulsion(host.participant(), aiding<PropulsionSample>()),
        fins(host.participant(), aiding<FinsSample>()),
        commands(host.participant(),
                 [this](const Command& command, const bus::SampleInfo&) { on_command(command); }),
        imu(host.participant(),
            [this](const ImuSample& sample, const bus::SampleInfo& info) { on_imu(sample, info); }) {
    host.on_tick(kNsPerSecond, [this] { publish_slow(); });
    host.on_status([this](ServiceStatus& status) { fill(status); });
    if (!config.checkpoint.path.empty()) {
      keeper.emplace(
          config.checkpoint, label, host.log(),
          [this](TimeNs& stamp_ns, std::vector<std::byte>& image) { return save(stamp_ns, image); });
    }
  }

  ~Impl() {
    host.on_tick(kNsPerSecond, [] {});
    host.on_status([](ServiceStatus&) {});
  }

  template <class T>
  typename bus::Reader<T>::Handler aiding() {
    return [this](const T& sample, const bus::SampleInfo& info) {
      {
        const std::lock_guard lock(mutex);
        if (sample.header.vehicle != vehicle) {
          ++counts.other_vehicle;
          return;
        }
        arrivals.note(source_of(sample), sample.header, info.writer_guid);
        engine.add(sample);
      }
      publish_verdicts();
    };
  }

  void on_imu(const ImuSample& sample, const bus::SampleInfo& info) {
    NavState state;
    bool fresh = false;
    AlignmentStatus alignment;
    bool alignment_changed = false;
    bool other_unit = false;
    {
      const std::lock_guard lock(mutex);
      if (sample.header.vehicle != vehicle) {
        ++counts.other_vehicle;
        return;
      }
      if (imu_sensor.empty()) imu_sensor = sample.header.sensor;
      other_unit = sample.header.sensor != imu_sensor;
    }
    if (other_unit) return refuse_other_unit(sample, info);
    {
      const std::lock_guard lock(mutex);
      imu_writer = info.writer_guid;
      ++counts.imu_samples;
      fresh = engine.add(sample);
      if (fresh) {
        state = engine.nav_state();
        ++counts.nav_states;
        newest_nav_state_ns = host.clock().monotonic_ns();
        alignment_changed = state.alignment != phase;
        phase = state.alignment;
        if (alignment_changed) engine.fill(alignment);
      }
    }
    if (fresh) nav_states.write(state);
    if (alignment_changed) {
      alignments.write(alignment);
      host.log().info("alignment: " + std::string(to_string(alignment.phase)));
    }
    publish_verdicts();
  }

  // A second unit never mixes with the first: its samples are judged, not integrated.
  void refuse_other_unit(const ImuSample& sample, const bus::SampleInfo& info) {
    Verdict verdict;
    verdict.header = sample.header;
    verdict.source = SourceKind::imu;
    verdict.kind = VerdictKind::source_disabled;
    verdict.writer = Name(host.participant().writer_name(info.writer_guid));
    {
      const std::lock_guard lock(mutex);
      ++counts.verdicts[static_cast<std::size_t>(verdict.kind)];
    }
    verdicts.write(verdict);
  }

  void on_command(const Command& command) {
    if (command.header.vehicle != vehicle || command.kind == CommandKind::acknowledge_alarm) return;
    bool applied = false;
    {
      const std::lock_guard lock(mutex);
      ++counts.commands;
      applied = engine.apply(command);
    }
    const std::string text = "command " + std::string(to_string(command.kind)) + " " + command.target.str() +
                             " from " + command.header.sensor.str();
    if (applied) {
      host.log().info(text + ": applied");
    } else {
      host.log().warning(text + ": refused, it names nothing known or lacks a number");
    }
  }

  bool save(TimeNs& stamp_ns, std::vector<std::byte>& image) {
    const std::lock_guard lock(mutex);
    if (!engine.save(image)) return false;
    stamp_ns = engine.nav_state().header.stamp_ns;
    return true;
  }

  // Takes the verdicts out in batches, so that the engine is not held while they are written.
  void publish_verdicts() {
    std::array<Verdict, 32> batch;
    std::size_t count = 0;
    do {
      count = 0;
      {
        const std::lock_guard lock(mutex);
        while (count < batch.size() && engine.next_verdict(batch[count])) {
          Verdict& verdict = batch[count++];
          ++counts.verdicts[static_cast<std::size_t>(verdict.kind)];
          const auto writer =
              verdict.source == SourceKind::imu ? std::optional(imu_writer) : arrivals.writer_of(verdict);
          if (writer) verdict.writer = Name(host.participant().writer_name(*writer));
        }
      }
      for (const Verdict& verdict : std::span(batch).first(count)) verdicts.write(verdict);
    } while (count == batch.size());
  }

  void publish_slow() {
    NavDetail detail;
    AlignmentStatus alignment;
    Forecast forecast;
    bool any = false;
    {
      const std::lock_guard lock(mutex);
      any = counts.nav_states > 0;
      if (any) {
        engine.fill(detail);
        engine.fill(alignment);
        engine.fill(forecast);
      }
    }
    if (!any) return;
    details.write(detail);
    alignments.write(alignment);
    forecasts.write(forecast);
  }

  void fill(ServiceStatus& status) {
    Counts now;
    TimeNs newest = 0;
    AlignmentPhase present = AlignmentPhase::none;
    Name unit;
    {
      const std::lock_guard lock(mutex);
      now = counts;
      newest = newest_nav_state_ns;
      present = phase;
      unit = imu_sensor;
    }
    const TimeNs clock_ns = host.clock().monotonic_ns();
    // A second of the vehicle's time; in an accelerated run a second of the host's, whose scheduling is no
    // faster than otherwise.
    const DurationNs patience = from_seconds(std::max(1.0, host.clock().rate()));
    const std::string from = unit.empty() ? "" : " from " + unit.str();
    status.text.clear();
    if (now.nav_states == 0) {
      status.state = ServiceState::starting;
      status.text = now.imu_samples == 0 ? "waiting for inertial samples" + from
                                         : "no inertial sample" + from + " could be used yet";
    } else if (clock_ns - newest > patience) {
      status.state = ServiceState::degraded;
      std::array<char, 96> text{};
      std::snprintf(text.data(), text.size(), "no usable inertial sample%s for %.1f s", from.c_str(),
                    to_seconds(clock_ns - newest));
      status.text = text.data();
    } else if (present == AlignmentPhase::timed_out || present == AlignmentPhase::lost) {
      status.state = ServiceState::degraded;
      status.text = "alignment " + std::string(present == AlignmentPhase::lost ? "lost" : "timed out");
    } else {
      status.state = ServiceState::healthy;
      status.text = start.how;
    }
    const double span_s = to_seconds(clock_ns - last_status_ns);
    if (last_status_ns != 0 && span_s > 0.0) {
      status.rates.push_back({"imu", static_cast<double>(now.imu_samples - last.imu_samples) / span_s});
      status.rates.push_back({"nav_state", static_cast<double>(now.nav_states - last.nav_states) / span_s});
    }
    status.counters.push_back({"imu_samples", now.imu_samples});
    status.counters.push_back({"nav_states", now.nav_states});
    for (std::size_t kind = 0; kind < kVerdictKinds; ++kind) {
      status.counters.push_back({to_string(static_cast<VerdictKind>(kind)), now.verdicts[kind]});
    }
    status.counters.push_back({"other_vehicle", now.other_vehicle});
    status.counters.push_back({"commands", now.commands});
    if (keeper) {
      const CheckpointKeeper::Counts kept = keeper->counts();
      status.counters.push_back({"checkpoints", kept.written});
      status.counters.push_back({"checkpoints_failed", kept.failed});
      if (!kept.failure.empty())
        status.text += (status.text.empty() ? "checkpoint " : "; checkpoint ") + kept.failure;
    }
    last = now;
    last_status_ns = clock_ns;
  }

  host::ServiceHost& host;
  const Name vehicle;

  const CheckpointLabel label;

  std::mutex mutex;  // guards what follows up to the writers
  Name imu_sensor;   // the one listened to
  Started start;
  estimation::FusionEngine& engine = start.engine;
  ArrivalBook arrivals;
  bus::WriterGuid imu_writer{};
  Counts counts;
  AlignmentPhase phase = AlignmentPhase::none;
  TimeNs newest_nav_state_ns = 0;

  Counts last;  // at the life sign before; used by the thread of the life sign only
  TimeNs last_status_ns = 0;

  bus::Writer<NavState> nav_states;
  bus::Writer<NavDetail> details;
  bus::Writer<Verdict> verdicts;
  bus::Writer<AlignmentStatus> alignments;
  bus::Writer<Forecast> forecasts;

  // Readers end first: their handlers use everything above.
  bus::Reader<GpsSample> gps;
  bus::Reader<DvlSample> dvl;
  bus::Reader<DepthSample> depth;
  bus::Reader<HeadingSample> heading;
  bus::Reader<UsblSample> usbl;
  bus::Reader<AirspeedSample> airspeed;
  bus::Reader<PropulsionSample> propulsion;
  bus::Reader<FinsSample> fins;
  bus::Reader<Command> commands;
  bus::Reader<ImuSample> imu;

  std::optional<CheckpointKeeper> keeper;  // ends first of all, with a last checkpoint
};

FusionService::FusionService(host::ServiceHost& host, const config::FusionConfig& config)
    : impl_(std::make_unique<Impl>(host, config)) {}

FusionService::~FusionService() = default;

}  // namespace fathom::fusion
