#include "sim/truth_generator.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "geo/wgs84.hpp"
#include "sim/random.hpp"
#include "sim/vehicles/vehicle.hpp"

namespace fathom::sim {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double kLongestStep_s = 0.005;

// One flat vector, so that Runge-Kutta is four lines.
enum : int {
  kLat = 0,
  kLon = 1,
  kAlt = 2,
  kAttitude = 3,
  kV = 7,
  kOmega = 10,
  kActuator = 13,
  kAngle = 16,
  kDv = 19,
  kSize = 22
};
using State = Eigen::Matrix<double, kSize, 1>;

Quaterniond attitude_of(const State& x) {
  return Quaterniond(x[kAttitude], x[kAttitude + 1], x[kAttitude + 2], x[kAttitude + 3]);
}

geo::Geodetic geodetic_of(const TruthPoint& point) {
  return {point.latitude_rad, point.longitude_rad, point.altitude_m};
}

void place(TruthPoint& point, const geo::Geodetic& at) {
  point.latitude_rad = at.latitude_rad;
  point.longitude_rad = at.longitude_rad;
  point.altitude_m = at.altitude_m;
}

struct Medium {
  Vector3d velocity_N = Vector3d::Zero();
  Vector3d velocity_dot_N = Vector3d::Zero();
};

Medium medium_at(const EnvironmentConfig& environment, double t_s, double depth_m, double sink_m_s) {
  const Vector3d current{environment.current_N_m_s[0], environment.current_N_m_s[1], 0.0};
  const Vector3d wind{environment.wind_N_m_s[0], environment.wind_N_m_s[1], 0.0};
  const double ramp = std::max(environment.current_ramp_s, 1e-3);
  const double x = (t_s - environment.current_from_s) / ramp;
  const double grown = environment.current_from_s > 0.0 ? smooth_step(x) : 1.0;
  const double growth = environment.current_from_s > 0.0 ? smooth_step_slope(x) / ramp : 0.0;
  // The medium changes from air to water over the last metre above the surface.
  const double wet = smooth_step(depth_m + 1.0);
  const double wetting = smooth_step_slope(depth_m + 1.0) * sink_m_s;
  return {wet * grown * current + (1.0 - wet) * wind,
          wet * growth * current + wetting * (grown * current - wind)};
}

}  // namespace

struct TruthGenerator::Impl {
  Impl(const Scenario& s, std::uint64_t seed) : scenario(s), vehicle(make_vehicle(s, seed)) {
    if (scenario.environment.current_spread_m_s > 0.0) draw_current(seed);
    const auto& start = scenario.start;
    x.setZero();
    x[kLat] = start.latitude_rad;
    x[kLon] = start.longitude_rad;
    x[kAlt] = scenario.environment.surface_altitude_m - start.depth_m;
    Quaterniond q = q_of_rpy(start.rpy_rad[0], start.rpy_rad[1], start.rpy_rad[2]);
    x[kV] = start.speed_m_s;
    if (spreads(start.spread)) draw_start(seed, q);
    x.segment<4>(kAttitude) << q.w(), q.x(), q.y(), q.z();
    order.speed_m_s = start.speed_m_s;
    order.heading_rad = start.rpy_rad[2];
    order.depth_m = start.depth_m;
    update_order(0.0);
    if (scenario.vehicle.kind == VehicleConfig::Kind::rotating_arm) {
      x[kOmega + 2] = start.speed_m_s / scenario.vehicle.rotating_arm.radius_m;
    }
    publish(0.0);
  }

  static bool spreads(const StartSpread& spread) {
    const auto any = [](const std::array<double, 3>& sigma) {
      return std::any_of(sigma.begin(), sigma.end(), [](double one) { return one > 0.0; });
    };
    return any(spread.position_N_m) || any(spread.velocity_N_m_s) || any(spread.attitude_rad);
  }

  void draw_current(std::uint64_t seed) {
    Random random(seed, "environment.current");
    for (double& component : scenario.environment.current_N_m_s)
      component += random.normal(scenario.environment.current_spread_m_s);
  }

  /// The true start about the configured one: place, velocity over ground, and attitude turned about N.
  void draw_start(std::uint64_t seed, Quaterniond& q_NB) {
    Random random(seed, "start");
    const auto draw = [&](const std::array<double, 3>& sigma) {
      const double north = random.normal(sigma[0]);
      const double east = random.normal(sigma[1]);
      const double down = random.normal(sigma[2]);
      return Vector3d(north, east, down);
    };
    const StartSpread& spread = scenario.start.spread;
    const Vector3d moved_N_m = draw(spread.position_N_m);
    const Vector3d v_N_m_s = q_NB * x.segment<3>(kV).eval() + draw(spread.velocity_N_m_s);
    const Vector3d turn_rad = draw(spread.attitude_rad);
    const geo::Geodetic at = geo::moved_by({x[kLat], x[kLon], x[kAlt]}, moved_N_m);
    x[kLat] = at.latitude_rad;
    x[kLon] = at.longitude_rad;
    x[kAlt] = at.altitude_m;
    if (const double angle = turn_rad.norm(); angle > 0.0)
      q_NB = Quaterniond(Eigen::AngleAxisd(angle, turn_rad / angle)) * q_NB;
    x.segment<3>(kV) = q_NB.conjugate() * v_N_m_s;
  }

