#include "estimation/alignment/stability_gate.hpp"

#include <algorithm>
#include <cmath>

namespace fathom::estimation {
namespace {

// Sums of sample intervals meet a hold time to rounding.
constexpr double kGateRounding_s = 1e-6;
constexpr double kWider = 1.2;
constexpr double kJitter_s = 0.5;          // memory of the noise that vibration makes
constexpr double kFlow_s = 4.0;            // memory of the side force that the flow makes
constexpr double kSlow_s = 1.0;            // slower changes of it are not the flow
constexpr double kManoeuvre_rad_s = 0.05;  // nor what happens while it turns faster

constexpr std::size_t at(StabilityCondition condition) {
  return static_cast<std::size_t>(condition);
}

}  // namespace

std::string_view to_string(StabilityCondition condition) {
  switch (condition) {
    case StabilityCondition::roll:
      return "roll_rad";
    case StabilityCondition::pitch:
      return "pitch_rad";
    case StabilityCondition::depth:
      return "depth_error_m";
    case StabilityCondition::rate_y:
      return "rate_y_rad_s";
    case StabilityCondition::force_x:
      return "force_x_m_s2";
    case StabilityCondition::rate_z:
      return "rate_z_rad_s";
    case StabilityCondition::gravity:
      return "gravity_defect_m_s2";
    case StabilityCondition::speed_slope:
    case StabilityCondition::count:
      break;
  }
  return "speed_slope_m_s2";
}

std::string_view to_string(StabilityReset reset) {
  switch (reset) {
    case StabilityReset::none:
      return "none";
    case StabilityReset::not_finite:
      return "not_finite";
    case StabilityReset::gap:
      return "gap";
    case StabilityReset::stale:
      return "stale";
    case StabilityReset::repeated:
      return "repeated";
    case StabilityReset::no_depth:
      return "no_depth";
    case StabilityReset::no_speed:
      return "no_rpm";
    case StabilityReset::condition:
      return "condition";
    case StabilityReset::spread:
      return "spread";
    case StabilityReset::level:
      return "level";
    case StabilityReset::disagreement:
      break;
  }
  return "disagreement";
}

bool StabilityGate::Watched::met() const {
  return held_s >= needed_s - kGateRounding_s;
}

StabilityGate::StabilityGate(const StabilityConfig& config) : config_(config) {
  const auto set = [this](StabilityCondition condition, double limit, double hold_s) {
    watched_[at(condition)].limit = limit;
    watched_[at(condition)].needed_s = hold_s;
  };
  set(StabilityCondition::roll, config.roll_rad, config.roll_hold_s);
  set(StabilityCondition::pitch, config.pitch_rad, config.pitch_hold_s);
  set(StabilityCondition::depth, config.depth_error_m, config.depth_hold_s);
  set(StabilityCondition::rate_y, config.rate_y_rad_s, config.rate_y_hold_s);
  set(StabilityCondition::force_x, config.force_x_m_s2, config.force_x_hold_s);
  set(StabilityCondition::rate_z, config.rate_z_rad_s, config.rate_z_hold_s);
  set(StabilityCondition::gravity, config.gravity_defect_m_s2, config.gravity_hold_s);
  set(StabilityCondition::speed_slope, config.speed_slope_m_s2, config.speed_slope_hold_s);
}

void StabilityGate::reset(StabilityReset reason) {
  for (Watched& one : watched_) one.held_s = 0.0;
  phase_ = Phase::waiting;
  averaged_s_ = 0.0;
  samples_ = 0;
  last_reset_ = reason;
}

void StabilityGate::fail(StabilityReset reason) {
  // What was missing from the beginning has set nothing back.
  const bool ran =
      std::any_of(watched_.begin(), watched_.end(), [](const Watched& w) { return w.held_s > 0.0; });
  reset(reason);
  if (!ran && reason != last_fault_) return;
  last_fault_ = reason;
  since_fault_s_ = 0.0;
}

StabilityReset StabilityGate::fault(const StabilityInput& in) const {
  if (!in.rate_B_rad_s.allFinite() || !in.force_B_m_s2.allFinite() || !std::isfinite(in.roll_rad) ||
      !std::isfinite(in.pitch_rad) || !std::isfinite(in.dt_s) || !std::isfinite(in.speed_slope_m_s2))
    return StabilityReset::not_finite;
  if (in.dt_s <= 0.0) return StabilityReset::stale;
  if (in.dt_s > config_.max_gap_s + kGateRounding_s) return StabilityReset::gap;
  if (has_before_ && in.rate_B_rad_s == raw_rate_ && in.force_B_m_s2 == raw_force_)
    return StabilityReset::repeated;
  if (!std::isfinite(in.depth_error_m)) return StabilityReset::no_depth;
  if (!std::isfinite(in.speed_m_s)) return StabilityReset::no_speed;
  return StabilityReset::none;
}

void StabilityGate::watch(StabilityCondition condition, double value, double dt_s) {
  Watched& one = watched_[at(condition)];
  one.value = value;
  one.held_s = std::abs(value) <= one.limit ? one.held_s + dt_s : 0.0;
}

double StabilityGate::vibration() const {
  return jitter_ * light_share_;
}

void StabilityGate::smooth(const StabilityInput& in) {
  if (!in.rate_B_rad_s.allFinite() || !in.force_B_m_s2.allFinite()) {
    primed_ = has_before_ = false;
    return;
  }
  const bool chained = primed_ && in.dt_s > 0.0 && in.dt_s <= config_.max_gap_s + kGateRounding_s;
  const auto keep = [&](double time_s) {
    return chained && time_s > 0.0 ? std::exp(-in.dt_s / time_s) : 0.0;
  };
  if (chained) {
    const double change = (in.force_B_m_s2 - raw_force_).squaredNorm() / 6.0;
    jitter_ += (1.0 - keep(kJitter_s)) * (change - jitter_);
  }
  raw_rate_ = in.rate_B_rad_s;
  raw_force_ = in.force_B_m_s2;
  rate_ += (1.0 - keep(config_.low_pass_s)) * (raw_rate_ - rate_);
  force_ += (1.0 - keep(config_.low_pass_s)) * (raw_force_ - force_);
  smooth_side(in, keep(config_.spread_low_pass_s), keep(kSlow_s), chained ? keep(kFlow_s) : 1.0);
  primed_ = has_before_ = true;
}

void StabilityGate::smooth_side(const StabilityInput& in, double light, double slow, double flow) {
  // White noise of this share of its variance is left in what was low-passed lightly.
  light_share_ = (1.0 - light) / (1.0 + light);
  light_forward_ += (1.0 - light) * (raw_force_.x() - light_forward_);
  if (!std::isfinite(in.speed_m_s)) {
    has_side_ = false;
    flow_ = flow_weight_ = 0.0;
    return;
  }
  // What turning explains is no flow.
  const double side = raw_force_.y() - raw_rate_.z() * in.speed_m_s;
  if (!has_side_) light_side_ = slow_side_ = side;
  has_side_ = true;
  light_side_ += (1.0 - light) * (side - light_side_);
  slow_side_ += (1.0 - slow) * (light_side_ - slow_side_);
  if (rate_.cwiseAbs().maxCoeff() > kManoeuvre_rad_s) {
    slow_side_ = light_side_;
    return;
  }
  const double fast = light_side_ - slow_side_;
  flow_weight_ += (1.0 - flow) * (1.0 - flow_weight_);
  flow_ += (1.0 - flow) * (fast * fast - vibration() - flow_);
}

StabilityGate::Phase StabilityGate::add(const StabilityInput& in) {
  // (ALN-11)
  const StabilityReset reason = fault(in);
  smooth(in);
  if (phase_ == Phase::full) reset(last_reset_);
  if (reason != StabilityReset::none) {
    fail(reason);
    return phase_;
  }
  since_fault_s_ += in.dt_s;
  watch(StabilityCondition::roll, in.roll_rad, in.dt_s);
  watch(StabilityCondition::pitch, in.pitch_rad, in.dt_s);
  watch(StabilityCondition::depth, in.depth_error_m, in.dt_s);
  watch(StabilityCondition::rate_y, rate_.y(), in.dt_s);
  watch(StabilityCondition::force_x, force_.x(), in.dt_s);
  watch(StabilityCondition::rate_z, rate_.z(), in.dt_s);
  watch(StabilityCondition::gravity, force_.norm() - in.g_m_s2, in.dt_s);
  watch(StabilityCondition::speed_slope, in.speed_slope_m_s2, in.dt_s);
  if (phase_ == Phase::averaging) {
    // A little wider than to begin, so that noise about a limit does not cost the window.
    const bool kept = std::all_of(watched_.begin(), watched_.end(),
                                  [](const Watched& w) { return std::abs(w.value) <= kWider * w.limit; });
    if (!kept) {
      // The conditions that still hold keep their time; only the window is lost.
      phase_ = Phase::waiting;
      averaged_s_ = 0.0;
      last_reset_ = StabilityReset::condition;
      return phase_;
    }
    average(in);
  } else if (std::all_of(watched_.begin(), watched_.end(), [](const Watched& w) { return w.met(); })) {
    phase_ = Phase::averaging;
    averaged_s_ = 0.0;
    samples_ = 0;
  }
  return phase_;
}

void StabilityGate::average(const StabilityInput& in) {
  const Eigen::Vector2d light(light_forward_, light_side_);
  if (samples_ == 0) {
    sum_ = StabilityWindow();
    first_light_ = light;
    excess_.setZero();
    excess_square_.setZero();
  }
  ++samples_;
  averaged_s_ += in.dt_s;
  sum_.roll_rad += in.roll_rad;
  sum_.pitch_rad += in.pitch_rad;
  sum_.rate_B_rad_s += in.rate_B_rad_s;
  sum_.force_B_m_s2 += in.force_B_m_s2;
  sum_.speed_m_s += in.speed_m_s;
  sum_.speed_slope_m_s2 += in.speed_slope_m_s2;
  const Eigen::Vector2d excess = light - first_light_;
  excess_ += excess;
  excess_square_ += excess.cwiseAbs2();
  if (averaged_s_ < config_.window_s - kGateRounding_s) return;
  const double n = samples_;
  window_.roll_rad = sum_.roll_rad / n;
  window_.pitch_rad = sum_.pitch_rad / n;
  window_.rate_B_rad_s = sum_.rate_B_rad_s / n;
  window_.force_B_m_s2 = sum_.force_B_m_s2 / n;
  window_.speed_m_s = sum_.speed_m_s / n;
  window_.speed_slope_m_s2 = sum_.speed_slope_m_s2 / n;
  window_.samples = samples_;
  const Eigen::Vector2d variance =
      ((excess_square_ / n - (excess_ / n).cwiseAbs2()).array() - vibration()).max(0.0);
  window_.forward_spread_m_s2 = std::sqrt(variance.x());
  // A window may be quiet by luck; what the flow does to its mean is told by the seconds before it, too.
  const double before = flow_weight_ > 0.0 ? std::max(flow_ / flow_weight_, 0.0) : variance.y();
  window_.flow_spread_m_s2 = std::sqrt(0.5 * (before + variance.y()));
  if (window_.forward_spread_m_s2 > config_.force_spread_m_s2 ||
      window_.flow_spread_m_s2 > config_.flow_spread_m_s2) {
    // The vehicle still runs straight: the next window may begin at once.
    phase_ = Phase::waiting;
    averaged_s_ = 0.0;
    last_reset_ = StabilityReset::spread;
    return;
  }
  phase_ = Phase::full;
}

double StabilityGate::time_to_full_s() const {
  if (phase_ == Phase::averaging) return std::max(0.0, config_.window_s - averaged_s_);
  double longest = 0.0;
  for (const Watched& one : watched_) longest = std::max(longest, one.needed_s - one.held_s);
  return longest + config_.window_s;
}

}  // namespace fathom::estimation
