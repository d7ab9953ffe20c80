#include "study/consistency/manoeuvres.hpp"

#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

namespace fathom::study {
namespace {

constexpr double kGravity_m_s2 = 9.81;

}  // namespace

Profile& Profile::step(double at_s, double over_s, double by) {
  steps_.push_back({at_s, over_s, by});
  return *this;
}

Profile& Profile::swing(double amplitude, double period_s, double phase_rad) {
  swings_.push_back({amplitude, 2.0 * std::numbers::pi / period_s, phase_rad});
  return *this;
}

double Profile::at(double t_s) const {
  double value = start_;
  for (const Step& step : steps_) {
    const double x = (t_s - step.at_s) / step.over_s;
    if (x <= 0.0) continue;
    const double x4 = x * x * x * x;
    value += x >= 1.0 ? step.by : step.by * x4 * (35.0 + x * (-84.0 + x * (70.0 - 20.0 * x)));
  }
  for (const Swing& swing : swings_)
    value += swing.amplitude * std::sin(swing.rate_rad_s * t_s + swing.phase_rad);
  return value;
}

double Profile::rate(double t_s) const {
  double value = 0.0;
  for (const Step& step : steps_) {
    const double x = (t_s - step.at_s) / step.over_s;
    if (x <= 0.0 || x >= 1.0) continue;
    const double both = x * (1.0 - x);
    value += step.by / step.over_s * 140.0 * both * both * both;
  }
  for (const Swing& swing : swings_)
    value += swing.amplitude * swing.rate_rad_s * std::cos(swing.rate_rad_s * t_s + swing.phase_rad);
  return value;
}

Eigen::Matrix3d Manoeuvres::axes_NB(double t_s) const {
  double bank = bank_rad.at(t_s);
  if (coordinated) bank += std::atan(speed_m_s.at(t_s) * heading_rad.rate(t_s) / kGravity_m_s2);
  return (Eigen::AngleAxisd(heading_rad.at(t_s), Eigen::Vector3d::UnitZ()) *
          Eigen::AngleAxisd(pitch_rad.at(t_s), Eigen::Vector3d::UnitY()) *
          Eigen::AngleAxisd(bank, Eigen::Vector3d::UnitX()))
      .toRotationMatrix();
}

Eigen::Vector3d Manoeuvres::velocity_N_m_s(double t_s) const {
  const double speed = speed_m_s.at(t_s);
  const Eigen::Vector3d through_B(speed * std::cos(angle_of_attack_rad),
                                  -sway_per_turn_m * heading_rad.rate(t_s),
                                  speed * std::sin(angle_of_attack_rad));
  const double share = medium_share.at(t_s);
  return axes_NB(t_s) * through_B +
         Eigen::Vector3d(share * medium_N_m_s.x(), share * medium_N_m_s.y(), heave_m_s.at(t_s));
}

}  // namespace fathom::study
