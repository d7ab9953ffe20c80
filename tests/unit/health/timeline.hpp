#pragma once

#include <cmath>
#include <string>

#include "base/time.hpp"
#include "health/alarm_book.hpp"
#include "health/instant.hpp"
#include "health/vehicle_health.hpp"
#include "samples/gps.hpp"
#include "samples/nav_state.hpp"
#include "samples/status/health.hpp"
#include "samples/verdict.hpp"

namespace fathom::health {

inline constexpr TimeNs kBoot = 5'000 * kNsPerSecond;
inline constexpr TimeNs kEpoch = 1'700'000'000 * kNsPerSecond;

/// `seconds` after the monitor's start, with UTC `utc_step_s` away from where it began.
inline Instant at(double seconds, double utc_step_s = 0.0) {
  return {kBoot + from_seconds(seconds), kEpoch + from_seconds(seconds + utc_step_s)};
}

/// A vehicle with three instruments and two services.
inline HealthConfig of_three_instruments() {
  HealthConfig out;
  out.sensors = {{"imu", SourceKind::imu, 100.0, 0.0, Severity::critical},
                 {"gps", SourceKind::gps, 2.0, 0.0, Severity::warning},
                 {"dvl", SourceKind::dvl, 5.0, 0.0, Severity::warning}};
  out.services = {{"fusion", Severity::critical}, {"gps_bridge", Severity::warning}};
  return out;
}

inline bool alarmed(const AlarmBook& book, const Name& key) {
  const Alarm* alarm = book.find(key);
  return alarm != nullptr && alarm->active;
}

inline SampleHeader header(const Name& sensor, double seconds) {
  SampleHeader out;
  out.vehicle = "auv";
  out.sensor = sensor;
  out.stamp_ns = kEpoch + from_seconds(seconds);
  out.received_ns = out.stamp_ns;
  return out;
}

inline GpsSample gps(double seconds, bool fix = true, const Name& sensor = "gps") {
  GpsSample sample;
  sample.header = header(sensor, seconds);
  sample.fix = fix ? GpsFix::fix_3d : GpsFix::none;
  if (fix) {
    sample.latitude_rad = 0.6 + seconds * 1.0 / 6.36e6;  // nav() goes north at 1 m/s
    sample.longitude_rad = 2.2;
    sample.altitude_m = 20.0;
  }
  return sample;
}

inline Verdict verdict(SourceKind source, VerdictKind kind, double seconds, const Name& sensor) {
  Verdict out;
  out.header = header(sensor, seconds);
  out.source = source;
  out.kind = out.previous = kind;
  return out;
}

inline NavState nav(double seconds, NavMode mode = NavMode::gps_aided,
                    AlignmentPhase alignment = AlignmentPhase::aligned, double sigma_m = 1.0) {
  NavState state;
  state.header = header("fusion", seconds);
  state.mode = mode;
  state.alignment = alignment;
  state.latitude_rad = 0.6;
  state.longitude_rad = 2.2;
  state.altitude_m = 20.0;
  state.velocity_N_m_s = {1.0, 0.0, 0.0};
  state.q_NB = {1.0, 0.0, 0.0, 0.0};
  state.rpy_rad = {0.0, 0.0, 0.0};
  const double variance = sigma_m * sigma_m;
  state.position_covariance_N_m2 = {variance, 0, 0, 0, variance, 0, 0, 0, variance};
  state.rpy_sigma_rad = {0.001, 0.001, 0.01};
  return state;
}

inline ServiceStatus life_sign(const Name& service, double seconds,
                               ServiceState state = ServiceState::healthy, std::uint32_t pid = 100) {
  ServiceStatus out;
  out.header = header(service, seconds);
  out.state = state;
  out.pid = pid;
  out.started_ns = kEpoch + pid;
  return out;
}

}  // namespace fathom::health
