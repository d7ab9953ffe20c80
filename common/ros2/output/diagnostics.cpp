#include "ros2/output/diagnostics.hpp"

#include <cmath>

#include "ros2/output/messages.hpp"
#include "samples/position/gives_position.hpp"

namespace fathom::ros2 {
namespace {

constexpr std::size_t kLongestText = 240;

KeyValue pair(std::string key, double value) {
  return {std::move(key), std::to_string(value)};
}

std::string cut(std::string text) {
  if (text.size() > kLongestText) text.resize(kLongestText);
  return text;
}

DiagnosticStatus navigation(const NavState& state, bool is_stale) {
  DiagnosticStatus out;
  out.name = "fathom: navigation";
  out.message = std::string(to_string(state.mode)) + ", alignment " + std::string(to_string(state.alignment));
  const bool usable = gives_position(state.mode);
  out.level =
      is_stale ? DiagnosticStatus::kStale : (usable ? DiagnosticStatus::kOk : DiagnosticStatus::kWarning);
  out.values.push_back(pair("horizontal_sigma_m", std::sqrt(state.position_covariance_N_m2[0] +
                                                            state.position_covariance_N_m2[4])));
  out.values.push_back(pair("heading_sigma_rad", state.rpy_sigma_rad[2]));
  out.values.push_back(pair("gps_outage_s", state.gps_outage_s));
  out.values.push_back(pair("dvl_outage_s", state.dvl_outage_s));
  out.values.push_back({"reset_counter", std::to_string(state.reset_counter)});
  return out;
}

DiagnosticStatus service(const ServiceStatus& status, bool is_stale) {
  DiagnosticStatus out;
  out.name = "fathom: " + status.header.sensor.str();
  const bool is_healthy = status.state == ServiceState::healthy;
  out.level =
      is_stale ? DiagnosticStatus::kStale : (is_healthy ? DiagnosticStatus::kOk : DiagnosticStatus::kWarning);
  out.message = cut(status.text.empty() ? std::string(to_string(status.state)) : status.text);
  out.values.push_back({"version", cut(status.version)});
  out.values.push_back({"host", cut(status.host)});
  for (const ServiceRate& rate : status.rates) out.values.push_back(pair(rate.name.str() + "_hz", rate.hz));
  return out;
}

DiagnosticStatus of_alarm(const Alarm& alarm) {
  DiagnosticStatus out;
  out.name = "fathom alarm: " + alarm.alarm.str();
  out.level =
      alarm.severity == Severity::critical
          ? DiagnosticStatus::kError
          : (alarm.severity == Severity::warning ? DiagnosticStatus::kWarning : DiagnosticStatus::kOk);
  out.message = cut(alarm.text);
  out.values.push_back(pair("value", alarm.value));
  out.values.push_back(pair("limit", alarm.limit));
  out.values.push_back({"acknowledged", alarm.acknowledged ? "true" : "false"});
  return out;
}

}  // namespace

void DiagnosticsBook::heard(const ServiceStatus& status, TimeNs now_ns) {
  services_[status.header.sensor.str()] = {status, now_ns};
}

void DiagnosticsBook::heard(const Alarm& alarm) {
  if (alarm.active) {
    alarms_[alarm.alarm.str()] = alarm;
  } else {
    alarms_.erase(alarm.alarm.str());
  }
}

void DiagnosticsBook::heard(const NavState& state, TimeNs now_ns) {
  state_ = Heard<NavState>{state, now_ns};
}

DiagnosticArray DiagnosticsBook::message(const std::string& vehicle, TimeNs now_ns) const {
  DiagnosticArray out;
  out.header.stamp = time_of(now_ns);
  if (state_) out.status.push_back(navigation(state_->value, now_ns - state_->at_ns > kStale_ns));
  std::size_t count = 0;
  for (const auto& [name, one] : services_) {
    if (++count > kMost) break;
    out.status.push_back(service(one.value, now_ns - one.at_ns > kStale_ns));
  }
  count = 0;
  for (const auto& [name, one] : alarms_) {
    if (++count > kMost) break;
    out.status.push_back(of_alarm(one));
  }
  for (DiagnosticStatus& status : out.status) status.hardware_id = vehicle;
  return out;
}

}  // namespace fathom::ros2
