#include <algorithm>
#include <cmath>
#include <map>

#include "explain/watch/watches.hpp"

namespace fathom::explain {
namespace {

// The least step of a host's clock: time servers slew what is less than 128 ms.
constexpr double kHostStep_s = 0.128;
constexpr DurationNs kTogether_ns = 3 * kNsPerSecond;  // services of a host notice one step within this

// Ages are compared over this many seconds before and after. What follows has to lie beyond all that came
// before by the width of that, and by what no bus and no queue adds to every sample.
constexpr std::size_t kBefore = 10;
constexpr std::size_t kAfter = 3;
constexpr double kLeastOffset_s = 0.2;

void hosts(const History& history, Findings& out) {
  std::map<std::uint32_t, const LifeSign*> last;
  std::map<std::string, std::size_t> found;  // by host
  for (const LifeSign& sign : history.life_signs()) {
    const LifeSign* before = std::exchange(last[sign.service], &sign);
    if (before == nullptr || before->started_ns != sign.started_ns || before->host != sign.host) continue;
    const double step_s = to_seconds(sign.utc_offset_ns - before->utc_offset_ns);
    if (std::abs(step_s) < kHostStep_s) continue;
    const auto same = found.find(sign.host);
    if (same != found.end() && sign.log_ns - out[same->second].begin_ns < kTogether_ns) {
      ++out[same->second].evidence.front().count;
      continue;
    }
    found[sign.host] = out.size();
    out.push_back({.kind = Kind::clock_set,
                   .subject = sign.host,
                   .begin_ns = sign.log_ns,
                   .end_ns = sign.log_ns,
                   .figures = {{"step_s", step_s}},
                   .evidence = {{"fathom/v1/service_status", 1, "utc_offset_ns changed"}}});
  }
}

/// Samples of all writers together, by seconds of arrival.
std::vector<Second> together(const Stream& stream) {
  std::vector<Second> out;
  for (const Second& one : stream.seconds) {
    if (out.empty() || out.back().at_ns != one.at_ns) {
      out.push_back(one);
      continue;
    }
    Second& sum = out.back();
    sum.count += one.count;
    sum.age_sum_s += one.age_sum_s;
    sum.age_low_s = std::min(sum.age_low_s, one.age_low_s);
    sum.age_high_s = std::max(sum.age_high_s, one.age_high_s);
    if (one.stamp_step_s > sum.stamp_step_s) {
      sum.stamp_step_s = one.stamp_step_s;
      sum.stamp_before_ns = one.stamp_before_ns;
      sum.arrival_after_s = one.arrival_after_s;
    }
    sum.stamp_step_low_s = std::min(sum.stamp_step_low_s, one.stamp_step_low_s);
    sum.arrival_step_s = std::max(sum.arrival_step_s, one.arrival_step_s);
  }
  return out;
}

/// Whether a stream's ages jump with second i; by how much the stamps moved.
double jump_s(const std::vector<Second>& rows, std::size_t i) {
  double low = rows[i - 1].age_low_s;
  double high = rows[i - 1].age_high_s;
  double sum = 0.0;
  std::uint64_t count = 0;
  for (std::size_t k = i - std::min(i, kBefore); k < i; ++k) {
    low = std::min(low, rows[k].age_low_s);
    high = std::max(high, rows[k].age_high_s);
    sum += rows[k].age_sum_s;
    count += rows[k].count;
  }
  const double margin = std::max(kLeastOffset_s, high - low);
  double after_low = rows[i + 1].age_low_s;
  double after_high = rows[i + 1].age_high_s;
  double after_sum = 0.0;
  std::uint64_t after = 0;
  for (std::size_t k = i + 1; k <= i + kAfter; ++k) {
    after_low = std::min(after_low, rows[k].age_low_s);
    after_high = std::max(after_high, rows[k].age_high_s);
    after_sum += rows[k].age_sum_s;
    after += rows[k].count;
  }
  if (!(after_low > high + margin) && !(after_high < low - margin)) return 0.0;
  // A burst after a stall scatters.
  if (after_high - after_low > margin) return 0.0;
  const double shift_s = after_sum / static_cast<double>(after) - sum / static_cast<double>(count);
  // Older by a pause of the arrival: they come late, and the clock is right.
  const double pause_s =
      std::max({rows[i - 1].arrival_step_s, rows[i].arrival_step_s, rows[i + 1].arrival_step_s});
  const double usual_s = rows[i - 1].count > 0 ? 1.0 / rows[i - 1].count : 1.0;
  if (shift_s > 0.0 && pause_s - usual_s > 0.5 * shift_s) return 0.0;
  // Younger again after they were late: the stamps did not step.
  const double step_s = std::max({rows[i - 1].stamp_step_s, rows[i].stamp_step_s, rows[i + 1].stamp_step_s});
  if (shift_s < 0.0 && step_s - usual_s < -0.5 * shift_s) return 0.0;
  return -shift_s;
}

void stamps(const Stream& stream, Findings& out) {
  const std::vector<Second> rows = together(stream);
  double off_s = 0.0;
  std::size_t open = out.size();  // the jump whose time goes on
  for (std::size_t i = 3; i + kAfter < rows.size(); ++i) {
    const double step_s = jump_s(rows, i);
    if (step_s == 0.0) continue;
    if (open < out.size()) out[open].end_ns = rows[i].at_ns;
    open = out.size();
    off_s += step_s;
    out.push_back({.kind = Kind::clock_jump,
                   .weight = stream.kind == SourceKind::imu ? Weight::bad : Weight::caution,
                   .subject = stream.sensor.str(),
                   .begin_ns = rows[i].at_ns,
                   .end_ns = rows[i].at_ns,
                   .word = std::string(to_string(stream.kind)),
                   .figures = {{"step_s", step_s},
                               {"age_before_s", rows[i - 1].age_s()},
                               {"age_after_s", rows[i + 1].age_s()}},
                   .evidence = {{"fathom/v1/" + std::string(to_string(stream.kind)), rows[i + 1].count,
                                 "stamp_ns against received_ns"}}});
    i += kAfter + 1;
  }
  // A clock that was not set back is wrong to the end.
  if (open < out.size() && std::abs(off_s) > kLeastOffset_s)
    out[open].end_ns = rows.back().at_ns + kNsPerSecond;
}

}  // namespace

void watch_clocks(const History& history, Findings& out) {
  hosts(history, out);
  for (const Stream& stream : history.streams()) stamps(stream, out);
}

}  // namespace fathom::explain
