#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "geo/wgs84.hpp"
#include "sim/vehicle.hpp"

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
constexpr double kThrust_N = 3.86;
constexpr double kTorque_N_m = -0.543;
constexpr double kThrust_rpm = 1500.0;
constexpr double kCruise_m_s = 1.5436;  // where kThrust_N balances the drag
const Vector3d kCentreOfGravity_m(0.0, 0.0, 0.0196);

Matrix6 added_mass() {
  Matrix6 a = Matrix6::Zero();
  a.diagonal() << 0.93, 35.5, 35.5, 0.0704, 4.88, 4.88;
  a(1, 5) = a(5, 1) = -1.93;
  a(2, 4) = a(4, 2) = 1.93;
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
      : config_(config), random_(seed, "remus"), inverse_((rigid_body() + added_mass()).inverse()) {
    sway_ = GaussMarkov(environment.turbulence_m_s, environment.turbulence_tau_s, random_);
    heave_ = GaussMarkov(environment.turbulence_m_s, environment.turbulence_tau_s, random_);
  }

  void control(const BodyState& state, const Order& order, double dt_s) override {
    turbulence_ = {0.0, sway_.advance(dt_s, random_), heave_.advance(dt_s, random_)};
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
    const double drive = state.actuator.x() * std::abs(state.actuator.x()) / (kThrust_rpm * kThrust_rpm);
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
    force += Vector3d(-1.62 * square(u) + 35.5 * (v * r - w * q) - 1.93 * (q * q + r * r) + kThrust_N * drive,
                      -131.0 * square(v) + 0.632 * square(r) - 28.6 * u * v + 5.22 * u * r + 35.5 * w * p +
                          1.93 * p * q + 9.64 * u * u * rudder,
                      -131.0 * square(w) - 0.632 * square(q) - 28.6 * u * w - 5.22 * u * q - 35.5 * v * p +
                          1.93 * r * p - 9.64 * u * u * stern);
    moment += Vector3d(-0.13 * square(p) + kTorque_N_m * drive,
                       3.18 * square(w) - 188.0 * square(q) + 24.0 * u * w - 2.0 * u * q - 1.93 * v * p +
                           4.86 * r * p - 6.15 * u * u * stern,
                       -3.18 * square(v) - 94.0 * square(r) - 24.0 * u * v - 2.0 * u * r - 1.93 * w * p -
                           4.86 * p * q - 6.15 * u * u * rudder);
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
  RemusConfig config_;
  Random random_;
  Matrix6 inverse_;
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
