#pragma once

#include "estimation/aiding/model.hpp"
#include "samples/depth.hpp"

namespace fathom::estimation {

/// What an instrument of this kind has where its configuration says nothing.
inline void set_defaults(SensorConfig& sensor, const DepthSample* /*kind*/) {
  sensor.sigma = {0.05, 0.05, 0.05};
  sensor.reacquire_s = 5.0;
  sensor.frozen_change = 1.0;
}

/// Depth of the pressure port below a water surface whose ellipsoidal height is estimated, or configured
/// (AID-DEP-1..2). So GPS altitude and depth agree without the surface having to be at zero.
class Depth {
 public:
  using Sample = DepthSample;
  static constexpr const char* kName = "depth";

  [[nodiscard]] static Usable append_rows(const AidingInput& in, const Sample& sample, Observation& out) {
    const Usable can = usable(sample);
    return can == Usable::yes ? append(Depth(in.state, in.sensor, sample, in.surface_altitude_m), in, out)
                              : can;
  }
  [[nodiscard]] static AidingPolicy policy(const SensorConfig& /*sensor*/, const Sample& sample) {
    AidingPolicy policy;
    policy.reading = {sample.depth_m, 0.0, 0.0};
    return policy;
  }

  Depth(const AidingState& s, const SensorConfig& sensor, const DepthSample& sample,
        double surface_altitude_m)
      : s_(s),
        sensor_(sensor),
        sample_(sample),
        surface_m_(s.value(Group::surface_altitude, 0, surface_altitude_m)),
        lever_N_(s.C_NB * geo::vec(sensor.lever_B_m)) {}

  [[nodiscard]] static Usable usable(const DepthSample& sample) {
    return sample.depth_m > -50.0 && sample.depth_m < 12000.0 ? Usable::yes : Usable::out_of_range;
  }
  [[nodiscard]] int dimension() const { return 1; }
  [[nodiscard]] Vector3 measured() const { return {sample_.depth_m, 0.0, 0.0}; }
  [[nodiscard]] Vector3 predicted() const {
    return {surface_m_ - s_.state.nav.position.altitude_m + lever_N_.z() + s_.value(Group::depth_bias, 0),
            0.0, 0.0};
  }
  void jacobian(Jacobian& h) const {
    // (AID-DEP-2)
    h.set(0, Group::position, 2, 1.0);
    h.set(0, Group::attitude, 0, -lever_N_.y());
    h.set(0, Group::attitude, 1, lever_N_.x());
    h.set(0, Group::surface_altitude, 0, -1.0);
    h.set(0, Group::depth_bias, 0, -1.0);
  }
  [[nodiscard]] Vector3 noise() const {
    const double own = std::hypot(sensor_.sigma[0], sensor_.proportional_sigma * sample_.depth_m);
    return {sigma_of(own, sample_.sigma_m, sensor_.use_sample_sigma), 0.0, 0.0};
  }

 private:
  const AidingState& s_;
  const SensorConfig& sensor_;
  const DepthSample& sample_;
  double surface_m_;
  Vector3 lever_N_;
};

}  // namespace fathom::estimation
