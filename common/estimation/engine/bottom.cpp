#include "estimation/engine/bottom.hpp"

#include <cmath>

#include "estimation/navigator/navigator.hpp"
#include "geo/so3.hpp"

namespace fathom::estimation {
namespace {

constexpr double kLeastSteepness = 0.5;  // cosine of 60 degrees

}  // namespace

Bottom::Bottom(const AltimeterConfig& config) : config_(config) {}

std::optional<VerdictKind> Bottom::take(const AltimeterSample& sample) {
  if (!std::isfinite(sample.altitude_m)) return std::nullopt;
  if (!config_.sensor.empty() && sample.header.sensor.view() != config_.sensor) return std::nullopt;
  if (!sound_stamp(sample.header.stamp_ns)) return VerdictKind::out_of_range;
  const TimeNs stamp_ns = sample.header.stamp_ns - from_seconds(config_.latency_s);
  if (now_ns_ && stamp_ns > *now_ns_ + from_seconds(config_.fresh_s)) return VerdictKind::from_the_future;
  if (now_ns_ && newest_ && stamp_ns <= newest_->stamp_ns) return std::nullopt;
  newest_ = {stamp_ns, sample.altitude_m, sample.vertical};
  return std::nullopt;
}

void Bottom::latch(TimeNs now_ns) {
  now_ns_ = now_ns;
  // The axis of the stamps may have begun anew, further back: this one would keep the others out.
  if (newest_ && newest_->stamp_ns > now_ns + from_seconds(config_.fresh_s)) newest_.reset();
  latched_ = newest_;
}

double Bottom::altitude_m(const Setup& setup, const Navigator& navigator) const {
  if (!latched_ || !navigator.navigating()) return kUnknown;
  const double age_s = to_seconds(navigator.now_ns() - latched_->stamp_ns);
  if (std::abs(age_s) > config_.fresh_s) return kUnknown;
  const NavSolution& nav = navigator.state().nav;
  const Eigen::Matrix3d c = geo::to_matrix(nav.q_NB);
  const double steepness = c(2, 2);
  if (steepness < kLeastSteepness) return kUnknown;
  // Of the altimeter, then of the output point, which is above it by what it lies deeper.
  const double heard_m = latched_->altitude_m * (latched_->vertical ? 1.0 : steepness);
  const Eigen::Vector3d lever = geo::vec(config_.lever_B_m) - geo::vec(setup.config.output_lever_B_m);
  return heard_m - nav.v_N_m_s.z() * age_s + (c * lever).z();
}

}  // namespace fathom::estimation
