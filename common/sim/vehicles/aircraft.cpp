#include <algorithm>
#include <cmath>
#include <numbers>

#include "geo/wgs84.hpp"
#include "sim/vehicles/vehicle.hpp"

namespace fathom::sim {
namespace {

using Eigen::Vector3d;

/// Light aircraft in coordinated flight: the turn rate that bank and speed ask for, speed and angles as
/// first-order responses. A Dutch roll is ordered as an oscillation of bank, yaw rate and side-slip.
class Aircraft final : public Vehicle {
 public:
  Aircraft(const AircraftConfig& config, const EnvironmentConfig& environment, std::uint64_t seed)
      : config_(config), random_(seed, "aircraft") {
    lateral_ = GaussMarkov(environment.turbulence_m_s, environment.turbulence_tau_s, random_);
    vertical_ = GaussMarkov(environment.turbulence_m_s, environment.turbulence_tau_s, random_);
  }

  void control(const BodyState& state, const Order& order, double dt_s) override {
    gust_ = {0.0, lateral_.advance(dt_s, random_), vertical_.advance(dt_s, random_)};
    const Vector3d rpy = rpy_of(state.q_NB);
    speed_command_m_s_ = order.speed_m_s;
    dutch_roll_rad_ = order.dutch_roll_rad;
    bank_command_rad_ = order.bank_rad != 0.0
                            ? order.bank_rad
                            : std::clamp(1.0 * geo::wrap_pi(order.heading_rad - rpy.z()),
                                         -config_.maximum_bank_rad, config_.maximum_bank_rad);
    const double climb_rad = std::clamp(-0.01 * (order.depth_m - state.depth_m), -config_.maximum_climb_rad,
                                        config_.maximum_climb_rad);
    pitch_command_rad_ = climb_rad + config_.angle_of_attack_rad * std::cos(rpy.x());
  }

  [[nodiscard]] BodyRates dynamics(const BodyState& state) const override {
    const Vector3d rpy = rpy_of(state.q_NB);
    const Vector3d& V = state.V_B_m_s;
    const Vector3d& omega = state.omega_NB_B_rad_s;
    const double speed = std::max(V.x(), 10.0);
    const double sway = 2.0 * std::numbers::pi / config_.dutch_roll_period_s * state.t_s;

    const double bank = bank_command_rad_ + dutch_roll_rad_ * std::sin(sway);
    const double roll_dot = config_.roll_frequency_rad_s * (bank - rpy.x());
    const double pitch_dot = config_.pitch_frequency_rad_s * (pitch_command_rad_ - rpy.y());
    const double yaw_dot = kModelGravity_m_s2 * std::tan(std::clamp(rpy.x(), -1.2, 1.2)) / speed +
                           0.4 * dutch_roll_rad_ * std::cos(sway);
    // Body rates of these Euler angle rates.
    const Vector3d wanted{roll_dot - yaw_dot * std::sin(rpy.y()),
                          pitch_dot * std::cos(rpy.x()) + yaw_dot * std::sin(rpy.x()) * std::cos(rpy.y()),
                          -pitch_dot * std::sin(rpy.x()) + yaw_dot * std::cos(rpy.x()) * std::cos(rpy.y())};
    BodyRates rates;
    rates.omega_dot_B_rad_s2 = (wanted - omega) / config_.rate_tau_s;

    const double slip = 0.25 * dutch_roll_rad_ * std::sin(sway + 0.6) * speed;
    // More lift in a turn needs a larger angle of attack.
    const double attack = config_.angle_of_attack_rad / std::max(std::cos(rpy.x()), 0.4);
    rates.V_dot_B_m_s2 = {(speed_command_m_s_ - V.x()) / config_.speed_tau_s,
                          (slip + gust_.y() - V.y()) / config_.slip_tau_s,
                          (attack * speed + gust_.z() - V.z()) / config_.slip_tau_s};
    rates.actuator_dot = Vector3d::Zero();
    return rates;
  }

 private:
  AircraftConfig config_;
  Random random_;
  GaussMarkov lateral_;
  GaussMarkov vertical_;
  Vector3d gust_ = Vector3d::Zero();
  double speed_command_m_s_ = 0.0;
  double bank_command_rad_ = 0.0;
  double pitch_command_rad_ = 0.0;
  double dutch_roll_rad_ = 0.0;
};

}  // namespace

std::unique_ptr<Vehicle> make_aircraft(const AircraftConfig& config, const EnvironmentConfig& environment,
                                       std::uint64_t seed) {
  return std::make_unique<Aircraft>(config, environment, seed);
}

}  // namespace fathom::sim
