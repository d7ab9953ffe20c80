#include <algorithm>
#include <cmath>
#include <numbers>

#include "geo/wgs84.hpp"
#include "sim/vehicles/vehicle.hpp"

namespace fathom::sim {
namespace {

using Eigen::Vector3d;

/// First-order responses in the vehicle's own lengths, as the manoeuvring derivatives of a slender body give
/// them: time constants shrink with speed. Positive fin angles follow the right-hand rule about the axes they
/// turn around, so a positive rudder turns to port and positive stern planes push the nose down.
class Auv final : public Vehicle {
 public:
  Auv(const AuvConfig& config, const EnvironmentConfig& environment, std::uint64_t seed)
      : config_(config), environment_(environment), random_(seed, "auv") {
    for (auto& phase : wave_phase_rad_) phase = random_.uniform(0.0, 2.0 * std::numbers::pi);
    sway_ = GaussMarkov(environment.turbulence_m_s, environment.turbulence_tau_s, random_);
    heave_ = GaussMarkov(environment.turbulence_m_s, environment.turbulence_tau_s, random_);
  }

  void control(const BodyState& state, const Order& order, double dt_s) override {
    turbulence_ = {0.0, sway_.advance(dt_s, random_), heave_.advance(dt_s, random_)};
    rpm_command_ = order.speed_m_s / config_.speed_per_rpm;
    const double speed = state.V_B_m_s.x();
    rudder_command_rad_ = 0.0;
    stern_command_rad_ = 0.0;
    if (speed < 0.3) {  // no steerage way
      depth_integral_rad_ = 0.0;
      return;
    }
    const Vector3d rpy = rpy_of(state.q_NB);
    const double limit = config_.fin_limit_rad;

    const double turn_rate = std::clamp(0.35 * geo::wrap_pi(order.heading_rad - rpy.z()),
                                        -config_.maximum_turn_rate_rad_s, config_.maximum_turn_rate_rad_s);
    const double r = state.omega_NB_B_rad_s.z();
    rudder_command_rad_ =
        std::clamp(-(turn_rate / (config_.rudder_1_m * speed) + 1.0 * (turn_rate - r)), -limit, limit);

    const double depth_error_m = order.depth_m - state.depth_m;
    if (std::abs(depth_error_m) < 2.0 && order.depth_m > 0.5) {
      depth_integral_rad_ = std::clamp(depth_integral_rad_ + 0.02 * depth_error_m * dt_s, -0.1, 0.1);
    } else {
      depth_integral_rad_ = 0.0;
    }
    const double pitch_rad = std::clamp(-0.12 * depth_error_m - depth_integral_rad_,
                                        -config_.maximum_pitch_rad, config_.maximum_pitch_rad);
    const double hold = config_.righting_1_s2 * std::sin(rpy.y()) * config_.pitch_length_m /
                        (config_.stern_1_m * speed * speed);
    stern_command_rad_ = std::clamp(
        -(1.5 * (pitch_rad - rpy.y()) - 1.2 * state.omega_NB_B_rad_s.y()) * (2.0 / std::max(speed, 1.0)) -
            hold,
        -limit, limit);
  }

