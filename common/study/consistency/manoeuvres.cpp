#include "study/consistency/manoeuvres.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

#include <Eigen/Geometry>

namespace fathom::study {
namespace {

constexpr double kGravity_m_s2 = 9.81;
constexpr double kRolling_m_s = 2.0;  // slower, wheels slip and springs swing less

}  // namespace

Profile& Profile::step(double at_s, double over_s, double by) {
  const auto later = std::upper_bound(steps_.begin(), steps_.end(), at_s,
                                      [](double t, const Step& step) { return t < step.at_s; });
  Step before = later == steps_.begin() ? Step{} : *std::prev(later);
  for (auto step = steps_.insert(later, {at_s, over_s, by}); step != steps_.end(); ++step) {
    step->done = before.done + step->by;
    step->end_s = std::max(before.end_s, step->at_s + step->over_s);
    before = *step;
  }
  return *this;
}

Profile& Profile::swing(double amplitude, double period_s, double phase_rad) {
  swings_.push_back({amplitude, 2.0 * std::numbers::pi / period_s, phase_rad});
  return *this;
}

Profile::Value Profile::at(double t_s) const {
  Value out{start_, 0.0};
  auto begun =
      static_cast<std::size_t>(std::upper_bound(steps_.begin(), steps_.end(), t_s,
                                                [](double t, const Step& step) { return t < step.at_s; }) -
                               steps_.begin());
  for (; begun > 0; --begun) {
    const Step& step = steps_[begun - 1];
    if (step.end_s <= t_s) {
      out.value += step.done;
      break;
    }
    const double x = (t_s - step.at_s) / step.over_s;
    if (x >= 1.0) {
      out.value += step.by;
      continue;
    }
    const double x4 = x * x * x * x;
    out.value += step.by * x4 * (35.0 + x * (-84.0 + x * (70.0 - 20.0 * x)));
    const double both = x * (1.0 - x);
    out.rate += step.by / step.over_s * 140.0 * both * both * both;
  }
  for (const Swing& swing : swings_) {
    const double phase = swing.rate_rad_s * t_s + swing.phase_rad;
    out.value += swing.amplitude * std::sin(phase);
    out.rate += swing.amplitude * swing.rate_rad_s * std::cos(phase);
  }
  return out;
}

Movement Manoeuvres::at(double t_s) const {
  const Profile::Value heading = heading_rad.at(t_s);
  const double speed = speed_m_s.at(t_s).value;
  double bank = bank_rad.at(t_s).value;
  if (coordinated) bank += std::atan(speed * heading.rate / kGravity_m_s2);
  Movement out;
  out.axes_NB = (Eigen::AngleAxisd(heading.value, Eigen::Vector3d::UnitZ()) *
                 Eigen::AngleAxisd(pitch_rad.at(t_s).value, Eigen::Vector3d::UnitY()) *
                 Eigen::AngleAxisd(bank, Eigen::Vector3d::UnitX()))
                    .toRotationMatrix();
  const double rolls = speed * speed / (speed * speed + kRolling_m_s * kRolling_m_s);
  const Eigen::Vector3d through_B(
      speed * std::cos(angle_of_attack_rad),
      speed * std::sin(crab_rad) + rolls * slip_m_s.at(t_s).value - sway_per_turn_m * heading.rate,
      speed * std::sin(angle_of_attack_rad) + rolls * bounce_m_s.at(t_s).value);
  const double share = medium_share.at(t_s).value;
  out.velocity_N_m_s =
      out.axes_NB * through_B +
      Eigen::Vector3d(share * medium_N_m_s.x(), share * medium_N_m_s.y(), heave_m_s.at(t_s).value);
  return out;
}

}  // namespace fathom::study
