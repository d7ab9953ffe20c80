#pragma once

#include "estimation/aiding/model.hpp"
#include "samples/airspeed.hpp"

namespace fathom::estimation {

/// Speed through air whose horizontal motion is the `current` state (AID-AIR-1..2). The indicated speed is
/// taken to true speed with the standard atmosphere's density at the estimated altitude.
class Airspeed {
 public:
  static constexpr const char* kName = "airspeed";

  Airspeed(const AidingState& s, const SensorConfig& sensor, const AirspeedSample& sample)
      : s_(s),
        sensor_(sensor),
        sample_(sample),
        through_N_(s.state.nav.v_N_m_s -
                   Vector3(s.value(Group::current, 0), s.value(Group::current, 1), 0.0)) {}

  [[nodiscard]] static Usable usable(const AidingState& s, const AirspeedSample& sample) {
    if (!(sample.airspeed_m_s > 0.0 && sample.airspeed_m_s < 700.0)) return Usable::out_of_range;
    if (!s.index.has(Group::current)) return Usable::not_estimated;
    // Slower than this the direction of the flow is not known well enough to linearise.
    const Vector3 through =
        s.state.nav.v_N_m_s - Vector3(s.value(Group::current, 0), s.value(Group::current, 1), 0.0);
    return through.norm() > 3.0 ? Usable::yes : Usable::out_of_range;
  }
  [[nodiscard]] int dimension() const { return 1; }
  [[nodiscard]] Vector3 measured() const { return {sample_.airspeed_m_s * true_per_indicated(), 0.0, 0.0}; }
  [[nodiscard]] Vector3 predicted() const { return {through_N_.norm(), 0.0, 0.0}; }
  void jacobian(Jacobian& h) const {
    // (AID-AIR-2)
    const Vector3 along = through_N_.normalized();
    for (int i = 0; i < 3; ++i) h.set(0, Group::velocity, i, along(i));
    for (int i = 0; i < 2; ++i) h.set(0, Group::current, i, along(i));
    const double slope = kDensityExponent * kLapse_1_m / base();
    h.set(0, Group::position, 2, slope * sample_.airspeed_m_s * true_per_indicated());
  }
  [[nodiscard]] Vector3 noise() const {
    const double own = std::hypot(sensor_.sigma[0], sensor_.proportional_sigma * sample_.airspeed_m_s);
    return {sigma_of(own, sample_.sigma_m_s, sensor_.use_sample_sigma), 0.0, 0.0};
  }

 private:
  // The ISA troposphere: density is a power of this.
  static constexpr double kLapse_1_m = 2.25577e-5;
  static constexpr double kDensityExponent = 2.12794;  ///< half the density's own, for the square root
  [[nodiscard]] double base() const {
    const double value = 1.0 - kLapse_1_m * s_.state.nav.position.altitude_m;
    return value > 0.3 ? value : 0.3;
  }
  [[nodiscard]] double true_per_indicated() const { return std::pow(base(), -kDensityExponent); }

  const AidingState& s_;
  const SensorConfig& sensor_;
  const AirspeedSample& sample_;
  Vector3 through_N_;
};

}  // namespace fathom::estimation
