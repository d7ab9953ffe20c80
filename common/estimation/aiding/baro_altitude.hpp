#pragma once

#include "estimation/aiding/airspeed.hpp"
#include "samples/airspeed.hpp"

namespace fathom::estimation {

/// Barometric height: the ellipsoidal altitude and a bias that holds the weather, the geoid and the setting
/// of the instrument (AID-BARO-1..2).
class BaroAltitude {
 public:
  using Sample = AirspeedSample;
  static constexpr const char* kName = "baro_altitude";
  static constexpr int kFirstComponent = 3;

  [[nodiscard]] static Usable append_rows(const AidingInput& in, const Sample& sample, Observation& out) {
    const Usable can = usable(in.sensor, sample);
    if (can != Usable::yes) return can;
    out.each_alone = true;
    return append(BaroAltitude(in.state, in.sensor, sample), in, out);
  }
  [[nodiscard]] static AidingPolicy policy(const SensorConfig& sensor, const Sample& sample) {
    AidingPolicy policy = air_data_policy(sensor, sample);
    policy.velocity = VelocityOver::none;
    return policy;
  }

  BaroAltitude(const AidingState& s, const SensorConfig& sensor, const AirspeedSample& sample)
      : s_(s), sensor_(sensor), sample_(sample) {}

  [[nodiscard]] static Usable usable(const SensorConfig& sensor, const AirspeedSample& sample) {
    if (sensor.baro_sigma_m <= 0.0) return Usable::not_estimated;
    return sample.baro_altitude_m > -1000.0 && sample.baro_altitude_m < 5e4 ? Usable::yes
                                                                            : Usable::out_of_range;
  }
  [[nodiscard]] int dimension() const { return 1; }
  [[nodiscard]] Vector3 measured() const { return {sample_.baro_altitude_m, 0.0, 0.0}; }
  [[nodiscard]] Vector3 predicted() const {
    return {s_.state.nav.position.altitude_m + s_.value(Group::baro_bias, 0), 0.0, 0.0};  // (AID-BARO-1)
  }
  void jacobian(Jacobian& h) const {
    // (AID-BARO-2)
    h.set(0, Group::position, 2, -1.0);
    h.set(0, Group::baro_bias, 0, -1.0);
  }
  [[nodiscard]] Vector3 noise() const { return {sensor_.baro_sigma_m, 0.0, 0.0}; }

 private:
  const AidingState& s_;
  const SensorConfig& sensor_;
  const AirspeedSample& sample_;
};

}  // namespace fathom::estimation