  void update_order(double t_s) {
    while (next_step < scenario.mission.size() && scenario.mission[next_step].at_s <= t_s + 1e-9) {
      const auto& step = scenario.mission[next_step++];
      if (known(step.speed_m_s)) order.speed_m_s = step.speed_m_s;
      if (known(step.heading_rad)) order.heading_rad = step.heading_rad;
      if (known(step.depth_m)) order.depth_m = step.depth_m;
      if (known(step.bank_rad)) order.bank_rad = step.bank_rad;
      if (known(step.dutch_roll_rad)) order.dutch_roll_rad = step.dutch_roll_rad;
    }
  }

  [[nodiscard]] BodyState body(double t_s, const State& s) const {
    BodyState out;
    out.t_s = t_s;
    out.depth_m = scenario.environment.surface_altitude_m - s[kAlt];
    out.V_B_m_s = s.segment<3>(kV);
    out.omega_NB_B_rad_s = s.segment<3>(kOmega);
    out.q_NB = attitude_of(s).normalized();
    out.actuator = s.segment<3>(kActuator);
    return out;
  }

  /// Right-hand side; fills `now` with the instant's truth where asked.
  State derivative(double t_s, const State& s, TruthPoint* now) const {
    const BodyState state = body(t_s, s);
    const BodyRates rates = vehicle->dynamics(state);
    const Vector3d V_N = state.q_NB * state.V_B_m_s;
    const Medium medium = medium_at(scenario.environment, t_s, state.depth_m, V_N.z());
    const Vector3d v_N = V_N + medium.velocity_N;

    const double lat = s[kLat];
    const double alt = s[kAlt];
    const geo::Radii radii = geo::radii(lat);
    const Vector3d omega_IE = geo::earth_rate_N(lat);
    const Vector3d omega_EN = geo::transport_rate_N({lat, s[kLon], alt}, v_N);
    const Vector3d gravity_N = geo::gravity_N(lat, alt);
    const Vector3d inertial_N = medium.velocity_dot_N + (2.0 * omega_IE + omega_EN).cross(v_N) - gravity_N;
    const Vector3d f_B = rates.V_dot_B_m_s2 + state.omega_NB_B_rad_s.cross(state.V_B_m_s) +
                         state.q_NB.conjugate() * inertial_N;
    const Vector3d omega_IB_B = state.omega_NB_B_rad_s + state.q_NB.conjugate() * (omega_IE + omega_EN);

    State dot;
    dot[kLat] = v_N.x() / (radii.meridian_m + alt);
    dot[kLon] = v_N.y() / ((radii.normal_m + alt) * std::cos(lat));
    dot[kAlt] = -v_N.z();
    const Quaterniond q_dot =
        attitude_of(s) *
        Quaterniond(0.0, state.omega_NB_B_rad_s.x(), state.omega_NB_B_rad_s.y(), state.omega_NB_B_rad_s.z());
    dot.segment<4>(kAttitude) << 0.5 * q_dot.w(), 0.5 * q_dot.x(), 0.5 * q_dot.y(), 0.5 * q_dot.z();
    dot.segment<3>(kV) = rates.V_dot_B_m_s2;
    dot.segment<3>(kOmega) = rates.omega_dot_B_rad_s2;
    dot.segment<3>(kActuator) = rates.actuator_dot;
    dot.segment<3>(kAngle) = omega_IB_B;
    dot.segment<3>(kDv) = f_B;
    if (now != nullptr) {
      now->v_N_m_s = v_N;
      now->omega_IB_B_rad_s = omega_IB_B;
      now->f_B_m_s2 = f_B;
    }
    return dot;
  }

  void publish(double t_s) {
    point.t_s = t_s;
    point.latitude_rad = x[kLat];
    point.longitude_rad = x[kLon];
    point.altitude_m = x[kAlt];
    point.q_NB = attitude_of(x);
    point.omega_NB_B_rad_s = x.segment<3>(kOmega);
    point.V_B_m_s = x.segment<3>(kV);
    const auto& environment = scenario.environment;
    point.depth_m = environment.surface_altitude_m - x[kAlt];
    const double north_m = (x[kLat] - scenario.start.latitude_rad) * geo::radii(x[kLat]).meridian_m;
    point.water_depth_m = environment.water_depth_m + environment.bottom_slope_N * north_m;
    point.rpm = x[kActuator];
    point.rudder_rad = x[kActuator + 1];
    point.stern_rad = x[kActuator + 2];
    (void)derivative(t_s, x, &point);
  }

