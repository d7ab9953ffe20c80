#pragma once

#include "estimation/aiding/model.hpp"
#include "estimation/aiding/underwater_place.hpp"
#include "samples/position/fix.hpp"

namespace fathom::estimation {

/// What an instrument of this kind has where its configuration says nothing. Nothing is believed because it
/// is told again: a person who knows better orders the position.
inline void set_defaults(SensorConfig& sensor, const FixSample* /*kind*/) {
  sensor.sigma = {1.0, 1.0, 1.0};
  sensor.reacquire_s = 0.0;
}

/// A position that somebody tells (AID-FIX-1): NED metres relative to the estimated position of the IMU.
class FixPosition {
 public:
  using Sample = FixSample;
  static constexpr const char* kName = "fix_position";

  [[nodiscard]] static Usable append_rows(const AidingInput& in, const Sample& sample, Observation& out) {
    const Usable can = usable(in.sensor, sample);
    return can == Usable::yes ? append(FixPosition(in, sample), in, out) : can;
  }
  [[nodiscard]] static AidingPolicy policy(const SensorConfig& /*sensor*/, const Sample& /*sample*/) {
    AidingPolicy policy;
    policy.position = true;
    policy.told = true;
    return policy;
  }

  FixPosition(const AidingInput& in, const Sample& sample)
      : s_(in.state),
        sensor_(in.sensor),
        sample_(sample),
        surface_m_(in.state.value(Group::surface_altitude, 0, in.surface_altitude_m)),
        lever_N_(in.state.C_NB * geo::vec(in.sensor.lever_B_m)) {}

  [[nodiscard]] static Usable usable(const SensorConfig& sensor, const Sample& sample) {
    // Whoever tells a position says how well it is known.
    if (sensor.use_sample_sigma && !known(sample.sigma_m)) return Usable::out_of_range;
    return usable_place(sample);
  }
  [[nodiscard]] int dimension() const { return 3; }
  [[nodiscard]] Vector3 measured() const { return place_N_m(s_, sample_); }
  [[nodiscard]] Vector3 predicted() const {
    return {lever_N_.x(), lever_N_.y(), surface_m_ - s_.state.nav.position.altitude_m + lever_N_.z()};
  }
  void jacobian(Jacobian& h) const {
    h.block(Group::position, Matrix3::Identity());
    h.block(Group::attitude, geo::skew(lever_N_));
    h.set(2, Group::surface_altitude, 0, -1.0);
  }
  [[nodiscard]] Vector3 noise() const {
    const auto sigma = [&](std::size_t axis, double told) {
      return sigma_of(sensor_.sigma[axis], told, sensor_.use_sample_sigma);
    };
    return {sigma(0, sample_.sigma_m), sigma(1, sample_.sigma_m), sigma(2, sample_.depth_sigma_m)};
  }

 private:
  const AidingState& s_;
  const SensorConfig& sensor_;
  const Sample& sample_;
  double surface_m_;
  Vector3 lever_N_;
};

}  // namespace fathom::estimation
