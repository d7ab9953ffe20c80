#include "status/json.hpp"

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include "base/units.hpp"
#include "samples/alignment/help.hpp"
#include "samples/uncertainty.hpp"
#include "status/judgement.hpp"

namespace fathom::status {
namespace {

using nlohmann::json;

json number(double value) {
  return std::isfinite(value) ? json(value) : json(nullptr);
}
json degrees(double value_rad) {
  return number(value_rad / kRadPerDeg);
}
json vector3(const std::array<double, 3>& values, double unit = 1.0) {
  return json::array({number(values[0] / unit), number(values[1] / unit), number(values[2] / unit)});
}
json instant(TimeNs utc_ns) {
  return utc_ns == 0 ? json(nullptr) : json(to_iso8601(utc_ns));
}

json navigation(const StatusView& view) {
  if (!view.nav) return nullptr;
  const NavState& nav = view.nav->sample;
  return {{"mode", to_string(nav.mode)},
          {"stamp_utc", instant(nav.header.stamp_ns)},
          {"age_s", number(view.nav->age_s)},
          {"rate_hz", number(view.nav_rate_hz)},
          {"lat_deg", degrees(nav.latitude_rad)},
          {"lon_deg", degrees(nav.longitude_rad)},
          {"alt_m", number(nav.altitude_m)},
          {"depth_m", number(nav.depth_m)},
          {"altitude_above_bottom_m", number(nav.altitude_above_bottom_m)},
          {"horizontal_95_m", number(horizontal_95_m(nav.position_covariance_N_m2))},
          {"vertical_95_m", number(vertical_95_m(nav.position_covariance_N_m2))},
          {"velocity_N_m_s", vector3(nav.velocity_N_m_s)},
          {"rpy_deg", vector3(nav.rpy_rad, kRadPerDeg)},
          {"rpy_sigma_deg", vector3(nav.rpy_sigma_rad, kRadPerDeg)},
          {"reset_counter", nav.reset_counter}};
}

json alignment(const StatusView& view) {
  if (!view.alignment) return nullptr;
  const AlignmentStatus& status = view.alignment->sample;
  json conditions = json::array();
  const auto count = std::min<std::size_t>(status.condition_count, AlignmentStatus::kMaxConditions);
  for (std::size_t i = 0; i < count; ++i) {
    const AlignmentCondition& condition = status.conditions[i];
    conditions.push_back({{"name", condition.name.view()},
                          {"value", number(condition.value)},
                          {"limit", number(condition.limit)},
                          {"held_s", number(condition.held_s)},
                          {"needed_s", number(condition.needed_s)},
                          {"met", condition.met},
                          {"help", condition.met ? std::string_view() : help_of(condition)}});
  }
  return {{"phase", to_string(status.phase)},
          {"in_phase_s", number(status.in_phase_s)},
          {"time_to_aligned_s", number(status.time_to_aligned_s)},
          {"rpy_sigma_deg", vector3(status.rpy_sigma_rad, kRadPerDeg)},
          {"conditions", conditions},
          {"advice", status.advice.data()}};
}

json gps(const StatusView& view) {
  if (!view.monitor) return nullptr;
  const MonitorStatus& monitor = view.monitor->sample;
  json receivers = json::array();
  for (const ReceiverOutage& receiver : monitor.receivers) {
    receivers.push_back({{"name", receiver.name.view()},
                         {"outage", receiver.active},
                         {"severity", to_string(receiver.severity)},
                         {"since_utc", instant(receiver.since_ns)},
                         {"outage_s", number(receiver.outage_s)},
                         {"longest_s", number(receiver.longest_s)},
                         {"total_s", number(receiver.total_s)},
                         {"count", receiver.count}});
  }
  return {{"outage", monitor.gps_outage_active},
          {"severity", to_string(monitor.gps_outage_severity)},
          {"since_utc", instant(monitor.gps_outage_since_ns)},
          {"outage_s", number(monitor.gps_outage_s)},
          {"longest_s", number(monitor.gps_outage_longest_s)},
          {"total_s", number(monitor.gps_outage_total_s)},
          {"count", monitor.gps_outage_count},
          {"receivers", receivers}};
}

json forecast(const StatusView& view) {
  json limits = json::array();
  if (!view.forecast) return limits;
  const Forecast& forecast = view.forecast->sample;
  const auto count = std::min<std::size_t>(forecast.limit_count, Forecast::kMaxLimits);
  for (std::size_t i = 0; i < count; ++i) {
    const ForecastLimit& limit = forecast.limits[i];
    limits.push_back({{"name", limit.name.view()},
                      {"without", limit.without.view()},
                      {"limit", number(limit.limit)},
                      {"now", number(limit.now)},
                      {"time_to_limit_s", number(limit.time_to_limit_s)},
                      {"time_expected_s", number(limit.time_expected_s)},
                      {"never", std::isinf(limit.time_to_limit_s)}});
  }
  return limits;
}

json watched(const WatchedItem& item) {
  return {{"name", item.name.view()},
          {"presence", to_string(item.presence)},
          {"age_s", number(item.age_s)},
          {"rate_hz", number(item.rate_hz)}};
}

json sensors(const StatusView& view) {
  json out = json::array();
  if (!view.monitor) return out;
  for (const WatchedItem& item : view.monitor->sample.sensors) out.push_back(watched(item));
  return out;
}

json verdicts(const StatusView& view) {
  json out = json::object();
  for (const auto& [name, counts] : view.verdicts) {
    json entry = {{"used", counts.used}, {"not_used", counts.not_used}, {"last_refusal", nullptr}};
    if (counts.last_refusal != VerdictKind::used) entry["last_refusal"] = to_string(counts.last_refusal);
    out[name.str()] = entry;
  }
  return out;
}

json services(const StatusView& view) {
  json out = json::array();
  for (const auto& [name, heard] : view.services) {
    const ServiceStatus& status = heard.sample;
    out.push_back({{"name", name.view()},
                   {"state", to_string(status.state)},
                   {"age_s", number(heard.age_s)},
                   {"version", status.version},
                   {"config_hash", status.config_hash},
                   {"host", status.host},
                   {"pid", status.pid},
                   {"utc_offset_s", to_seconds(status.utc_offset_ns)},
                   {"text", status.text}});
  }
  if (!view.monitor) return out;
  for (const WatchedItem& item : view.monitor->sample.services) {
    if (!view.services.contains(item.name)) {
      out.push_back(
          {{"name", item.name.view()}, {"state", to_string(item.presence)}, {"age_s", number(item.age_s)}});
    }
  }
  return out;
}

json alarms(const StatusView& view) {
  json out = json::array();
  for (const Alarm& alarm : sorted_alarms(view)) {
    out.push_back({{"alarm", alarm.alarm.view()},
                   {"severity", to_string(alarm.severity)},
                   {"active", alarm.active},
                   {"acknowledged", alarm.acknowledged},
                   {"since_utc", instant(alarm.since_ns)},
                   {"cleared_utc", instant(alarm.cleared_ns)},
                   {"text", alarm.text},
                   {"value", number(alarm.value)},
                   {"limit", number(alarm.limit)}});
  }
  return out;
}

}  // namespace

std::string json_line(const StatusView& view) {
  const Judgement judgement = judge(view);
  const json out = {{"condition", to_string(judgement.condition)},
                    {"reasons", judgement.reasons},
                    {"time_utc", instant(view.utc_ns)},
                    {"vehicle", view.vehicle},
                    {"domain", view.domain},
                    {"window_s", number(view.window_s)},
                    {"navigation", navigation(view)},
                    {"alignment", alignment(view)},
                    {"gps", gps(view)},
                    {"forecast", forecast(view)},
                    {"sensors", sensors(view)},
                    {"verdicts", verdicts(view)},
                    {"services", services(view)},
                    {"alarms", alarms(view)}};
  return out.dump(-1, ' ', false, json::error_handler_t::replace);
}

}  // namespace fathom::status
