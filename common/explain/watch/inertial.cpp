#include <algorithm>
#include <cmath>

#include "base/median.hpp"
#include "explain/watch/silence.hpp"
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

// As of other instruments: shorter ones are gaps and counted, for a loose plug makes many of them.
constexpr DurationNs kSilence_ns = 5 * kNsPerSecond;

void silent(const History& history, const Stream& stream, Findings& out) {
  const double step_s = usual_step_s(stream);
  const DurationNs least_ns =
      std::max(Pause::kLeast_ns, std::isfinite(step_s) ? from_seconds(kGapSteps * step_s) : DurationNs{0});
  for (const Silence& one : silences(history, stream, least_ns)) {
    // What came afterwards, all at once, was late. Whether one that goes on will be short is not known.
    if (!one.to_end && std::min(one.length_ns(), one.stamps_ns) < kSilence_ns) continue;
    out.push_back({.kind = Kind::imu_gap,
                   .weight = Weight::bad,
                   .subject = stream.sensor.str(),
                   .begin_ns = one.begin_ns,
                   .end_ns = one.end_ns,
                   .word = "silent",
                   .said = bridge_said(history, stream.sensor.str(), one.begin_ns, one.end_ns),
                   .figures = {{"for_s", to_seconds(one.length_ns())}, {"to_end", one.to_end ? 1.0 : 0.0}},
                   .evidence = {{"fathom/v1/imu", 0, "no samples in this time"}}});
  }
}

/// No inertial sample in all the time, while fusion waits for them.
void none(const History& history, Findings& out) {
  const auto waits = [](const VerdictRow& row) { return row.kind == VerdictKind::from_the_future; };
  if (!history.states().empty() || std::none_of(history.verdicts().begin(), history.verdicts().end(), waits))
    return;
  const std::string sensor(to_string(SourceKind::imu));
  out.push_back({.kind = Kind::imu_gap,
                 .weight = Weight::bad,
                 .subject = sensor,
                 .begin_ns = history.from_ns(),
                 .end_ns = history.to_ns(),
                 .word = "silent",
                 .said = bridge_said(history, sensor, history.from_ns(), history.to_ns()),
                 .figures = {{"for_s", to_seconds(history.to_ns() - history.from_ns())}, {"to_end", 1.0}},
                 .evidence = {{"fathom/v1/imu", 0, "no samples in this time"}}});
}

/// Whether the first sample after a silence that is told came in this second.
bool ends_silence(const Second& second, const Stream& stream, const Findings& out) {
  return std::any_of(out.begin(), out.end(), [&](const Finding& one) {
    return one.kind == Kind::imu_gap && one.word == "silent" && one.subject == stream.sensor.view() &&
           one.end_ns >= second.at_ns && one.end_ns < second.at_ns + kNsPerSecond;
  });
}

void gaps(const Stream& stream, Findings& out) {
  const double step_s = usual_step_s(stream);
  std::uint64_t count = 0;
  double longest_s = 0.0;
  Finding found{.kind = Kind::imu_gap, .subject = stream.sensor.str()};
  for (const Second& one : stream.seconds) {
    // The instants of recorded steps are those of stamps.
    if (!(one.stamp_step_s > kGapSteps * step_s)) continue;
    if (ends_silence(one, stream, out)) continue;
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
  bool any = false;
  for (const Stream& stream : history.streams()) {
    if (stream.kind != SourceKind::imu) continue;
    any = any || stream.samples > 0;
    silent(history, stream, out);
    if (stream.seconds.size() < 3) continue;
    const bool jumped = std::any_of(out.begin(), out.end(), [&](const Finding& one) {
      return one.kind == Kind::clock_jump && one.subject == stream.sensor.view();
    });
    if (!jumped) late(stream, out);
    gaps(stream, out);
  }
  if (!any) none(history, out);
}

}  // namespace fathom::explain
