#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <Eigen/LU>

#include "geo/wgs84.hpp"
#include "sim/vehicles/vehicle.hpp"

namespace fathom::sim {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

Matrix3d cross_matrix(const Vector3d& a) {
  Matrix3d out;
  out << 0.0, -a.z(), a.y(), a.z(), 0.0, -a.x(), -a.y(), a.x(), 0.0;
  return out;
}

// REMUS 100 (Prestero 2001): a hull of 30.5 kg, fins at the tail, one propulsor. SI, about the centre of
// buoyancy. Written on its own and in vector form, so that an estimator's model is not tested against itself.
constexpr double kWeight_N = 299.0;
constexpr double kBuoyancy_N = 306.0;
constexpr double kMass_kg = kWeight_N / 9.81;
constexpr double kThrust_rpm = 1500.0;
constexpr double kCruise_m_s = 1.5436;  // where the thrust balances the drag
const Vector3d kCentreOfGravity_m(0.0, 0.0, 0.0196);

/// Hydrodynamic coefficients, magnitudes as Prestero has them; the equations below carry the signs.
struct Hull {
  double added_surge = 0.93, added_cross = 35.5, added_roll = 0.0704, added_turn = 4.88,
         added_coupling = 1.93;
  double X_uu = 1.62, X_cross = 35.5, X_turn = 1.93;
  double Y_vv = 131.0, Y_rr = 0.632, Y_uv = 28.6, Y_ur = 5.22, Y_wp = 35.5, Y_pq = 1.93, Y_rudder = 9.64;
  double Z_ww = 131.0, Z_qq = 0.632, Z_uw = 28.6, Z_uq = 5.22, Z_vp = 35.5, Z_rp = 1.93, Z_stern = 9.64;
  double K_pp = 0.13, K_shaft = 0.543, X_shaft = 3.86;
  double M_ww = 3.18, M_qq = 188.0, M_uw = 24.0, M_uq = 2.0, M_vp = 1.93, M_rp = 4.86, M_stern = 6.15;
  double N_vv = 3.18, N_rr = 94.0, N_uv = 24.0, N_ur = 2.0, N_wp = 1.93, N_pq = 4.86, N_rudder = 6.15;
};
constexpr std::array kHullMembers{
    &Hull::added_surge, &Hull::added_cross, &Hull::added_roll, &Hull::added_turn, &Hull::added_coupling,
    &Hull::X_uu,        &Hull::X_cross,     &Hull::X_turn,     &Hull::Y_vv,       &Hull::Y_rr,
    &Hull::Y_uv,        &Hull::Y_ur,        &Hull::Y_wp,       &Hull::Y_pq,       &Hull::Y_rudder,
    &Hull::Z_ww,        &Hull::Z_qq,        &Hull::Z_uw,       &Hull::Z_uq,       &Hull::Z_vp,
    &Hull::Z_rp,        &Hull::Z_stern,     &Hull::K_pp,       &Hull::K_shaft,    &Hull::X_shaft,
    &Hull::M_ww,        &Hull::M_qq,        &Hull::M_uw,       &Hull::M_uq,       &Hull::M_vp,
    &Hull::M_rp,        &Hull::M_stern,     &Hull::N_vv,       &Hull::N_rr,       &Hull::N_uv,
    &Hull::N_ur,        &Hull::N_wp,        &Hull::N_pq,       &Hull::N_rudder};

Hull draw_hull(double share, std::uint64_t seed) {
  Hull hull;
  if (share <= 0.0) return hull;
  Random random(seed, "remus coefficients");
  for (const auto member : kHullMembers) hull.*member *= random.uniform(1.0 - share, 1.0 + share);
  return hull;
}

Matrix6 added_mass(const Hull& hull) {
  Matrix6 a = Matrix6::Zero();
  a.diagonal() << hull.added_surge, hull.added_cross, hull.added_cross, hull.added_roll, hull.added_turn,
      hull.added_turn;
  a(1, 5) = a(5, 1) = -hull.added_coupling;
  a(2, 4) = a(4, 2) = hull.added_coupling;
  return a;
}

Matrix6 rigid_body() {
  Matrix6 m = Matrix6::Zero();
  const Matrix3d arm = kMass_kg * cross_matrix(kCentreOfGravity_m);
  m.topLeftCorner<3, 3>() = kMass_kg * Matrix3d::Identity();
  m.topRightCorner<3, 3>() = -arm;
  m.bottomLeftCorner<3, 3>() = arm;
  m.bottomRightCorner<3, 3>() = Vector3d(0.177, 3.45, 3.45).asDiagonal();
  return m;
}

class Remus final : public Vehicle {
 public:
  Remus(const RemusConfig& config, const EnvironmentConfig& environment, std::uint64_t seed)
      : config_(config),
        environment_(environment),
        random_(seed, "remus"),
        hull_(draw_hull(config.coefficient_share, seed)),
        inverse_((rigid_body() + added_mass(hull_)).inverse()) {
    Random trim(seed, "remus trim");
    trim_N_m_ = {0.0, trim.normal(config.beyond.trim_moment_sigma_N_m),
                 trim.normal(config.beyond.trim_moment_sigma_N_m)};
    wave_phase_rad_ = trim.uniform(0.0, 2.0 * std::numbers::pi);
    sway_ = GaussMarkov(environment.turbulence_m_s, environment.turbulence_tau_s, random_);
    heave_ = GaussMarkov(environment.turbulence_m_s, environment.turbulence_tau_s, random_);
  }

