#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "explain/watch/watches.hpp"
#include "samples/alignment/help.hpp"

namespace fathom::explain {
namespace {

constexpr DurationNs kWindow_ns = 10 * kNsPerSecond;
constexpr std::size_t kWindowFixes = 5;              // of a window
constexpr DurationNs kBeside_ns = kNsPerSecond / 2;  // between a fix and the DVL beside it
constexpr double kSlow_m_s = 0.5;                    // below it a course means little
// Mountings of a DVL and a compass are known to some degrees; less than this is nothing to name.
constexpr double kLeast_rad = 5.0 * std::numbers::pi / 180.0;
constexpr double kSigmas = 5.0;
constexpr double kSpeedApart = 0.1;  // of the speed: a heading turns a velocity, it does not stretch it
// A wrong heading turns the velocity on every course to the same side. A velocity that is added, of a
// receiver that is led away or of a current, turns it to the same side without stretching it only on courses
// that lie nearer together than this.
constexpr double kCourses_rad = 2.0 * std::numbers::pi / 3.0;

double turned(double to, double from) {
  return std::remainder(to - from, 2.0 * std::numbers::pi);
}

struct Window {
  TimeNs begin_ns = 0;
  TimeNs end_ns = 0;
  std::vector<double> off_rad;
  double course_rad = 0.0;
  double yaw_sigma_rad = 0.0;
  double speed_ratio = 0.0;  // sum

  [[nodiscard]] double mean_rad() const {
    // About the first, so that the turn over pi does not tear them apart.
    double sum = 0.0;
    for (const double one : off_rad) sum += turned(one, off_rad.front());
    return turned(off_rad.front() + sum / static_cast<double>(off_rad.size()), 0.0);
  }
  [[nodiscard]] bool is_off() const {
    const double mean = mean_rad();
    double square = 0.0;
    for (const double one : off_rad) square += std::pow(turned(one, mean), 2);
    const auto n = static_cast<double>(off_rad.size());
    if (std::abs(speed_ratio / n - 1.0) > kSpeedApart) return false;
    const double sigma = std::sqrt(square / n / n + yaw_sigma_rad * yaw_sigma_rad);
    return std::abs(mean) > std::max(kLeast_rad, kSigmas * sigma);
  }
};

/// By how much navigation's heading is wrong, fix by fix: what GPS has of the course against what the DVL has
/// of it with navigation's heading. The DVL's mounting stands in its innovation and falls out.
class Compared {
 public:
  Compared(const History& history, const Track& track, std::size_t dvl)
      : history_(history), track_(track), verdicts_(judged(history, dvl)) {
    for (const DvlRow& row : history.dvl())
      if (row.stream == dvl) samples_.push_back(&row);
    std::stable_sort(samples_.begin(), samples_.end(),
                     [](const DvlRow* a, const DvlRow* b) { return a->stamp_ns < b->stamp_ns; });
  }

  [[nodiscard]] std::vector<Window> windows() const {
    std::vector<Window> out;
    Window window;
    const auto close = [&] {
      if (window.off_rad.size() >= kWindowFixes) out.push_back(window);
      window = {};
    };
    for (const FixRow& fix : history_.fixes()) {
      if (window.begin_ns != 0 && fix.stamp_ns - window.begin_ns > kWindow_ns) close();
      if (fix.fix < GpsFix::fix_2d) continue;
      const StateRow* state = track_.at(fix.stamp_ns);
      if (state == nullptr || !navigating(*state)) continue;
      const double gps_m_s = std::hypot(fix.velocity_N_m_s[0], fix.velocity_N_m_s[1]);
      const double own_m_s = std::hypot(state->velocity_N_m_s[0], state->velocity_N_m_s[1]);
      if (!(gps_m_s > kSlow_m_s) || !(own_m_s > kSlow_m_s)) continue;
      double dvl_off_rad = 0.0;
      double dvl_ratio = 1.0;
      if (!beside(fix.stamp_ns, dvl_off_rad, dvl_ratio)) continue;
      const double course_rad = std::atan2(fix.velocity_N_m_s[1], fix.velocity_N_m_s[0]);
      const double own_rad = std::atan2(state->velocity_N_m_s[1], state->velocity_N_m_s[0]);
      if (window.begin_ns == 0) window.begin_ns = fix.stamp_ns;
      window.end_ns = fix.stamp_ns;
      window.course_rad = course_rad;
      window.yaw_sigma_rad = std::isfinite(state->yaw_sigma_rad) ? state->yaw_sigma_rad : 0.0;
      window.off_rad.push_back(turned(own_rad, course_rad) + dvl_off_rad);
      window.speed_ratio += gps_m_s / own_m_s / dvl_ratio;
    }
    close();
    return out;
  }

