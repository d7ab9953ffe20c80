#include "demo/report.hpp"

#include <array>
#include <cmath>
#include <cstdio>

#include <nlohmann/json.hpp>

#include "base/units.hpp"
#include "health/text.hpp"

namespace fathom::demo {
namespace {

using nlohmann::json;

json number(double value) {
  return std::isfinite(value) ? json(value) : json(nullptr);
}

std::string health_word(const Observation& seen, const std::string& name) {
  const auto at = seen.services.find(name);
  return at == seen.services.end() ? "never_heard" : std::string(to_string(at->second.state));
}

json figures(const dataset::ErrorFigures& f) {
  return {{"rms", number(f.rms)}, {"p95", number(f.p95)}, {"max", number(f.max)}, {"end", number(f.end)}};
}

}  // namespace

std::string report_json(const std::string& scenario, double duration_s, const Observation& seen,
                        const Demands& demands, const std::vector<Finding>& findings,
                        const std::string& recording) {
  json outages = json::array();
  for (const GpsOutage& outage : seen.outages) {
    outages.push_back({{"start_s", number(outage.start_s)},
                       {"end_s", number(outage.end_s)},
                       {"flagged_after_s", number(outage.flagged_after_s)},
                       {"cleared_after_s", number(outage.cleared_after_s)}});
  }
  json services = json::object();
  for (const std::string& name : demands.services) services[name] = health_word(seen, name);
  json verdicts = json::object();
  for (const auto& [source, tally] : seen.verdicts) {
    const auto& counts = tally.counts();
    for (std::size_t kind = 0; kind < counts.size(); ++kind) {
      verdicts[source][std::string(to_string(static_cast<VerdictKind>(kind)))] = counts[kind];
    }
  }
  json alarms = json::array();
  for (const auto& [name, alarm] : seen.alarms) {
    alarms.push_back({{"alarm", name},
                      {"severity", to_string(alarm.severity)},
                      {"active", alarm.active},
                      {"acknowledged", alarm.acknowledged},
                      {"since", to_iso8601(alarm.since_ns)},
                      {"cleared", alarm.cleared_ns == 0 ? json(nullptr) : json(to_iso8601(alarm.cleared_ns))},
                      {"text", alarm.text},
                      {"value", number(alarm.value)},
                      {"limit", number(alarm.limit)}});
  }
  json judged = json::array();
  for (const Finding& finding : findings) judged.push_back({{"met", finding.met}, {"text", finding.text}});

  const auto& rpy = seen.score.rpy_rad;
  const json out = {
      {"scenario", scenario},
      {"duration_s", duration_s},
      {"nav_state_rate_hz", rate_hz(seen, demands)},
      {"nav_state_valid_share", number(valid_share(seen, demands))},
      {"horizontal_error_m", figures(seen.score.horizontal_m)},
      {"distance_m", seen.distance_m},
      {"attitude_error_deg",
       {{"roll", number(rpy[0].rms * kDegPerRad)},
        {"pitch", number(rpy[1].rms * kDegPerRad)},
        {"yaw", number(rpy[2].rms * kDegPerRad)}}},
      {"gps_outages", outages},
      {"alignment",
       {{"phase", to_string(seen.alignment ? seen.alignment->phase : AlignmentPhase::none)},
        {"aligned_after_s", number(seen.aligned_after_s())}}},
      {"latency_us", {{"p50", number(seen.latency_us(0.50))}, {"p99", number(seen.latency_us(0.99))}}},
      {"services", services},
      {"restarts", demands.restarts},
      {"verdicts", verdicts},
      {"alarms", alarms},
      {"recording", recording.empty() ? json(nullptr) : json(recording)},
      {"findings", judged}};
  return out.dump(2) + "\n";
}

std::string status_line(double elapsed_s, const Observation& seen) {
  std::string out = health::sentence("%6.0f s", elapsed_s);
  if (!seen.nav) return out + "  no navigation state yet";
  const NavState& nav = *seen.nav;
  out += health::sentence("  %-14s %-9s", std::string(to_string(nav.mode)).c_str(),
                          std::string(to_string(nav.alignment)).c_str());
  if (known(nav.latitude_rad)) {
    const double sigma =
        std::sqrt(std::max(nav.position_covariance_N_m2[0], nav.position_covariance_N_m2[4]));
    out += health::sentence("  %10.6f %11.6f", nav.latitude_rad * kDegPerRad, nav.longitude_rad * kDegPerRad);
    out += known(nav.depth_m) ? health::sentence("  depth %5.1f m", nav.depth_m) : "  depth     - m";
    out += health::sentence("  yaw %5.1f deg  95%% %5.1f m", nav.rpy_rad[2] * kDegPerRad, 2.45 * sigma);
  }
  if (seen.error) out += health::sentence("  error %5.2f m", seen.error->horizontal_m);
  if (seen.monitor && seen.monitor->gps_outage_active)
    out += health::sentence("  GPS gone %.0f s", seen.monitor->gps_outage_s);
  if (seen.monitor && seen.monitor->alarms_active > 0)
    out += health::sentence("  alarms %u", seen.monitor->alarms_active);
  return out;
}

}  // namespace fathom::demo