  void control(const BodyState& state, const Order& order, double dt_s) override {
    turbulence_ = {0.0, sway_.advance(dt_s, random_), heave_.advance(dt_s, random_)};
    turbulence_ += state.q_NB.conjugate() * orbital_velocity_N(state);
    const double lag_s = config_.beyond.thrust_lag_s;
    thrust_rpm_ += (lag_s > 0.0 ? 1.0 - std::exp(-dt_s / lag_s) : 1.0) * (state.actuator.x() - thrust_rpm_);
    rpm_command_ = order.speed_m_s / kCruise_m_s * kThrust_rpm;
    const Vector3d rpy = rpy_of(state.q_NB);
    const Vector3d& rate = state.omega_NB_B_rad_s;
    if (state.V_B_m_s.x() < 0.5) {  // no steerage way
      rudder_command_rad_ = stern_command_rad_ = turn_integral_ = pitch_integral_ = 0.0;
      return;
    }
    const double dynamic_pressure = std::pow(kCruise_m_s / std::max(state.V_B_m_s.x(), 0.8), 2);
    const double limit = config_.fin_limit_rad;
    // The hull alone is unstable in yaw: the rate is held, the heading asks for a rate.
    const double turn = std::clamp(0.3 * geo::wrap_pi(order.heading_rad - rpy.z()),
                                   -config_.maximum_turn_rate_rad_s, config_.maximum_turn_rate_rad_s);
    turn_integral_ = std::clamp(turn_integral_ + (turn - rate.z()) * dt_s, -0.1, 0.1);
    rudder_command_rad_ =
        std::clamp(-dynamic_pressure * (3.0 * (turn - rate.z()) + 2.0 * turn_integral_), -limit, limit);
    const double pitch = std::clamp(-0.06 * (order.depth_m - state.depth_m), -config_.maximum_pitch_rad,
                                    config_.maximum_pitch_rad);
    depth_integral_ =
        std::abs(order.depth_m - state.depth_m) < 3.0
            ? std::clamp(depth_integral_ - 0.004 * (order.depth_m - state.depth_m) * dt_s, -0.2, 0.2)
            : 0.0;
    const double pitching = 0.8 * (pitch + depth_integral_ - rpy.y());
    pitch_integral_ = std::clamp(pitch_integral_ + (pitching - rate.y()) * dt_s, -0.2, 0.2);
    stern_command_rad_ =
        std::clamp(-dynamic_pressure * (1.5 * (pitching - rate.y()) + 1.0 * pitch_integral_), -limit, limit);
  }

