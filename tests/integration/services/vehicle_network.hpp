#pragma once

#include <atomic>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "base/clock.hpp"
#include "bus/participant.hpp"
#include "bus/reader.hpp"
#include "bus/writer.hpp"
#include "samples/alignment_status.hpp"
#include "samples/command.hpp"
#include "samples/gps.hpp"
#include "samples/nav_state.hpp"
#include "samples/status/health.hpp"
#include "support/presence.hpp"

namespace fathom::test {

/// The rest of a vehicle as the service under test sees it: what is written here arrives there.
class VehicleNetwork {
 public:
  VehicleNetwork(std::uint32_t domain, const Clock& clock, const std::string& name = "test_vehicle")
      : clock_(clock), began_ns_(clock.utc_ns()), participant_(presence(domain, name)) {}

  SampleHeader header(const Name& sensor) {
    SampleHeader out;
    out.vehicle = "auv";
    out.sensor = sensor;
    out.stamp_ns = clock_.utc_ns();
    out.received_ns = out.stamp_ns;
    out.sequence = ++sequence_;
    return out;
  }
  void gps(bool fix) {
    GpsSample sample;
    sample.header = header("gps");
    sample.fix = fix ? GpsFix::fix_3d : GpsFix::none;
    if (fix) {
      // North at 1 m/s, as nav() says.
      sample.latitude_rad = 0.6 + to_seconds(sample.header.stamp_ns - began_ns_) / 6.36e6;
      sample.longitude_rad = 2.2;
      sample.altitude_m = 20.0;
    }
    gps_.write(sample);
  }
  void nav(NavMode mode = NavMode::gps_aided, AlignmentPhase alignment = AlignmentPhase::aligned,
           double sigma_m = 1.0, const Name& vehicle = "auv") {
    NavState state;
    state.header = header("fusion");
    state.header.vehicle = vehicle;
    state.mode = mode;
    state.alignment = alignment;
    state.latitude_rad = 0.6;
    state.longitude_rad = 2.2;
    state.altitude_m = 20.0;
    state.depth_m = 0.0;
    state.velocity_N_m_s = {1.0, 0.0, 0.0};
    state.q_NB = {1.0, 0.0, 0.0, 0.0};
    state.rpy_rad = {0.0, 0.0, 0.0};
    const double variance = sigma_m * sigma_m;
    state.position_covariance_N_m2 = {variance, 0, 0, 0, variance, 0, 0, 0, variance};
    state.rpy_sigma_rad = {0.001, 0.001, 0.01};
    nav_.write(state);
  }
  void life_sign(const Name& service, std::uint32_t pid = 100, ServiceState state = ServiceState::healthy) {
    ServiceStatus status;
    status.header = header(service);
    status.state = state;
    status.pid = pid;
    status.started_ns = pid;
    status.host = "test";
    status.version = "0";
    service_.write(status);
  }
  void monitor(bool healthy) {
    MonitorStatus status;
    status.header = header("monitor");
    status.known = true;
    status.healthy = healthy;
    status.mode = NavMode::gps_aided;
    status.gps_outage_s = 0.0;
    status.alarms_active = healthy ? 0 : 1;
    monitor_.write(status);
  }
  void alarm(const Name& key, bool active) {
    Alarm out;
    out.header = header("monitor");
    out.alarm = key;
    out.severity = Severity::warning;
    out.active = active;
    out.since_ns = clock_.utc_ns();
    out.text = "Something is wrong.";
    alarm_.write(out);
  }
  void acknowledge(const Name& key) {
    Command command;
    command.header = header("operator");
    command.kind = CommandKind::acknowledge_alarm;
    command.target = key;
    command_.write(command);
  }
  /// Of the newest sample written, of whatever type.
  [[nodiscard]] std::uint64_t last_sequence() const { return sequence_; }
  bus::Participant& participant() { return participant_; }
  [[nodiscard]] bool nav_heard_by_someone() const { return nav_.matched_readers() > 0; }
  [[nodiscard]] bool commands_heard_by_someone() const { return command_.matched_readers() > 0; }

 private:
  const Clock& clock_;
  TimeNs began_ns_;
  std::atomic<std::uint64_t> sequence_{0};  ///< samples may be written from several threads
  bus::Participant participant_;
  bus::Writer<GpsSample> gps_{participant_};
  bus::Writer<NavState> nav_{participant_};
  bus::Writer<ServiceStatus> service_{participant_};
  bus::Writer<MonitorStatus> monitor_{participant_};
  bus::Writer<Alarm> alarm_{participant_};
  bus::Writer<Command> command_{participant_};
};

/// What the monitor says.
class MonitorEar {
 public:
  explicit MonitorEar(bus::Participant& participant)
      : status_(participant,
                [this](const MonitorStatus& status, const bus::SampleInfo&) {
                  const std::lock_guard lock(mutex_);
                  last_ = status;
                }),
        alarms_(participant, [this](const Alarm& alarm, const bus::SampleInfo&) {
          const std::lock_guard lock(mutex_);
          heard_[alarm.alarm.str()] = alarm;
        }) {}

  [[nodiscard]] std::optional<MonitorStatus> status() const {
    const std::lock_guard lock(mutex_);
    return last_;
  }
  [[nodiscard]] std::optional<Alarm> alarm(const std::string& key) const {
    const std::lock_guard lock(mutex_);
    const auto found = heard_.find(key);
    return found == heard_.end() ? std::nullopt : std::optional(found->second);
  }
  [[nodiscard]] bool active(const std::string& key) const {
    const auto found = alarm(key);
    return found && found->active;
  }

 private:
  mutable std::mutex mutex_;
  std::optional<MonitorStatus> last_;
  std::map<std::string, Alarm> heard_;
  bus::Reader<MonitorStatus> status_;
  bus::Reader<Alarm> alarms_;
};

}  // namespace fathom::test
