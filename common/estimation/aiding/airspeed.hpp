#pragma once

#include <algorithm>
#include <cmath>

#include "estimation/aiding/model.hpp"
#include "samples/airspeed.hpp"

namespace fathom::estimation {

/// What an instrument of this kind has where its configuration says nothing.
inline void set_defaults(SensorConfig& sensor, const AirspeedSample* /*kind*/) {
  sensor.sigma = {1.0, 1.0, 1.0};
  sensor.robust = RobustKind::student_t;
}

/// A gust lasts (AID-AIR-3): by how much the sigma of a sample is raised that comes `unused_s` after the one
/// before.
[[nodiscard]] inline double lasting_gust(const SensorConfig& sensor, double unused_s) {
  constexpr double kShortest_s = 1e-3;
  return unused_s < sensor.gust_time_s ? std::sqrt(sensor.gust_time_s / std::max(unused_s, kShortest_s))
                                       : 1.0;
}

/// Sideslip or angle of attack is a row beside each airspeed (flow_angles.hpp).
[[nodiscard]] inline bool has_flow_angles(const SensorConfig& sensor) {
  return sensor.sideslip_sigma_rad > 0.0 || sensor.attack_sigma_rad > 0.0;
}

/// What a sample of air data means. A speed alone has no direction; flow angles beside it have.
[[nodiscard]] inline AidingPolicy air_data_policy(const SensorConfig& /*sensor*/,
                                                  const AirspeedSample& sample) {
  AidingPolicy policy;
  policy.velocity = VelocityOver::medium;
  policy.reading = {sample.airspeed_m_s, sample.true_airspeed_m_s, 0.0};
  return policy;
}

/// Slower than this the direction of the flow is not known well enough to linearise.
inline constexpr double kLeastAirspeed_m_s = 3.0;

/// Airspeed (AID-AIR-1..2): the speed through the air, its scale and a bias. An indicated one is less by the
/// standard atmosphere's density at the estimated altitude; a true one (AID-AIR-4) knows the air's own and is
/// taken where the sample has both.
class Airspeed {
 public:
  using Sample = AirspeedSample;
  static constexpr const char* kName = "airspeed";

  [[nodiscard]] static Usable append_rows(const AidingInput& in, const Sample& sample, Observation& out) {
    const Usable can = usable(in.state, sample);
    return can == Usable::yes ? append(Airspeed(in.state, in.sensor, sample, in.unused_s), in, out) : can;
  }
  [[nodiscard]] static AidingPolicy policy(const SensorConfig& sensor, const Sample& sample) {
    return air_data_policy(sensor, sample);
  }

  /// `unused_s`: since the last sample that was used, unknown before the first.
  Airspeed(const AidingState& s, const SensorConfig& sensor, const AirspeedSample& sample,
           double unused_s = kUnknown)
      : s_(s),
        sensor_(sensor),
        sample_(sample),
        is_true_(known(sample.true_airspeed_m_s)),
        lasting_(lasting_gust(sensor, unused_s)),
        through_N_(s.velocity_through_medium_N_m_s()) {}

  [[nodiscard]] static Usable usable(const AidingState& s, const AirspeedSample& sample) {
    const double airspeed_m_s = measured_m_s(sample);
    if (!(airspeed_m_s > 0.0 && airspeed_m_s < 700.0)) return Usable::out_of_range;
    if (!s.index.has(Group::current)) return Usable::not_estimated;
    return s.velocity_through_medium_N_m_s().norm() > kLeastAirspeed_m_s ? Usable::yes : Usable::out_of_range;
  }
  [[nodiscard]] int dimension() const { return 1; }
  [[nodiscard]] Vector3 measured() const { return {measured_m_s(sample_), 0.0, 0.0}; }
  [[nodiscard]] Vector3 predicted() const {
    return {indicated_per_true() * through_N_.norm() + s_.value(Group::airspeed_bias, 0), 0.0, 0.0};
  }
  void jacobian(Jacobian& h) const {
    // (AID-AIR-2)
    const Vector3 along = indicated_per_true() * through_N_.normalized();
    for (int i = 0; i < 3; ++i) h.set(0, Group::velocity, i, along(i));
    for (int i = 0; i < 2; ++i) h.set(0, Group::current, i, along(i));
    const double speed = through_N_.norm();
    if (!is_true_)
      h.set(0, Group::position, 2, kDensityExponent * kLapse_1_m / base() * indicated_per_true() * speed);
    h.set(0, Group::airspeed_scale, 0, -density_ratio_root() * speed);
    h.set(0, Group::airspeed_bias, 0, -1.0);
  }
  [[nodiscard]] Vector3 noise() const {
    const double own = std::hypot(sensor_.sigma[0], sensor_.proportional_sigma * measured_m_s(sample_));
    return {lasting_ * sigma_of(own, sample_.sigma_m_s, sensor_.use_sample_sigma), 0.0, 0.0};
  }

 private:
  // The ISA troposphere: density is a power of this.
  static constexpr double kLapse_1_m = 2.25577e-5;
  static constexpr double kDensityExponent = 2.12794;  ///< half the density's own, for the square root
  [[nodiscard]] static double measured_m_s(const AirspeedSample& sample) {
    return known(sample.true_airspeed_m_s) ? sample.true_airspeed_m_s : sample.airspeed_m_s;
  }
  [[nodiscard]] double base() const {
    const double value = 1.0 - kLapse_1_m * s_.state.nav.position.altitude_m;
    return value > 0.3 ? value : 0.3;
  }
  [[nodiscard]] double density_ratio_root() const {
    return is_true_ ? 1.0 : std::pow(base(), kDensityExponent);
  }
  [[nodiscard]] double indicated_per_true() const {
    return (1.0 + s_.value(Group::airspeed_scale, 0)) * density_ratio_root();
  }

  const AidingState& s_;
  const SensorConfig& sensor_;
  const AirspeedSample& sample_;
  bool is_true_;
  double lasting_;
  Vector3 through_N_;
};

}  // namespace fathom::estimation
