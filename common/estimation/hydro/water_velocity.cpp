#include "estimation/hydro/water_velocity.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "estimation/hydro/runge_kutta.hpp"

namespace fathom::estimation::hydro {
namespace {

using Eigen::Vector3d;

/// Longer steps than this are taken in parts: the shortest time constant is the roll of the flow, about a
/// second.
constexpr double kLongestStep_s = 0.1;
/// A comparison speaks for at most this long.
constexpr double kLongestComparison_s = 1.0;
constexpr double kWorst = 100.0;

}  // namespace

VelocityModel::VelocityModel(const HydroCoefficients& coefficients)
    : model_(coefficients),
      inverse_(model_.mass().topLeftCorner<3, 3>().inverse()),
      turning_(inverse_ * model_.mass().topRightCorner<3, 3>()) {}

Vector3d VelocityModel::step(const Vector3d& V_B_m_s, const Vector3d& omega_before_B_rad_s,
                             const Vector3d& omega_B_rad_s, const Vector3d& gamma_B, const Controls& controls,
                             double dt_s) const {
  // (HYD-3): V + turning * omega carries the momentum, so that no angular acceleration is needed.
  const Vector3d carried = V_B_m_s + turning_ * (omega_before_B_rad_s - omega_B_rad_s);
  return runge_kutta(carried, dt_s, [&](const Vector3d& at) {
    return Vector3d(inverse_ * model_.force(at, omega_B_rad_s, gamma_B, controls));
  });
}

void WaterVelocity::begin(const Vector3d& V_B_m_s) {
  if (!possible(V_B_m_s)) return;
  running_ = true;
  running_s_ = 0.0;
  V_B_ = V_B_m_s;
}

void WaterVelocity::set_fins(double rudder_rad, double stern_rad) {
  controls_.rudder_rad = rudder_rad;
  controls_.stern_rad = stern_rad;
  fins_age_s_ = 0.0;
}

void WaterVelocity::advance(const VelocityModel& model, const Vector3d& omega_B_rad_s,
                            const Vector3d& gamma_B, double dt_s) {
  fins_age_s_ += dt_s;
  unmeasured_s_ += dt_s;
  since_compared_s_ += dt_s;
  if (!running_) {
    omega_before_B_ = omega_B_rad_s;
    return;
  }
  running_s_ += dt_s;
  const int parts = std::clamp(static_cast<int>(std::ceil(dt_s / kLongestStep_s)), 1, 100);
  for (int i = 0; i < parts; ++i) {
    V_B_ = model.step(V_B_, omega_before_B_, omega_B_rad_s, gamma_B, controls_, dt_s / parts);
    omega_before_B_ = omega_B_rad_s;
  }
  // It begins anew with the next shaft speed.
  if (!possible(V_B_)) stop();
}

double WaterVelocity::unmeasured_s(double longest_s) const {
  return std::min(unmeasured_s_, longest_s);
}

void WaterVelocity::compare(double normalised, double memory_s) {
  // (HYD-4)
  const double span = std::min(since_compared_s_, kLongestComparison_s);
  since_compared_s_ = 0.0;
  compared_s_ += span;
  // Young memories average plainly, old ones forget.
  const double share = std::max(span / std::min(compared_s_, memory_s), span / memory_s);
  model_nis_ += std::min(share, 1.0) * (std::min(normalised, kWorst) - model_nis_);
}

}  // namespace fathom::estimation::hydro