 private:
  /// Of the DVL sample nearest to an instant: the turn from what navigation expected to what it measured, and
  /// the ratio of the two speeds.
  bool beside(TimeNs stamp_ns, double& off_rad, double& ratio) const {
    const auto by_stamp = [](const auto* row, TimeNs t) { return row->stamp_ns < t; };
    auto verdict = std::lower_bound(verdicts_.begin(), verdicts_.end(), stamp_ns - kBeside_ns, by_stamp);
    const VerdictRow* best = nullptr;
    for (; verdict != verdicts_.end() && (*verdict)->stamp_ns <= stamp_ns + kBeside_ns; ++verdict) {
      const VerdictRow& row = **verdict;
      if (row.dimensions < 2 || (row.kind != VerdictKind::used && !is_refusal(row.kind))) continue;
      if (history_.name(row.model) != "dvl_velocity") continue;  // beams have axes of their own
      if (best == nullptr || std::abs(row.stamp_ns - stamp_ns) < std::abs(best->stamp_ns - stamp_ns))
        best = &row;
    }
    if (best == nullptr) return false;
    const auto sample = std::lower_bound(samples_.begin(), samples_.end(), best->stamp_ns, by_stamp);
    if (sample == samples_.end() || (*sample)->stamp_ns != best->stamp_ns) return false;
    const auto& v = (*sample)->velocity_D_m_s;
    const std::array<double, 2> expected{v[0] + best->innovation[0], v[1] + best->innovation[1]};
    const double expected_m_s = std::hypot(expected[0], expected[1]);
    if (!(std::hypot(v[0], v[1]) > kSlow_m_s) || !(expected_m_s > kSlow_m_s)) return false;
    off_rad = turned(std::atan2(v[1], v[0]), std::atan2(expected[1], expected[0]));
    ratio = std::hypot(v[0], v[1]) / expected_m_s;
    return true;
  }

  const History& history_;
  const Track& track_;
  Judged verdicts_;
  std::vector<const DvlRow*> samples_;
};

/// The compass that navigation goes by; null where there is none.
const Stream* compass_of(const History& history, TimeNs from_ns, TimeNs to_ns) {
  std::vector<std::uint64_t> used(history.streams().size());
  for (const VerdictRow& row : history.verdicts())
    if (row.kind == VerdictKind::used && row.stamp_ns >= from_ns && row.stamp_ns <= to_ns) ++used[row.stream];
  for (std::size_t i = 0; i < used.size(); ++i)
    if (history.streams()[i].kind == SourceKind::heading && used[i] >= kWindowFixes)
      return &history.streams()[i];
  return nullptr;
}

/// The begin of what was there from the first heading on; `found_ns` where nothing navigated before.
TimeNs from_the_first_heading_ns(const History& history, TimeNs found_ns) {
  const auto first = std::find_if(history.states().begin(), history.states().end(),
                                  [](const StateRow& row) { return navigating(row); });
  return first == history.states().end() ? found_ns : std::min(found_ns, first->at_ns);
}

void say(const History& history, const std::vector<Window>& windows, std::size_t from, std::size_t to,
         const std::string& dvl, Findings& out) {
  double apart_rad = 0.0;
  double sum = 0.0;
  double fixes = 0.0;
  for (std::size_t i = from; i < to; ++i) {
    for (std::size_t k = from; k < i; ++k)
      apart_rad = std::max(apart_rad, std::abs(turned(windows[i].course_rad, windows[k].course_rad)));
    sum += windows[i].mean_rad();
    fixes += static_cast<double>(windows[i].off_rad.size());
  }
  const double mean = sum / static_cast<double>(to - from);
  if (apart_rad < kCourses_rad) return;
  const TimeNs begin_ns = windows[from].begin_ns;
  const TimeNs end_ns = windows[to - 1].end_ns;
  const Stream* compass = compass_of(history, begin_ns, end_ns);
  Finding found{.kind = Kind::wrong_heading,
                .weight = Weight::bad,
                .subject = compass != nullptr ? compass->sensor.str() : "navigation",
                .begin_ns = begin_ns,
                .end_ns = end_ns,
                .word = compass != nullptr ? "course_compass" : "course",
                .figures = {{"first", mean},
                            {"for_s", to_seconds(end_ns - begin_ns)},
                            {"count", fixes},
                            {"courses_apart", apart_rad}},
                .evidence = {{"fathom/v1/gps", static_cast<std::uint64_t>(fixes), "velocity_N_m_s"},
                             {"fathom/v1/dvl", static_cast<std::uint64_t>(fixes), dvl}}};
  // Where it was wrong as soon as it could be told it was wrong from the first heading on.
  if (from == 0) found.begin_ns = from_the_first_heading_ns(history, begin_ns);
  out.push_back(std::move(found));
}

/// Of a heading that navigation itself found to have been wrong from the start.
void say_start(const History& history, Findings& out) {
  const AlignmentRow* found = nullptr;
  for (const AlignmentRow& row : history.alignment())
    if (row.start_error_rad != 0.0 && (found == nullptr || row.start_error_rad != found->start_error_rad))
      found = &row;
  if (found == nullptr) return;
  const TimeNs begin_ns = from_the_first_heading_ns(history, found->log_ns);
  const Stream* compass = compass_of(history, begin_ns, found->log_ns);
  out.push_back(
      {.kind = Kind::wrong_heading,
       .weight = Weight::bad,
       .subject = compass != nullptr ? compass->sensor.str() : "navigation",
       .begin_ns = begin_ns,
       .end_ns = found->log_ns,
       .word = compass != nullptr ? "start_compass" : "start",
       .figures = {{"first", found->start_error_rad}, {"for_s", to_seconds(found->log_ns - begin_ns)}},
       .evidence = {{"fathom/v1/alignment", 1, std::string(kStartHeadingError)}}});
}

}  // namespace

void watch_course(const History& history, const Track& track, Findings& out) {
  for (std::size_t i = 0; i < history.streams().size(); ++i) {
    if (history.streams()[i].kind != SourceKind::dvl) continue;
    const std::vector<Window> windows = Compared(history, track, i).windows();
    for (std::size_t from = 0; from < windows.size();) {
      std::size_t to = from;
      while (to < windows.size() && windows[to].is_off() &&
             (windows[to].mean_rad() > 0.0) == (windows[from].mean_rad() > 0.0))
        ++to;
      if (to > from) say(history, windows, from, to, history.streams()[i].sensor.str(), out);
      from = std::max(to, from + 1);
    }
  }
  say_start(history, out);
}

}  // namespace fathom::explain
