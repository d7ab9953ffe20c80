#include "demo/report.hpp"

#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>

#include <nlohmann/json.hpp>

namespace fathom::demo {
namespace {

using nlohmann::json;

constexpr double kDegrees = 180.0 / std::numbers::pi;
// Of the monitor after its limit: one period plus what a loaded machine needs.
constexpr double kFlagToleranceS = 1.5;
// From the first fix to the all-clear: the monitor wants some consecutive fixes.
constexpr double kClearToleranceS = 10.0;

json number(double value) {
  return std::isfinite(value) ? json(value) : json(nullptr);
}

template <class... Args>
std::string text(const char* format, Args... args) {
  std::array<char, 256> out{};
  std::snprintf(out.data(), out.size(), format, args...);
  return out.data();
}

double rate_hz(const Observation& seen) {
  if (seen.nav_states < 2 || seen.last_nav_ns <= seen.first_nav_ns) return 0.0;
  return static_cast<double>(seen.nav_states - 1) / to_seconds(seen.last_nav_ns - seen.first_nav_ns);
}

void judge_accuracy(const Observation& seen, const Demands& demands, std::vector<Finding>& out) {
  const auto& limits = demands.limits;
  const auto below = [&out](double value, double limit, const char* what, double factor, const char* unit) {
    if (known(limit)) {
      out.push_back({value <= limit,
                     text("%s %.3g %s, limit %.3g %s", what, value * factor, unit, limit * factor, unit)});
    }
  };
  if (seen.score.count == 0) {
    out.push_back({false, "no navigation state with a position to compare with the truth"});
    return;
  }
  below(seen.score.horizontal_m.rms, limits.horizontal_rms_m, "horizontal error rms", 1.0, "m");
  below(seen.score.horizontal_m.max, limits.horizontal_max_m, "horizontal error max", 1.0, "m");
  below(std::max(seen.score.rpy_rad[0].rms, seen.score.rpy_rad[1].rms), limits.roll_pitch_rms_rad,
        "roll and pitch error rms", kDegrees, "deg");
  below(seen.score.rpy_rad[2].rms, limits.yaw_rms_rad, "yaw error rms", kDegrees, "deg");
  if (known(demands.end_error_share) && seen.distance_m > 0.0) {
    below(seen.score.horizontal_m.end / seen.distance_m, demands.end_error_share,
          "horizontal end error of distance travelled", 100.0, "%");
  }
}

void judge_outages(const Observation& seen, const Demands& demands, std::vector<Finding>& out) {
  int complete = 0;
  for (const GpsOutage& outage : seen.outages) {
    const bool over = known(outage.end_s);
    const double length_s = outage.end_s - outage.start_s;
    // One that ended within the tolerance of the limit need not have been flagged.
    if (!known(outage.flagged_after_s)) {
      if (over && length_s > demands.gps_limit_s + kFlagToleranceS) {
        out.push_back(
            {false, text("GPS outage at %.1f s of %.1f s was not flagged", outage.start_s, length_s)});
      }
      continue;
    }
    out.push_back({outage.flagged_after_s <= demands.gps_limit_s + kFlagToleranceS,
                   text("GPS outage at %.1f s flagged after %.2f s, limit %.2f s", outage.start_s,
                        outage.flagged_after_s, demands.gps_limit_s + kFlagToleranceS)});
    if (known(outage.cleared_after_s)) {
      ++complete;
      out.push_back({outage.cleared_after_s <= kClearToleranceS,
                     text("GPS outage at %.1f s cleared %.2f s after the first fix, limit %.0f s",
                          outage.start_s, outage.cleared_after_s, kClearToleranceS)});
    }
  }
  if (demands.whole_run && demands.gps_expected && demands.limits.gps_outages_at_least > 0) {
    out.push_back({complete >= demands.limits.gps_outages_at_least,
                   text("%d GPS outages flagged and cleared, at least %d expected", complete,
                        demands.limits.gps_outages_at_least)});
  }
}

void judge_services(const Observation& seen, const Demands& demands, std::vector<Finding>& out) {
  const std::size_t before = out.size();
  for (const std::string& name : demands.services) {
    const auto at = seen.services.find(name);
    if (at == seen.services.end()) {
      out.push_back({false, "service " + name + " was never heard"});
      continue;
    }
    const ServiceRecord& record = at->second;
    const auto restarts = demands.restarts.find(name);
    if (restarts != demands.restarts.end() && restarts->second > 0) {
      out.push_back({false, text("service %s was started again %d times", name.c_str(), restarts->second)});
    } else if (!record.was_healthy || record.fell) {
      out.push_back({false, "service " + name + " did not stay healthy: " + record.text});
    }
  }
  if (out.size() == before)
    out.push_back({true, text("%zu services stayed healthy", demands.services.size())});
  for (const std::string& name : demands.killed)
    out.push_back({false, "service " + name + " did not stop when asked"});
}

std::string health_word(const Observation& seen, const std::string& name) {
  const auto at = seen.services.find(name);
  return at == seen.services.end() ? "never_heard" : std::string(to_string(at->second.state));
}

json figures(const dataset::ErrorFigures& f) {
  return {{"rms", number(f.rms)}, {"p95", number(f.p95)}, {"max", number(f.max)}, {"end", number(f.end)}};
}

}  // namespace

std::vector<Finding> judge(const Observation& seen, const Demands& demands) {
  std::vector<Finding> out;
  const double rate = rate_hz(seen);
  out.push_back({rate >= 0.98 * demands.nav_rate_hz,
                 text("navigation state at %.1f Hz, inertial sensor at %.0f Hz", rate, demands.nav_rate_hz)});
  if (demands.alignment_expected) {
    const double limit = known(demands.limits.aligned_within_s) ? demands.limits.aligned_within_s : 1e9;
    const double after_s = seen.aligned_after_s();
    out.push_back({after_s <= limit, known(after_s) ? text("aligned after %.1f s", after_s)
                                                    : std::string("alignment was not reached")});
  }
  judge_accuracy(seen, demands, out);
  judge_outages(seen, demands, out);
  judge_services(seen, demands, out);
  return out;
}

std::string report_json(const std::string& scenario, double duration_s, const Observation& seen,
                        const Demands& demands, const std::vector<Finding>& findings) {
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
  for (const auto& [source, counts] : seen.verdicts) {
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
      {"nav_state_rate_hz", rate_hz(seen)},
      {"horizontal_error_m", figures(seen.score.horizontal_m)},
      {"distance_m", seen.distance_m},
      {"attitude_error_deg",
       {{"roll", number(rpy[0].rms * kDegrees)},
        {"pitch", number(rpy[1].rms * kDegrees)},
        {"yaw", number(rpy[2].rms * kDegrees)}}},
      {"gps_outages", outages},
      {"alignment",
       {{"phase", to_string(seen.alignment ? seen.alignment->phase : AlignmentPhase::none)},
        {"aligned_after_s", number(seen.aligned_after_s())}}},
      {"latency_us", {{"p50", number(seen.latency_p50_us)}, {"p99", number(seen.latency_p99_us)}}},
      {"services", services},
      {"restarts", demands.restarts},
      {"verdicts", verdicts},
      {"alarms", alarms},
      {"findings", judged}};
  return out.dump(2) + "\n";
}

std::string status_line(double elapsed_s, const Observation& seen) {
  std::string out = text("%6.0f s", elapsed_s);
  if (!seen.nav) return out + "  no navigation state yet";
  const NavState& nav = *seen.nav;
  out += text("  %-14s %-9s", std::string(to_string(nav.mode)).c_str(),
              std::string(to_string(nav.alignment)).c_str());
  if (known(nav.latitude_rad)) {
    const double sigma =
        std::sqrt(std::max(nav.position_covariance_N_m2[0], nav.position_covariance_N_m2[4]));
    out += text("  %10.6f %11.6f  depth %5.1f m  yaw %5.1f deg  95%% %5.1f m", nav.latitude_rad * kDegrees,
                nav.longitude_rad * kDegrees, nav.depth_m, nav.rpy_rad[2] * kDegrees, 2.45 * sigma);
  }
  if (seen.error) out += text("  error %5.2f m", seen.error->horizontal_m);
  if (seen.monitor && seen.monitor->gps_outage_active)
    out += text("  GPS gone %.0f s", seen.monitor->gps_outage_s);
  if (seen.monitor && seen.monitor->alarms_active > 0)
    out += text("  alarms %u", seen.monitor->alarms_active);
  return out;
}

}  // namespace fathom::demo
