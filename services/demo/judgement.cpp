#include "demo/judgement.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string_view>

#include "base/units.hpp"
#include "health/text.hpp"

namespace fathom::demo {
namespace {

// Of the monitor after its limit: one period plus what a loaded machine needs.
constexpr double kFlagToleranceS = 1.5;
// From the first fix to the all-clear: the monitor wants some consecutive fixes.
constexpr double kClearToleranceS = 10.0;
// Of the states that the inertial sensor's rate asks for.
constexpr double kLeastRateShare = 0.98;
constexpr double kLeastValidShare = 0.99;

void judge_accuracy(const Observation& seen, const Demands& demands, std::vector<Finding>& out) {
  const auto& limits = demands.limits;
  const auto below = [&out](double value, double limit, const char* what, double factor, const char* unit) {
    if (known(limit)) {
      out.push_back({value <= limit, health::sentence("%s %.3g %s, limit %.3g %s", what, value * factor, unit,
                                                      limit * factor, unit)});
    }
  };
  if (seen.score.count == 0) {
    out.push_back({false, "no navigation state with a position to compare with the truth"});
    return;
  }
  below(seen.score.horizontal_m.rms, limits.horizontal_rms_m, "horizontal error rms", 1.0, "m");
  below(seen.score.horizontal_m.max, limits.horizontal_max_m, "horizontal error max", 1.0, "m");
  below(std::max(seen.score.rpy_rad[0].rms, seen.score.rpy_rad[1].rms), limits.roll_pitch_rms_rad,
        "roll and pitch error rms", kDegPerRad, "deg");
  below(seen.score.rpy_rad[2].rms, limits.yaw_rms_rad, "yaw error rms", kDegPerRad, "deg");
  if (known(demands.end_error_share) && seen.distance_m > 0.0) {
    below(seen.score.horizontal_m.end / seen.distance_m, demands.end_error_share,
          "horizontal end error of distance travelled", 100.0, "%");
  }
}

void judge_outages(const Observation& seen, const Demands& demands, std::vector<Finding>& out) {
  int complete = 0;
  for (const GpsOutage& outage : seen.outages) {
    const bool over = known(outage.end_s);
    const double ended_s = to_seconds(seen.ended_ns - seen.began_ns);
    const double length_s = (over ? outage.end_s : ended_s) - outage.start_s;
    // One that ended within the tolerance of the limit need not have been flagged.
    if (!known(outage.flagged_after_s)) {
      if (length_s > demands.gps_limit_s + kFlagToleranceS) {
        out.push_back({false, health::sentence("GPS outage at %.1f s of %.1f s was not flagged",
                                               outage.start_s, length_s)});
      }
      continue;
    }
    out.push_back({outage.flagged_after_s <= demands.gps_limit_s + kFlagToleranceS,
                   health::sentence("GPS outage at %.1f s flagged after %.2f s, limit %.2f s", outage.start_s,
                                    outage.flagged_after_s, demands.gps_limit_s + kFlagToleranceS)});
    if (known(outage.cleared_after_s)) {
      ++complete;
      out.push_back({outage.cleared_after_s <= kClearToleranceS,
                     health::sentence("GPS outage at %.1f s cleared %.2f s after the first fix, limit %.0f s",
                                      outage.start_s, outage.cleared_after_s, kClearToleranceS)});
    } else if (outage.cleared_without_fix) {
      out.push_back(
          {false, health::sentence("GPS outage at %.1f s was cleared without a usable fix", outage.start_s)});
    } else if (over && ended_s - outage.end_s > kClearToleranceS) {
      out.push_back(
          {false,
           health::sentence(
               "GPS outage at %.1f s was never cleared, although fixes came again %.1f s before the end",
               outage.start_s, ended_s - outage.end_s)});
    }
  }
  if (demands.whole_run && demands.gps_expected && demands.limits.gps_outages_at_least > 0) {
    out.push_back({complete >= demands.limits.gps_outages_at_least,
                   health::sentence("%d GPS outages flagged and cleared, at least %d expected", complete,
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
      out.push_back(
          {false, health::sentence("service %s was started again %d times", name.c_str(), restarts->second)});
    } else if (!record.was_healthy || record.fell) {
      out.push_back({false, "service " + name + " did not stay healthy: " + record.text});
    } else if (record.longest_silence_s > demands.silence_s + kFlagToleranceS) {
      out.push_back(
          {false, health::sentence("service %s gave no life sign for %.1f s, limit %.1f s", name.c_str(),
                                   record.longest_silence_s, demands.silence_s + kFlagToleranceS)});
    }
  }
  if (out.size() == before)
    out.push_back({true, health::sentence("%zu services stayed healthy", demands.services.size())});
  for (const std::string& name : demands.killed)
    out.push_back({false, "service " + name + " did not stop when asked"});
}

bool stands_for(const std::string& pattern, const std::string& name) {
  if (pattern.empty() || pattern.back() != '*') return pattern == name;
  return name.starts_with(std::string_view(pattern).substr(0, pattern.size() - 1));
}

void judge_alarms(const Observation& seen, const Demands& demands, std::vector<Finding>& out) {
  const std::size_t before = out.size();
  for (const auto& [name, alarm] : seen.alarms) {
    const auto& expected = demands.expected_alarms;
    if (std::any_of(expected.begin(), expected.end(),
                    [&name = name](const std::string& pattern) { return stands_for(pattern, name); }))
      continue;
    out.push_back({false, "alarm " + name + " (" + std::string(to_string(alarm.severity)) +
                              ") was raised and is not expected here: " + alarm.text});
  }
  if (out.size() == before) out.push_back({true, "no alarm but the expected ones"});
}

void judge_states(const Observation& seen, const Demands& demands, std::vector<Finding>& out) {
  const double rate = rate_hz(seen, demands);
  out.push_back({rate >= kLeastRateShare * demands.nav_rate_hz,
                 health::sentence("navigation state at %.1f Hz over the run, inertial sensor at %.0f Hz",
                                  rate, demands.nav_rate_hz)});
  const double share = valid_share(seen, demands);
  if (!known(share)) {
    out.push_back({false, "no valid navigation state: the run ended before one was due"});
    return;
  }
  out.push_back({share >= kLeastValidShare,
                 health::sentence(
                     "%.2f %% of the navigation states due were there and valid, at least %.0f %% expected",
                     share * 100.0, kLeastValidShare * 100.0)});
}

}  // namespace

double rate_hz(const Observation& seen, const Demands& demands) {
  TimeNs due_ns = seen.vehicle_began_ns() + from_seconds(demands.startup_s);
  if (seen.first_nav_ns != 0) due_ns = std::min(due_ns, seen.first_nav_ns);
  if (seen.nav_states < 2 || seen.ended_ns <= due_ns) return 0.0;
  return static_cast<double>(seen.nav_states - 1) / to_seconds(seen.ended_ns - due_ns);
}

double valid_share(const Observation& seen, const Demands& demands) {
  const double aligned_s = demands.limits.aligned_within_s;
  TimeNs due_ns = seen.vehicle_began_ns() + from_seconds(known(aligned_s) ? aligned_s : demands.startup_s);
  if (seen.first_valid_ns != 0) due_ns = std::min(due_ns, seen.first_valid_ns);
  due_ns = std::max(due_ns, seen.began_ns + from_seconds(demands.limits.score_from_s));
  if (seen.ended_ns <= due_ns) return kUnknown;
  const double due = to_seconds(seen.ended_ns - due_ns) * demands.nav_rate_hz;
  // A sensor that is faster than it should be does not make up for states that are not valid.
  return static_cast<double>(seen.valid_states) / std::max(due, static_cast<double>(seen.states_since_valid));
}

std::vector<Finding> judge(const Observation& seen, const Demands& demands) {
  std::vector<Finding> out;
  judge_states(seen, demands, out);
  if (demands.alignment_expected) {
    const double limit = known(demands.limits.aligned_within_s) ? demands.limits.aligned_within_s : 1e9;
    const double after_s = seen.aligned_after_s();
    out.push_back({after_s <= limit, known(after_s) ? health::sentence("aligned after %.1f s", after_s)
                                                    : std::string("alignment was not reached")});
  }
  judge_accuracy(seen, demands, out);
  judge_outages(seen, demands, out);
  judge_services(seen, demands, out);
  judge_alarms(seen, demands, out);
  return out;
}

}  // namespace fathom::demo