  [[nodiscard]] BodyRates dynamics(const BodyState& state) const override {
    const Vector3d V = state.V_B_m_s - turbulence_;
    const Vector3d& omega = state.omega_NB_B_rad_s;
    const double u = V.x(), v = V.y(), w = V.z();
    const double p = omega.x(), q = omega.y(), r = omega.z();
    const double rudder = state.actuator.y(), stern = state.actuator.z();
    // The thrust may lag behind the shaft; without a lag it follows within the interval.
    const double shaft_rpm = config_.beyond.thrust_lag_s > 0.0 ? thrust_rpm_ : state.actuator.x();
    const double drive = shaft_rpm * std::abs(shaft_rpm) / (kThrust_rpm * kThrust_rpm);
    const Hull& k = hull_;
    const auto square = [](double x) { return x * std::abs(x); };

    const double submerged =
        smooth_step((state.depth_m + 0.5 * config_.hull_diameter_m) / config_.hull_diameter_m);
    const Vector3d down_B = state.q_NB.conjugate() * Vector3d::UnitZ();
    const Vector3d weight = kWeight_N * down_B;

    Vector3d force = -kMass_kg * omega.cross(V + omega.cross(kCentreOfGravity_m));
    Vector3d moment = -omega.cross(Vector3d(0.177, 3.45, 3.45).cwiseProduct(omega)) -
                      kMass_kg * kCentreOfGravity_m.cross(omega.cross(V));
    force += weight - submerged * kBuoyancy_N * down_B;
    moment += kCentreOfGravity_m.cross(weight);
    force += Vector3d(
        -k.X_uu * square(u) + k.X_cross * (v * r - w * q) - k.X_turn * (q * q + r * r) + k.X_shaft * drive,
        -k.Y_vv * square(v) + k.Y_rr * square(r) - k.Y_uv * u * v + k.Y_ur * u * r + k.Y_wp * w * p +
            k.Y_pq * p * q + k.Y_rudder * u * u * rudder,
        -k.Z_ww * square(w) - k.Z_qq * square(q) - k.Z_uw * u * w - k.Z_uq * u * q - k.Z_vp * v * p +
            k.Z_rp * r * p - k.Z_stern * u * u * stern);
    moment += Vector3d(-k.K_pp * square(p) - k.K_shaft * drive,
                       k.M_ww * square(w) - k.M_qq * square(q) + k.M_uw * u * w - k.M_uq * u * q -
                           k.M_vp * v * p + k.M_rp * r * p - k.M_stern * u * u * stern,
                       -k.N_vv * square(v) - k.N_rr * square(r) - k.N_uv * u * v - k.N_ur * u * r -
                           k.N_wp * w * p - k.N_pq * p * q - k.N_rudder * u * u * rudder);
    const RemusBeyondModel& beyond = config_.beyond;
    const double linear = beyond.linear_damping_share * kCruise_m_s;
    const double cross = std::hypot(v, w);
    force -= linear * Vector3d(k.X_uu * u, k.Y_uv * v, k.Z_uw * w);
    force -= beyond.cross_flow_share *
             Vector3d(0.0, k.Y_vv * v * (cross - std::abs(v)), k.Z_ww * w * (cross - std::abs(w)));
    moment += submerged * trim_N_m_;
    Vector6 load;
    load << force, moment;
    const Vector6 acceleration = inverse_ * load;

    BodyRates rates;
    rates.V_dot_B_m_s2 = acceleration.head<3>();
    rates.omega_dot_B_rad_s2 = acceleration.tail<3>();
    rates.actuator_dot = {(rpm_command_ - state.actuator.x()) / config_.propulsor_tau_s,
                          (rudder_command_rad_ - rudder) / config_.fin_tau_s,
                          (stern_command_rad_ - stern) / config_.fin_tau_s};
    return rates;
  }

 private:
  /// Velocity of the water under a swell of deep water (Airy), along north and down.
  [[nodiscard]] Vector3d orbital_velocity_N(const BodyState& state) const {
    if (environment_.wave_height_m <= 0.0) return Vector3d::Zero();
    const double frequency = 2.0 * std::numbers::pi / environment_.wave_period_s;
    const double number_1_m = frequency * frequency / kModelGravity_m_s2;
    const double size =
        environment_.wave_height_m * frequency * std::exp(-number_1_m * std::max(state.depth_m, 0.0));
    const double phase = frequency * state.t_s + wave_phase_rad_;
    return {size * std::cos(phase), 0.0, size * std::sin(phase)};
  }

  RemusConfig config_;
  EnvironmentConfig environment_;
  Random random_;
  Hull hull_;
  Matrix6 inverse_;
  Vector3d trim_N_m_ = Vector3d::Zero();
  double wave_phase_rad_ = 0.0;
  double thrust_rpm_ = 0.0;
  GaussMarkov sway_;
  GaussMarkov heave_;
  Vector3d turbulence_ = Vector3d::Zero();
  double rpm_command_ = 0.0;
  double rudder_command_rad_ = 0.0;
  double stern_command_rad_ = 0.0;
  double turn_integral_ = 0.0;
  double pitch_integral_ = 0.0;
  double depth_integral_ = 0.0;
};

}  // namespace

std::unique_ptr<Vehicle> make_remus(const RemusConfig& config, const EnvironmentConfig& environment,
                                    std::uint64_t seed) {
  return std::make_unique<Remus>(config, environment, seed);
}

}  // namespace fathom::sim