  ImuTruth advance_to(double t_s) {
    const double t0 = point.t_s;
    const double dt = t_s - t0;
    update_order(t0);
    BodyState seen = body(t0, x);
    seen.q_steered_NB = steered ? *steered : seen.q_NB;
    vehicle->control(seen, order, dt);
    x.segment<6>(kAngle).setZero();
    const int steps = std::max(1, static_cast<int>(std::ceil(dt / kLongestStep_s - 1e-9)));
    const double h = dt / steps;
    for (int i = 0; i < steps; ++i) {
      const double t = t0 + i * h;
      const State k1 = derivative(t, x, nullptr);
      const State k2 = derivative(t + 0.5 * h, x + 0.5 * h * k1, nullptr);
      const State k3 = derivative(t + 0.5 * h, x + 0.5 * h * k2, nullptr);
      const State k4 = derivative(t + h, x + h * k3, nullptr);
      x += (h / 6.0) * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
      x.segment<4>(kAttitude).normalize();
    }
    publish(t_s);
    return {dt, x.segment<3>(kAngle), x.segment<3>(kDv)};
  }

  Scenario scenario;
  std::unique_ptr<Vehicle> vehicle;
  State x;
  Order order;
  std::size_t next_step = 0;
  TruthPoint point;
  std::optional<Quaterniond> steered;
};

TruthGenerator::TruthGenerator(const Scenario& scenario, std::uint64_t seed)
    : impl_(std::make_unique<Impl>(scenario, seed)) {}
TruthGenerator::~TruthGenerator() = default;
TruthGenerator::TruthGenerator(TruthGenerator&&) noexcept = default;
TruthGenerator& TruthGenerator::operator=(TruthGenerator&&) noexcept = default;

const TruthPoint& TruthGenerator::point() const {
  return impl_->point;
}

ImuTruth TruthGenerator::advance_to(double t_s) {
  return impl_->advance_to(t_s);
}

void TruthGenerator::steer_by(const Quaterniond& q_NB) {
  impl_->steered = q_NB;
}

TruthPoint interpolate(const TruthPoint& a, const TruthPoint& b, double t_s) {
  const double dt = b.t_s - a.t_s;
  if (dt <= 0.0) return b;
  const double s = (t_s - a.t_s) / dt;
  const auto linear = [s](const auto& from, const auto& to) { return from + s * (to - from); };
  TruthPoint out = a;
  out.t_s = t_s;
  // Hermite cubic in north-east-down metres about `a`.
  const geo::Geodetic from = geodetic_of(a);
  const Vector3d chord = geo::difference_N(from, geodetic_of(b));
  const double s2 = s * s;
  const double s3 = s2 * s;
  const Vector3d moved =
      (3.0 * s2 - 2.0 * s3) * chord + (s3 - 2.0 * s2 + s) * dt * a.v_N_m_s + (s3 - s2) * dt * b.v_N_m_s;
  place(out, geo::moved_by(from, moved));
  out.v_N_m_s = linear(a.v_N_m_s, b.v_N_m_s);
  out.q_NB = a.q_NB.slerp(s, b.q_NB);
  out.omega_NB_B_rad_s = linear(a.omega_NB_B_rad_s, b.omega_NB_B_rad_s);
  out.omega_IB_B_rad_s = linear(a.omega_IB_B_rad_s, b.omega_IB_B_rad_s);
  out.f_B_m_s2 = linear(a.f_B_m_s2, b.f_B_m_s2);
  out.V_B_m_s = linear(a.V_B_m_s, b.V_B_m_s);
  out.depth_m = a.depth_m + moved.z();
  out.water_depth_m = linear(a.water_depth_m, b.water_depth_m);
  out.rpm = linear(a.rpm, b.rpm);
  out.rudder_rad = linear(a.rudder_rad, b.rudder_rad);
  out.stern_rad = linear(a.stern_rad, b.stern_rad);
  return out;
}

TruthPoint at_lever(const TruthPoint& point, const Vector3d& lever_B_m) {
  TruthPoint out = point;
  const Vector3d lever_N = point.q_NB * lever_B_m;
  place(out, geo::moved_by(geodetic_of(point), lever_N));
  const Vector3d turning_B = point.omega_NB_B_rad_s.cross(lever_B_m);
  out.v_N_m_s += point.q_NB * turning_B;
  out.V_B_m_s += turning_B;
  out.depth_m += lever_N.z();
  return out;
}

}  // namespace fathom::sim
