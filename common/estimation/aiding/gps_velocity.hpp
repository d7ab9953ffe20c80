#pragma once

#include "estimation/aiding/gps_position.hpp"

namespace fathom::estimation {

/// A component that is greater is no velocity of a vehicle.
inline constexpr double kMostGpsSpeed_m_s = 1000.0;

/// Velocity of the GPS antenna along N (AID-GPSV-1..2). What the latency state does to the swing of the lever
/// is left out.
class GpsVelocity {
 public:
  using Sample = GpsSample;
  static constexpr const char* kName = "gps_velocity";
  static constexpr int kFirstComponent = 3;

  [[nodiscard]] static Usable append_rows(const AidingInput& in, const Sample& sample, Observation& out) {
    if (!in.sensor.use_velocity) return Usable::not_estimated;
    const Usable can = usable(in.sensor, sample);
    return can == Usable::yes ? append(GpsVelocity(in.state, in.sensor, sample), in, out) : can;
  }
  [[nodiscard]] static AidingPolicy policy(const SensorConfig& /*sensor*/, const Sample& sample) {
    AidingPolicy policy;
    policy.velocity = VelocityOver::ground;
    policy.shows_level = true;
    policy.frozen_by_path = true;
    policy.reading = gps_reading(sample);
    return policy;
  }

  GpsVelocity(const AidingState& s, const SensorConfig& sensor, const GpsSample& sample)
      : s_(s),
        sensor_(sensor),
        sample_(sample),
        lever_B_(geo::vec(sensor.lever_B_m) + s.value3(Group::gps_lever)),
        swing_N_(s.C_NB * geo::cross(s.rate_nb_B_rad_s, lever_B_)),
        latency_s_(s.value(Group::gps_latency, 0)) {}

  [[nodiscard]] static Usable usable(const SensorConfig& sensor, const GpsSample& sample) {
    if (const Usable fix = usable_fix(sensor, sample); fix != Usable::yes) return fix;
    // A receiver that claims an impossible place is not believed in its velocity either; an unknown place is
    // no claim.
    if (known(sample.latitude_rad) && !(std::abs(sample.latitude_rad) <= 1.5707963267948966))
      return Usable::out_of_range;
    if (known(sample.longitude_rad) && !(std::abs(sample.longitude_rad) <= 6.2831853071795865))
      return Usable::out_of_range;
    if (!is_possible_height(sample.altitude_m)) return Usable::out_of_range;
    bool any = false;
    for (const double v : sample.velocity_N_m_s) {
      if (known(v) && !(std::abs(v) < kMostGpsSpeed_m_s)) return Usable::out_of_range;
      any = any || known(v);
    }
    return any ? Usable::yes : Usable::out_of_range;
  }
  [[nodiscard]] int dimension() const { return 3; }
  [[nodiscard]] Vector3 measured() const { return geo::vec(sample_.velocity_N_m_s); }
  [[nodiscard]] Vector3 predicted() const {
    const Vector3 now = s_.state.nav.v_N_m_s + swing_N_;
    return s_.index.has(Group::gps_latency) ? Vector3(now - latency_s_ * s_.acceleration_N_m_s2()) : now;
  }
  void jacobian(Jacobian& h) const {
    // (AID-GPSV-2)
    h.block(Group::velocity, Matrix3::Identity());
    const Vector3 force_N = s_.C_NB * s_.force_B_m_s2;
    h.block(Group::attitude, geo::skew(swing_N_ - latency_s_ * force_N));
    h.block(Group::gyro_bias, -s_.C_NB * geo::skew(lever_B_));
    h.block(Group::gps_lever, -s_.C_NB * geo::skew(s_.rate_nb_B_rad_s));
    if (!s_.index.has(Group::gps_latency)) return;
    h.block(Group::gps_latency, s_.acceleration_N_m_s2());
    h.block(Group::accel_bias, -latency_s_ * s_.C_NB);
    h.block(Group::accel_scale, -latency_s_ * s_.C_NB * s_.force_B_m_s2.asDiagonal());
    // What each misalignment state does to the force: M = [0 m0 m1; m2 0 m3; m4 m5 0] (IMU-1).
    const Vector3& f = s_.force_B_m_s2;
    Eigen::Matrix<double, 3, 6> turned;
    turned << f.y(), f.z(), 0.0, 0.0, 0.0, 0.0,  //
        0.0, 0.0, f.x(), f.z(), 0.0, 0.0,        //
        0.0, 0.0, 0.0, 0.0, f.x(), f.y();
    h.block(Group::accel_misalignment, -latency_s_ * s_.C_NB * turned);
  }
  [[nodiscard]] Vector3 noise() const {
    Vector3 sigma;
    for (std::size_t i = 0; i < 3; ++i)
      sigma(static_cast<int>(i)) =
          sigma_of(sensor_.velocity_sigma_m_s[i], sample_.velocity_sigma_N_m_s[i], sensor_.use_sample_sigma);
    return sigma;
  }

 private:
  const AidingState& s_;
  const SensorConfig& sensor_;
  const GpsSample& sample_;
  Vector3 lever_B_;
  Vector3 swing_N_;
  double latency_s_;
};

}  // namespace fathom::estimation
