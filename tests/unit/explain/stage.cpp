#include "unit/explain/stage.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <deque>
#include <utility>

#include "bus/cdr.hpp"
#include "bus/topics.hpp"
#include "config/scenario/scenario_wiring.hpp"
#include "health/vehicle_health.hpp"
#include "samples/status/intake.hpp"
#include "support/paths.hpp"

namespace fathom::test {
namespace {

const std::string kConfig = source_dir() + "/deploy/config/";

template <class Config>
Config load(const sim::Scenario& scenario, const std::string& service) {
  const auto sets = config::service_overrides(scenario, {});
  const auto own = sets.find(service);
  config::LoadRequest request{kConfig + service + ".json", {}};
  if (own != sets.end()) request.sets = own->second;
  return config::load_service_config<Config>(request).value;
}

}  // namespace

struct Stage::Fusion {
  Fusion(const config::FusionConfig& config, Name name_in, std::uint32_t pid_in)
      : engine(config.engine), name(name_in), pid(pid_in) {}
  estimation::FusionEngine engine;
  Name name;
  std::uint32_t pid;
  bool alive = true;
  bool leads = true;
  IntakeRecord intake;
  std::uint64_t taken = 0;
};

Stage::Stage(sim::Scenario scenario, std::uint64_t seed, const sim::Scenario* configured)
    : scenario_(std::move(scenario)),
      simulation_(scenario_, {kEpochNs, seed, "auv"}),
      fusion_config_(load<config::FusionConfig>(configured == nullptr ? scenario_ : *configured, "fusion")),
      monitor_config_(
          load<config::MonitorConfig>(configured == nullptr ? scenario_ : *configured, "monitor")) {
  std::vector<std::string> names{"monitor"};
  for (const std::string& bridge : scenario_.bridges) names.push_back(bridge + "_bridge");
  for (const std::string& name : names) services_[name] = {next_pid_++, kEpochNs};
  monitor_config_.health.services.clear();
  for (const std::string& name : names)
    monitor_config_.health.services.push_back({Name(name), Severity::warning});
  monitor_config_.health.services.push_back({"fusion", Severity::critical});
  monitor_ = std::make_unique<health::VehicleHealth>(monitor_config_.health, health::Instant{0, kEpochNs});
  start_fusion(false);
}
Stage::~Stage() = default;

std::string Stage::process_of(const std::string& service, std::uint32_t pid) const {
  std::array<char, 40> text{};
  const std::size_t host = service.size() * 7 % 10;
  std::snprintf(text.data(), text.size(), "010f0000%04x%04x%08zx", pid, 0U, host);
  return text.data();
}

template <class T>
void Stage::record(const T& sample, const char* topic, const char* type, const std::string& writer,
                   std::uint32_t pid, bool latched) {
  const std::string process = process_of(writer, pid);
  const std::string key = topic + process;
  const auto [found, is_new] = origins_.try_emplace(key, static_cast<std::uint32_t>(origins_.size()));
  if (is_new) store_->add(blackbox::Origin{topic, type, writer, process + "00000103", latched});
  blackbox::Sample out;
  out.origin = found->second;
  out.log_ns = now_ns_;
  out.publish_ns = now_ns_;
  out.bytes = bus::to_cdr(sample);
  store_->add(std::move(out));
}

void Stage::kill_fusion() {
  kept_.clear();
  (void)fusions_.back()->engine.save(kept_);
  fusions_.back()->alive = false;
}

void Stage::start_fusion(bool resumed) {
  auto fusion = std::make_unique<Fusion>(fusion_config_, "fusion", next_pid_++);
  if (resumed) (void)fusion->engine.restore(kept_);
  if (resumed) {
    IntakeEntry entry;
    entry.kind = IntakeKind::state;
    entry.sensor = fusion->name;
    fusion->intake.entries.push_back(entry);
  }
  services_["fusion"] = {fusion->pid, now_ns_};
  std::erase_if(fusions_, [](const auto& one) { return !one->alive; });
  fusions_.push_back(std::move(fusion));
}

void Stage::start_bridge(const std::string& service) {
  silent_[service] = false;
  services_[service] = {next_pid_++, now_ns_};
}

void Stage::add_standby() {
  fusions_.push_back(std::make_unique<Fusion>(fusion_config_, "fusion_b", next_pid_++));
  fusions_.back()->leads = false;
  services_["fusion_b"] = {fusions_.back()->pid, now_ns_};
}

void Stage::take_over() {
  fusions_.front()->alive = false;
  fusions_.back()->leads = true;
}

void Stage::give(Fusion& fusion, const AnySample& sample, const std::string& writer) {
  IntakeEntry entry;
  entry.source = source_of(sample);
  entry.writer = Name(writer);
  entry.stamp_ns = header_of(sample).stamp_ns;
  entry.sequence = header_of(sample).sequence;
  fusion.intake.entries.push_back(entry);
  const std::string name = fusion.name.str();
  std::visit(
      [&]<class T>(const T& one) {
        if constexpr (std::is_same_v<T, ImuSample>) {
          if (!fusion.engine.add(one)) return;
          NavState state = fusion.engine.nav_state();
          state.header.sensor = fusion.name;
          if (!fusion.leads) return;
          record(state, "fathom/v1/nav_state", "fathom::v1::NavState", name, fusion.pid);
          monitor_->add(state, {now_ns_ - kEpochNs, now_ns_});
        } else {
          fusion.engine.add(one, Name(writer));
        }
      },
      sample);
  for (Verdict verdict; fusion.engine.next_verdict(verdict);) {
    if (!fusion.leads) continue;
    record(verdict, "fathom/v1/verdict", "fathom::v1::Verdict", name, fusion.pid);
    monitor_->add(verdict, {now_ns_ - kEpochNs, now_ns_});
  }
  for (estimation::OrderOutcome outcome; fusion.engine.next_outcome(outcome);) continue;
  if (fusion.intake.entries.size() >= IntakeRecord::kMostEntries) {
    fusion.intake.header = {"auv", fusion.name, now_ns_, now_ns_, ++sequence_};
    fusion.intake.first = fusion.taken;
    fusion.taken += fusion.intake.entries.size();
    record(fusion.intake, "fathom/v1/intake", "fathom::v1::IntakeRecord", name, fusion.pid);
    fusion.intake.entries.clear();
  }
}

void Stage::deliver(const AnySample& sample, bool second) {
  const std::string bridge(role_of(source_of(sample)));
  if (silent_[bridge] && !second) return;
  std::visit(
      [&]<class T>(const T& one) {
        static const std::string type = [] {
          const std::string topic(KindOf<T>::kTopic);
          for (const bus::TopicInfo& info : bus::all_topics())
            if (topic == info.topic) return std::string(info.type);
          return std::string();
        }();
        static const std::string topic(KindOf<T>::kTopic);
        const std::uint32_t pid = second ? 77 : services_[bridge].pid;
        record(one, topic.c_str(), type.c_str(), bridge, pid);
        const health::Instant now{now_ns_ - kEpochNs, now_ns_};
        WriterGuid guid{};
        guid[4] = static_cast<std::uint8_t>(pid >> 8U);
        guid[5] = static_cast<std::uint8_t>(pid);
        if constexpr (requires { monitor_->add(one, now, guid); }) {
          monitor_->add(one, now, guid);
        } else {
          monitor_->heard(kSourceOf<T>, one.header, now, guid);
        }
      },
      sample);
  for (const auto& fusion : fusions_)
    if (fusion->alive) give(*fusion, sample, bridge);
}

void Stage::life() {
  for (const auto& [name, service] : services_) {
    if (silent_[name]) continue;
    if (name.starts_with("fusion") && std::none_of(fusions_.begin(), fusions_.end(), [&](const auto& one) {
          return one->alive && one->pid == service.pid;
        }))
      continue;
    ServiceStatus status;
    status.header = {"auv", Name(name), now_ns_, now_ns_, ++sequence_};
    status.text = unwell_[name];
    status.state = status.text.empty() ? ServiceState::healthy : ServiceState::degraded;
    status.version = "test";
    status.host = "vehicle";
    status.pid = service.pid;
    status.started_ns = service.started_ns;
    status.utc_offset_ns = utc_offset_ns_;
    record(status, "fathom/v1/service_status", "fathom::v1::ServiceStatus", name, service.pid, false);
    monitor_->add(status, {now_ns_ - kEpochNs, now_ns_});
  }
  for (const auto& fusion : fusions_) {
    if (!fusion->alive || !fusion->leads) continue;
    AlignmentStatus status;
    fusion->engine.fill(status);
    status.header = {"auv", fusion->name, now_ns_, now_ns_, ++sequence_};
    record(status, "fathom/v1/alignment", "fathom::v1::AlignmentStatus", fusion->name.str(), fusion->pid);
    monitor_->add(status, {now_ns_ - kEpochNs, now_ns_});
  }
}

void Stage::watch() {
  monitor_->evaluate({now_ns_ - kEpochNs, now_ns_});
  for (health::AlarmTransition& one : monitor_->take_transitions()) {
    one.alarm.header = {"auv", "monitor", now_ns_, now_ns_, ++sequence_};
    record(one.alarm, "fathom/v1/alarm", "fathom::v1::Alarm", "monitor", services_["monitor"].pid);
  }
}

void Stage::run(double duration_s, const std::filesystem::path& file) {
  blackbox::Options options;
  options.out = file;
  options.split_bytes = 0;
  options.split_ns = 0;
  options.quota_bytes = 0;
  options.compression = record::Compression::lz4;
  store_ = std::make_unique<blackbox::Store>(options, blackbox::create_file, [](bool, const std::string&) {});
  struct Under {
    AnySample sample;
    bool second = false;
  };
  std::multimap<TimeNs, Under> under_way;  // by arrival
  std::vector<AnySample> fresh;
  for (int step = 0; simulation_.time_s() < duration_s; ++step) {
    fresh.clear();
    simulation_.advance(fresh);
    now_ns_ = simulation_.truth().header.stamp_ns;
    const double t_s = to_seconds(now_ns_ - kEpochNs);
    while (!what_.empty() && what_.begin()->first <= t_s) {
      const auto what = what_.begin()->second;
      what_.erase(what_.begin());
      what();
    }
    for (AnySample& sample : fresh) {
      const double stamp_s = to_seconds(header_of(sample).stamp_ns - kEpochNs);
      if (besides)
        for (AnySample& one : besides(sample, stamp_s)) {
          const TimeNs received_ns = header_of(one).received_ns;
          under_way.emplace(received_ns, Under{std::move(one), true});
        }
      if (spoil && !spoil(sample, stamp_s)) continue;
      const TimeNs received_ns = header_of(sample).received_ns;
      under_way.emplace(received_ns, Under{std::move(sample), false});
    }
    while (!under_way.empty() && under_way.begin()->first <= now_ns_) {
      const Under one = std::move(under_way.begin()->second);
      under_way.erase(under_way.begin());
      deliver(one.sample, one.second);
    }
    if (step % 5 == 0) watch();
    if (step % 100 == 50) {
      life();
      store_->settle(now_ns_);
    }
  }
  store_->finish();
}

}  // namespace fathom::test
