#include <algorithm>
#include <cmath>

#include "base/median.hpp"
#include "explain/watch/watches.hpp"

namespace fathom::explain {
namespace {

// What guidance notices: five steps of a unit of 100 Hz.
constexpr double kLate_s = 0.05;
constexpr double kVeryLate_s = 0.25;
constexpr std::size_t kSecondsLate = 2;  // one late second may be a busy machine
constexpr double kGapSteps = 5.0;        // of the usual step; fewer are noise of the arrival

double usual_step_s(const Stream& stream) {
  std::vector<double> rates;
  for (const Second& one : stream.seconds) rates.push_back(one.count);
  const double rate = median(rates);
  return rate > 0.0 ? 1.0 / rate : kUnknown;
}

/// Ages as they are when all is well: the lower tenth.
double usual_age_s(const Stream& stream) {
  std::vector<double> ages;
  for (const Second& one : stream.seconds) ages.push_back(one.age_s());
  if (ages.empty()) return 0.0;
  const auto tenth = ages.begin() + static_cast<std::ptrdiff_t>(ages.size() / 10);
  std::nth_element(ages.begin(), tenth, ages.end());
  return *tenth;
}

void late(const Stream& stream, Findings& out) {
  const double usual_s = usual_age_s(stream);
  const double bound_s = std::min(usual_s, kLate_s) + kLate_s;
  struct Run {
    TimeNs begin_ns = 0;
    TimeNs end_ns = 0;
    std::size_t seconds = 0;
    double most_s = 0.0;
    std::uint64_t samples = 0;
  } run;
  const auto close = [&] {
    if (run.seconds >= kSecondsLate) {
      out.push_back({.kind = Kind::imu_late,
                     .weight = run.most_s > kVeryLate_s ? Weight::bad : Weight::caution,
                     .subject = stream.sensor.str(),
                     .begin_ns = run.begin_ns,
                     .end_ns = run.end_ns,
                     .figures = {{"age_s", run.most_s}, {"usual_s", std::min(usual_s, kLate_s)}},
                     .evidence = {{"fathom/v1/imu", run.samples, "received_ns minus stamp_ns"}}});
    }
    run = {};
  };
  for (const Second& one : stream.seconds) {
    // Whole seconds: a stall of a moment is a gap of the arrival, no lateness.
    if (one.age_s() > bound_s || one.age_low_s + one.bus_low_s > bound_s) {
      if (run.seconds > 0 && one.at_ns > run.end_ns + 2 * kNsPerSecond) close();
      if (run.seconds++ == 0) run.begin_ns = one.at_ns;
      run.end_ns = one.at_ns + kNsPerSecond;
      run.most_s = std::max({run.most_s, one.age_s(), one.age_low_s + one.bus_low_s});
      run.samples += one.count;
    } else {
      close();
    }
  }
  close();
}

void gaps(const Stream& stream, Findings& out) {
  const double step_s = usual_step_s(stream);
  std::uint64_t count = 0;
  double longest_s = 0.0;
  Finding found{.kind = Kind::imu_gap, .subject = stream.sensor.str()};
  for (const Second& one : stream.seconds) {
    // The instants of recorded steps are those of stamps.
    if (!(one.stamp_step_s > kGapSteps * step_s)) continue;
    if (count++ == 0) found.begin_ns = one.stamp_before_ns;
    found.end_ns = one.stamp_before_ns + from_seconds(one.stamp_step_s);
    longest_s = std::max(longest_s, one.stamp_step_s);
  }
  if (count == 0) return;
  found.weight = longest_s > 1.0 ? Weight::bad : Weight::caution;
  found.figures = {{"gaps", static_cast<double>(count)}, {"longest_s", longest_s}, {"step_s", step_s}};
  found.evidence = {{"fathom/v1/imu", count, "steps of stamp_ns"}};
  out.push_back(std::move(found));
}

}  // namespace

void watch_inertial(const History& history, Findings& out) {
  for (const Stream& stream : history.streams()) {
    if (stream.kind != SourceKind::imu || stream.seconds.size() < 3) continue;
    const bool jumped = std::any_of(out.begin(), out.end(), [&](const Finding& one) {
      return one.kind == Kind::clock_jump && one.subject == stream.sensor.view();
    });
    if (!jumped) late(stream, out);
    gaps(stream, out);
  }
}

}  // namespace fathom::explain
