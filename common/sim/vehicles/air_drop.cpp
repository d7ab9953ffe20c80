#include <algorithm>
#include <cmath>

#include "geo/wgs84.hpp"
#include "sim/vehicles/vehicle.hpp"

namespace fathom::sim {
namespace {

using Eigen::Vector3d;

constexpr double kWaterDensity_kg_m3 = 1025.0;

/// Ballistic flight under a parachute, water entry, then the rigid body of the in-motion alignment's
/// reference scenario: added mass, tail, body and fin lift, Munk moment, heavier than the water it displaces.
/// Signs as in SNAME: z down, force of a tail at x < 0 against its own cross flow.
class AirDrop final : public Vehicle {
 public:
  AirDrop(const AirDropConfig& config, const EnvironmentConfig& environment, std::uint64_t seed)
      : config_(config), random_(seed, "air_drop") {
    draw_coefficients(seed);
    lateral_ = GaussMarkov(environment.turbulence_m_s, environment.turbulence_tau_s, random_);
    vertical_ = GaussMarkov(environment.turbulence_m_s, environment.turbulence_tau_s, random_);
  }

  void control(const BodyState& state, const Order& order, double dt_s) override {
    turbulence_ = {0.0, lateral_.advance(dt_s, random_), vertical_.advance(dt_s, random_)};
    const Vector3d rpy = rpy_of(state.q_steered_NB);
    const double u = std::max(state.V_B_m_s.x(), 5.0);
    roll_error_rad_ = geo::wrap_pi(rpy.x() - rpy_of(state.q_NB).x());
    if (state.depth_m > 0.5 * config_.length_m && entered_at_s_ < 0.0) entered_at_s_ = state.t_s;
    const bool powered = entered_at_s_ >= 0.0 && state.t_s >= entered_at_s_ + config_.propulsor_delay_s;
    thrust_speed_m_s_ = powered ? order.speed_m_s : 0.0;
    rudder_command_rad_ = 0.0;
    stern_command_rad_ = 0.0;
    if (entered_at_s_ < 0.0) return;

    const double sink_m_s = (state.q_NB * state.V_B_m_s).z();  // by the depth sensor, whatever the attitude
    const double error_m = order.depth_m - state.depth_m;
    flared_ = flared_ || error_m < config_.flare_s * sink_m_s;
    double pitch_rad = config_.dive_pitch_rad;
    if (flared_) {
      pitch_rad = -0.05 * error_m;
      if (std::abs(error_m) < config_.limited_range_m) {
        pitch_rad = std::clamp(pitch_rad, -config_.limited_pitch_rad, config_.limited_pitch_rad);
      }
      pitch_rad = std::clamp(pitch_rad, config_.dive_pitch_rad, -config_.dive_pitch_rad);
    }
    const double slew_rad = (flared_ ? config_.flare_slew_rad_s : config_.pitch_slew_rad_s) * dt_s;
    if (!steering_) pitch_command_rad_ = rpy.y();
    steering_ = true;
    pitch_command_rad_ += std::clamp(pitch_rad - pitch_command_rad_, -slew_rad, slew_rad);
    // Fin forces grow with the square of the speed: gains shrink with it.
    const double authority = (17.0 / u) * (17.0 / u);
    const double limit = 0.35;
    stern_command_rad_ =
        std::clamp(-authority * (0.6 * (pitch_command_rad_ - rpy.y()) - 0.05 * state.omega_NB_B_rad_s.y()),
                   -limit, limit);
    rudder_command_rad_ = std::clamp(
        -authority * (0.6 * geo::wrap_pi(order.heading_rad - rpy.z()) - 0.05 * state.omega_NB_B_rad_s.z()),
        -limit, limit);
  }

  [[nodiscard]] BodyRates dynamics(const BodyState& state) const override {
    const double wet = smooth_step(state.depth_m / config_.length_m + 0.5);
    const BodyRates air = in_air(state);
    const BodyRates water = in_water(state);
    BodyRates rates;
    rates.V_dot_B_m_s2 = (1.0 - wet) * air.V_dot_B_m_s2 + wet * water.V_dot_B_m_s2;
    rates.omega_dot_B_rad_s2 = (1.0 - wet) * air.omega_dot_B_rad_s2 + wet * water.omega_dot_B_rad_s2;
    // The propulsor turns at constant advance ratio: its rpm measures the speed through the water.
    const double rpm = thrust_speed_m_s_ > 0.0 ? state.V_B_m_s.x() / config_.speed_per_rpm : 0.0;
    rates.actuator_dot = {(rpm - state.actuator.x()) / 0.1, (rudder_command_rad_ - state.actuator.y()) / 0.05,
                          (stern_command_rad_ - state.actuator.z()) / 0.05};
    return rates;
  }

