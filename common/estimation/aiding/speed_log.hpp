#pragma once

#include <algorithm>
#include <cmath>

#include "estimation/aiding/model.hpp"
#include "estimation/hydro/shaft_speed.hpp"
#include "samples/actuator.hpp"

namespace fathom::estimation {

/// What an instrument of this kind has where its configuration says nothing.
inline void set_defaults(SensorConfig& sensor, const PropulsionSample* /*kind*/) {
  sensor.sigma = {0.15, 0.1, 0.1};
  sensor.proportional_sigma = 0.01;
  sensor.robust = RobustKind::student_t;
}

/// Speed through the water from the propulsor's shaft speed, and the knowledge that such a vehicle moves
/// along its own axis: along x the speed, across it zero, each with its sigma (AID-LOG-1..3). Slip, of the
/// propulsor as of the hull, lasts for a while. Without current states the water is taken to stand still.
class SpeedLog {
 public:
  using Sample = PropulsionSample;
  static constexpr const char* kName = "speed_log";

  [[nodiscard]] static Usable append_rows(const AidingInput& in, const Sample& sample, Observation& out) {
    if (in.water != nullptr)
      return Usable::not_estimated;  // the vehicle model knows more of the same shaft speed
    const Usable can = usable(in.state, in.sensor, sample, in.surface_altitude_m);
    return can == Usable::yes ? append(SpeedLog(in.state, in.sensor, sample, in.unused_s), in, out) : can;
  }
  [[nodiscard]] static AidingPolicy policy(const SensorConfig& /*sensor*/, const Sample& /*sample*/) {
    AidingPolicy policy;
    policy.velocity = VelocityOver::medium;
    return policy;  // a shaft may well keep its speed: nothing tells a frozen reading
  }
  [[nodiscard]] static bool may_aid(const SensorConfig& sensor) { return sensor.scale_m_s_per_rpm != 0.0; }

  /// `unused_s`: since the last sample that was used, unknown before the first.
  SpeedLog(const AidingState& s, const SensorConfig& sensor, const PropulsionSample& sample, double unused_s)
      : s_(s),
        sensor_(sensor),
        unused_s_(unused_s),
        speed_m_s_(sensor.scale_m_s_per_rpm * sample.rpm),
        lever_B_(geo::vec(sensor.lever_B_m)),
        through_N_(s.velocity_through_medium_N_m_s()) {}

  [[nodiscard]] static Usable usable(const AidingState& s, const SensorConfig& sensor,
                                     const PropulsionSample& sample, double surface_altitude_m) {
    if (!may_aid(sensor)) return Usable::not_estimated;
    if (!(std::abs(sample.rpm) > 1.0 && believable_rpm(sample.rpm))) return Usable::out_of_range;
    const double depth =
        s.value(Group::surface_altitude, 0, surface_altitude_m) - s.state.nav.position.altitude_m;
    return sensor.min_depth_m <= 0.0 || depth >= sensor.min_depth_m ? Usable::yes : Usable::out_of_range;
  }
  [[nodiscard]] int dimension() const { return 3; }
  [[nodiscard]] Vector3 measured() const {
    return {speed_m_s_ * (1.0 + s_.value(Group::log_scale, 0)), 0.0, 0.0};
  }
  [[nodiscard]] Vector3 predicted() const {
    return s_.C_NB.transpose() * through_N_ + geo::cross(s_.rate_nb_B_rad_s, lever_B_);
  }
  void jacobian(Jacobian& h) const {
    // (AID-LOG-2)
    const Matrix3 to_B = s_.C_NB.transpose();
    h.block(Group::velocity, to_B);
    h.block(Group::attitude, -to_B * geo::skew(through_N_));
    h.block(Group::gyro_bias, -geo::skew(lever_B_));
    h.block(Group::current, to_B.leftCols<2>());
    h.set(0, Group::log_scale, 0, speed_m_s_);
  }
  [[nodiscard]] Vector3 noise() const {
    const double extra = sensor_.proportional_sigma * std::abs(speed_m_s_);
    // (AID-LOG-3)
    const bool again = unused_s_ < sensor_.slip_time_s;
    const double lasting = again ? std::sqrt(sensor_.slip_time_s / std::max(unused_s_, kShortest_s)) : 1.0;
    return lasting * Vector3(std::hypot(sensor_.sigma[0], extra), std::hypot(sensor_.sigma[1], extra),
                             std::hypot(sensor_.sigma[2], extra));
  }

 private:
  static constexpr double kShortest_s = 1e-3;

  const AidingState& s_;
  const SensorConfig& sensor_;
  double unused_s_;
  double speed_m_s_;
  Vector3 lever_B_;
  Vector3 through_N_;
};

}  // namespace fathom::estimation