  [[nodiscard]] BodyRates dynamics(const BodyState& state) const override {
    const double g = kModelGravity_m_s2;
    const Vector3d flow = state.V_B_m_s - turbulence_;
    const double u = flow.x();
    const double v = flow.y();
    const double w = flow.z();
    const double p = state.omega_NB_B_rad_s.x();
    const double q = state.omega_NB_B_rad_s.y();
    const double r = state.omega_NB_B_rad_s.z();
    const double rpm = state.actuator.x();
    const double rudder = state.actuator.y();
    const double stern = state.actuator.z();
    const double way = std::abs(u);
    const Vector3d rpy = rpy_of(state.q_NB);
    const Wave wave = wave_at(state);

    // Submerged share of the hull: a floating vehicle rides with only its crest out of the water.
    const double immersion_m = state.depth_m + wave.elevation_m + 0.5 * config_.hull_diameter_m;
    const double submerged = smooth_step(immersion_m / config_.hull_diameter_m);
    const Vector3d weight_N{0.0, 0.0, g * (1.0 - config_.buoyancy_ratio * submerged)};

    BodyRates rates;
    const double thrust_speed = config_.speed_per_rpm * rpm;
    rates.V_dot_B_m_s2 = {
        config_.surge_drag_1_m * (thrust_speed * std::abs(thrust_speed) - u * std::abs(u)) - 0.05 * u,
        -(way / config_.sway_length_m) * (v + config_.turn_slip_m * r) - 0.3 * v,
        -(way / config_.heave_length_m) * (w - config_.turn_slip_m * q) - 0.8 * w - 1.5 * w * std::abs(w)};
    rates.V_dot_B_m_s2 += state.q_NB.conjugate() * weight_N;

    const double roll_stiffness = config_.roll_frequency_rad_s * config_.roll_frequency_rad_s;
    rates.omega_dot_B_rad_s2 = {
        -roll_stiffness * (rpy.x() - wave.roll_rad - config_.roll_per_turn_s_m * r * u) -
            2.0 * config_.roll_damping * config_.roll_frequency_rad_s * p,
        -(way / config_.pitch_length_m) * (q + config_.stern_1_m * u * stern) -
            config_.righting_1_s2 * std::sin(rpy.y()) * std::cos(rpy.x()) + wave.pitch_rad_s2 - 0.3 * q,
        -(way / config_.yaw_length_m) * (r + config_.rudder_1_m * u * rudder) - 0.2 * r};

    rates.actuator_dot = {(rpm_command_ - rpm) / config_.propulsor_tau_s,
                          (rudder_command_rad_ - rudder) / config_.fin_tau_s,
                          (stern_command_rad_ - stern) / config_.fin_tau_s};
    return rates;
  }

 private:
  struct Wave {
    double elevation_m = 0.0;
    double roll_rad = 0.0;
    double pitch_rad_s2 = 0.0;
  };

  /// Two incommensurate swells that die out below the surface as deep-water waves do.
  [[nodiscard]] Wave wave_at(const BodyState& state) const {
    const double omega = 2.0 * std::numbers::pi / environment_.wave_period_s;
    const double decay = std::exp(-omega * omega / kModelGravity_m_s2 * std::max(state.depth_m, 0.0));
    const double a = omega * state.t_s;
    const double b = 1.317 * omega * state.t_s;
    Wave wave;
    wave.elevation_m = environment_.wave_height_m * decay *
                       (0.7 * std::sin(a + wave_phase_rad_[0]) + 0.3 * std::sin(b + wave_phase_rad_[1]));
    wave.roll_rad = environment_.wave_tilt_rad * decay *
                    (0.7 * std::sin(a + wave_phase_rad_[2]) + 0.3 * std::sin(b + wave_phase_rad_[3]));
    wave.pitch_rad_s2 = 0.5 * config_.righting_1_s2 * environment_.wave_tilt_rad * decay *
                        (0.6 * std::sin(a + wave_phase_rad_[4]) + 0.4 * std::sin(b + wave_phase_rad_[5]));
    return wave;
  }

  AuvConfig config_;
  EnvironmentConfig environment_;
  Random random_;
  std::array<double, 6> wave_phase_rad_{};
  GaussMarkov sway_;
  GaussMarkov heave_;
  Vector3d turbulence_ = Vector3d::Zero();
  double rpm_command_ = 0.0;
  double rudder_command_rad_ = 0.0;
  double stern_command_rad_ = 0.0;
  double depth_integral_rad_ = 0.0;
};

}  // namespace

std::unique_ptr<Vehicle> make_auv(const AuvConfig& config, const EnvironmentConfig& environment,
                                  std::uint64_t seed) {
  return std::make_unique<Auv>(config, environment, seed);
}

}  // namespace fathom::sim