 private:
  /// Each coefficient of the hull as this vehicle has it.
  void draw_coefficients(std::uint64_t seed) {
    if (config_.coefficient_sigma <= 0.0) return;
    Random random(seed, "air_drop coefficients");
    for (double* one : {&config_.added_surge_kg, &config_.added_sway_kg, &config_.inertia_roll_kg_m2,
                        &config_.inertia_pitch_kg_m2, &config_.drag_coefficient, &config_.tail_lift_kg_m,
                        &config_.body_lift_kg_m, &config_.fin_lift_kg_m, &config_.munk_kg})
      *one *= std::max(0.2, 1.0 + random.normal(config_.coefficient_sigma));
  }

  [[nodiscard]] BodyRates in_air(const BodyState& state) const {
    const Vector3d& V = state.V_B_m_s;
    const Vector3d& omega = state.omega_NB_B_rad_s;
    const double open = smooth_step((state.t_s - config_.parachute_at_s) / 0.6);
    const double bare = 0.0003;
    const double full = kModelGravity_m_s2 / (config_.terminal_speed_m_s * config_.terminal_speed_m_s);
    const double drag_1_m = bare + (full - bare) * open;
    BodyRates rates;
    rates.V_dot_B_m_s2 = state.q_NB.conjugate() * Vector3d(0.0, 0.0, kModelGravity_m_s2) -
                         drag_1_m * V.norm() * V - omega.cross(V);
    // The parachute pulls the tail into the wake: the nose follows the path.
    const double speed = std::max(V.norm(), 5.0);
    const double stiffness = 4.0;
    const double damping = 2.8;
    const Vector3d rpy = rpy_of(state.q_NB);
    rates.omega_dot_B_rad_s2 = {-1.0 * std::sin(rpy.x()) * std::cos(rpy.y()) - 0.6 * omega.x(),
                                -stiffness * V.z() / speed - damping * omega.y(),
                                stiffness * V.y() / speed - damping * omega.z()};
    return rates;
  }

  [[nodiscard]] BodyRates in_water(const BodyState& state) const {
    const Vector3d flow = state.V_B_m_s - turbulence_;
    const double u = flow.x();
    const double v = flow.y();
    const double w = flow.z();
    const double p = state.omega_NB_B_rad_s.x();
    const double q = state.omega_NB_B_rad_s.y();
    const double r = state.omega_NB_B_rad_s.z();
    const double rudder = state.actuator.y();
    const double stern = state.actuator.z();
    const double x = config_.tail_x_m;
    const double m = config_.mass_kg;
    const double m_surge = m + config_.added_surge_kg;
    const double m_sway = m + config_.added_sway_kg;
    const Vector3d weight =
        state.q_NB.conjugate() * Vector3d(0.0, 0.0, (m - config_.buoyancy_kg) * kModelGravity_m_s2);

    const double drag = 0.5 * kWaterDensity_kg_m3 * config_.drag_coefficient * config_.frontal_area_m2;
    const double Y_tail = -config_.tail_lift_kg_m * u * (v + x * r) + config_.fin_lift_kg_m * u * u * rudder;
    const double Z_tail = -config_.tail_lift_kg_m * u * (w - x * q) - config_.fin_lift_kg_m * u * u * stern;
    const double X = drag * (thrust_speed_m_s_ * thrust_speed_m_s_ - u * std::abs(u));
    const double Y = Y_tail - config_.body_lift_kg_m * u * v;
    const double Z = Z_tail - config_.body_lift_kg_m * u * w;

    BodyRates rates;
    rates.V_dot_B_m_s2 = {(X + weight.x() - m_sway * (w * q - v * r)) / m_surge,
                          (Y + weight.y() - m * u * r) / m_sway, (Z + weight.z() + m * u * q) / m_sway};
    const Vector3d rpy = rpy_of(state.q_NB);
    // Roll is regulated by differential fins, idealised as a second-order response.
    const double roll_rate = 2.0 * std::min(std::abs(u) / 17.0, 1.5);
    rates.omega_dot_B_rad_s2 = {-roll_rate * roll_rate * geo::wrap_pi(rpy.x() + roll_error_rad_) -
                                    1.6 * roll_rate * p + 0.8 * v / config_.inertia_roll_kg_m2,
                                (-x * Z_tail + config_.munk_kg * u * w) / config_.inertia_pitch_kg_m2,
                                (x * Y_tail - config_.munk_kg * u * v) / config_.inertia_pitch_kg_m2};
    return rates;
  }

  AirDropConfig config_;
  Random random_;
  GaussMarkov lateral_;
  GaussMarkov vertical_;
  Vector3d turbulence_ = Vector3d::Zero();
  double entered_at_s_ = -1.0;
  double thrust_speed_m_s_ = 0.0;
  double rudder_command_rad_ = 0.0;
  double stern_command_rad_ = 0.0;
  double roll_error_rad_ = 0.0;  ///< of the roll that the autopilot regulates
  double pitch_command_rad_ = 0.0;
  bool steering_ = false;
  bool flared_ = false;
};

}  // namespace

std::unique_ptr<Vehicle> make_air_drop(const AirDropConfig& config, const EnvironmentConfig& environment,
                                       std::uint64_t seed) {
  return std::make_unique<AirDrop>(config, environment, seed);
}

}  // namespace fathom::sim
