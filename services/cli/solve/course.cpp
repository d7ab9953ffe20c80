#include "cli/solve/course.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string_view>

#include "estimation/aiding/model.hpp"

namespace fathom::cli {
namespace {

// (SOLVE-1): slower, the noise of the velocity is degrees of course; turning, the antenna does not go where
// the vehicle points.
constexpr double kLeastSpeed_m_s = 5.0;
constexpr double kMostTurn_rad = 2.0 * std::numbers::pi / 180.0;
constexpr double kStraightFor_s = 1.0;  // before and after
constexpr double kSigmas = 3.0;
/// A state further behind the instant asked for is no answer to it.
constexpr double kLatest_s = 0.1;

double wrapped(double angle_rad) {
  return std::remainder(angle_rad, 2.0 * std::numbers::pi);
}

bool moves(const GpsSample& fix) {
  return fix.fix != GpsFix::none &&
         std::hypot(fix.velocity_N_m_s[0], fix.velocity_N_m_s[1]) >= kLeastSpeed_m_s;
}

double course_of(const GpsSample& fix) {
  return std::atan2(fix.velocity_N_m_s[1], fix.velocity_N_m_s[0]);
}

// All fixes within kStraightFor_s to one side of the fix at `at`, of which there is one, go its way.
bool straight(const std::vector<GpsSample>& gps, std::size_t at, int step) {
  const DurationNs reach = from_seconds(kStraightFor_s + 0.05);
  bool any = false;
  for (auto i = static_cast<std::ptrdiff_t>(at) + step; i >= 0 && i < std::ssize(gps); i += step) {
    const GpsSample& other = gps[static_cast<std::size_t>(i)];
    if (std::abs(other.header.stamp_ns - gps[at].header.stamp_ns) > reach) break;
    if (!moves(other) || std::abs(wrapped(course_of(other) - course_of(gps[at]))) > kMostTurn_rad)
      return false;
    any = true;
  }
  return any;
}

const StateEstimate* find(const NavDetail& detail, std::string_view name) {
  for (std::uint32_t i = 0; i < detail.count; ++i)
    if (detail.states[i].name == Name(name)) return &detail.states[i];
  return nullptr;
}

}  // namespace

void HeadingErrors::add(double error_rad, double sigma_rad, double whole_sigma_rad) {
  if (!std::isfinite(error_rad) || !(sigma_rad > 0.0) || !(whole_sigma_rad > 0.0)) return;
  ++count_;
  sum_rad_ += error_rad;
  sum2_rad2_ += error_rad * error_rad;
  const double own = std::abs(error_rad) / sigma_rad;
  const double whole = std::abs(error_rad) / whole_sigma_rad;
  worst_own_ = count_ == 1 ? own : std::max(worst_own_, own);
  worst_ = count_ == 1 ? whole : std::max(worst_, whole);
  beyond_own_ += own > kSigmas ? 1U : 0U;
  beyond_ += whole > kSigmas ? 1U : 0U;
}

double HeadingErrors::mean_rad() const {
  return count_ > 0 ? sum_rad_ / static_cast<double>(count_) : kUnknown;
}

double HeadingErrors::rms_rad() const {
  return count_ > 0 ? std::sqrt(sum2_rad2_ / static_cast<double>(count_)) : kUnknown;
}

HeadingWatch::HeadingWatch(const config::FusionConfig& config, const std::vector<GpsSample>& gps) {
  const auto& sensors = config.engine.sensors;
  for (const auto& one : sensors)
    if (one.kind == SourceKind::airspeed && one.enabled) gust_rad_ = one.sideslip_sigma_rad;
  const auto receiver = std::find_if(sensors.begin(), sensors.end(),
                                     [](const auto& one) { return one.kind == SourceKind::gps; });
  if (receiver == sensors.end()) return;
  latency_s_ = receiver->latency_s;
  for (std::size_t i = 0; i < gps.size(); ++i) {
    if (!moves(gps[i]) || !straight(gps, i, -1) || !straight(gps, i, 1)) continue;
    double sigma = 0.0;
    for (std::size_t axis = 0; axis < 2; ++axis)
      sigma = std::max(
          sigma, estimation::sigma_of(receiver->velocity_sigma_m_s[axis], gps[i].velocity_sigma_N_m_s[axis],
                                      receiver->use_sample_sigma));
    straight_.push_back({gps[i].header.stamp_ns, gps[i].velocity_N_m_s[0], gps[i].velocity_N_m_s[1], sigma});
  }
}

bool HeadingWatch::wants_detail(const NavState& state) const {
  return next_ < straight_.size() &&
         state.header.stamp_ns >= straight_[next_].stamp_ns - from_seconds(latency_s_);
}

void HeadingWatch::add(const NavState& state, const NavDetail& detail) {
  if (known(state.latitude_rad) && !found_position_) {
    found_position_ = true;
    first_position_ns_ = state.header.stamp_ns;
  }
  if (state.alignment == AlignmentPhase::aligned && found_position_ && !known(figures_.aligned_after_s))
    figures_.aligned_after_s = to_seconds(state.header.stamp_ns - first_position_ns_);
  while (wants_detail(state)) {
    const Course& course = straight_[next_++];
    const double late_s = to_seconds(state.header.stamp_ns - course.stamp_ns) + latency_s_;
    if (found_position_ && late_s <= kLatest_s) compare(state, detail, course);
  }
}

void HeadingWatch::compare(const NavState& state, const NavDetail& detail, const Course& course) {
  double north = course.north_m_s;
  double east = course.east_m_s;
  const double own = state.rpy_sigma_rad[2];
  double heading = state.rpy_rad[2];
  double others = course.sigma_m_s * course.sigma_m_s;
  const StateEstimate* flow_north = find(detail, "current_north_m_s");
  const StateEstimate* flow_east = find(detail, "current_east_m_s");
  figures_.through_medium = flow_north != nullptr && flow_east != nullptr;
  if (figures_.through_medium) {
    north -= flow_north->value;
    east -= flow_east->value;
    others += std::max(flow_north->sigma * flow_north->sigma, flow_east->sigma * flow_east->sigma);
  }
  const double speed2 = north * north + east * east;
  if (speed2 < kLeastSpeed_m_s * kLeastSpeed_m_s) return;
  others /= speed2;
  if (const StateEstimate* sideslip = find(detail, "sideslip_rad")) {
    heading += sideslip->value;
    others += sideslip->sigma * sideslip->sigma + gust_rad_ * gust_rad_;
  }
  const double error = wrapped(heading - std::atan2(east, north));
  const double whole = std::sqrt(own * own + others);
  figures_.course.add(error, own, whole);
  if (state.alignment == AlignmentPhase::aligned) figures_.course_aligned.add(error, own, whole);
}

void add_heading(const NavState& state, const Truth& reference, HeadingErrors& out) {
  if (!known(state.latitude_rad)) return;
  const double sigma = state.rpy_sigma_rad[2];
  out.add(wrapped(state.rpy_rad[2] - reference.rpy_rad[2]), sigma, sigma);
}

}  // namespace fathom::cli
