#include "demo/judgement.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>

namespace fathom::demo {
namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;
// Of the monitor after its limit: one period plus what a loaded machine needs.
constexpr double kFlagToleranceS = 1.5;
// From the first fix to the all-clear: the monitor wants some consecutive fixes.
constexpr double kClearToleranceS = 10.0;

template <class... Args>
std::string text(const char* format, Args... args) {
  std::array<char, 256> out{};
  std::snprintf(out.data(), out.size(), format, args...);
  return out.data();
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

}  // namespace

double rate_hz(const Observation& seen) {
  if (seen.nav_states < 2 || seen.last_nav_ns <= seen.first_nav_ns) return 0.0;
  return static_cast<double>(seen.nav_states - 1) / to_seconds(seen.last_nav_ns - seen.first_nav_ns);
}

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

}  // namespace fathom::demo
