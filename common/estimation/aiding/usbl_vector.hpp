#pragma once

#include "estimation/aiding/usbl_position.hpp"
#include "estimation/aiding/usbl_range_bearing.hpp"
#include "estimation/aiding/usbl_station.hpp"

namespace fathom::estimation {

/// Relative acoustic fix by its components along the transceiver's axes (AID-USBLR-1..2), each standing
/// alone.
class UsblVector {
 public:
  using Sample = UsblSample;
  static constexpr const char* kName = "usbl_vector";

  [[nodiscard]] static Usable append_rows(const AidingInput& in, const Sample& sample, Observation& out) {
    if (sample.frame == UsblFrame::geodetic || UsblRangeBearing::present(sample)) return Usable::other_model;
    const Usable can = usable(in.sensor, sample);
    return can == Usable::yes
               ? append(UsblVector(in.state, in.sensor, sample, in.surface_altitude_m), in, out)
               : can;
  }
  [[nodiscard]] static AidingPolicy policy(const SensorConfig& /*sensor*/, const Sample& sample) {
    return usbl_policy(sample.relative_m, known(sample.relative_m[0]) && known(sample.relative_m[1]));
  }

  UsblVector(const AidingState& s, const SensorConfig& sensor, const UsblSample& sample,
             double surface_altitude_m)
      : sensor_(sensor), sample_(sample), path_(s, sensor, sample, surface_altitude_m) {}

  [[nodiscard]] static Usable usable(const SensorConfig& sensor, const UsblSample& sample) {
    for (const double component : sample.relative_m)
      if (known(component) && !(std::abs(component) <= kMostUsblRange_m)) return Usable::out_of_range;
    return UsblStation::usable(sensor, sample);
  }
  [[nodiscard]] int dimension() const { return 3; }
  [[nodiscard]] Vector3 measured() const { return geo::vec(sample_.relative_m); }
  [[nodiscard]] Vector3 predicted() const { return path_.path_A_m(); }  // (AID-USBLR-1)
  void jacobian(Jacobian& h) const { path_.jacobian(h); }
  [[nodiscard]] Vector3 noise() const {
    const double share_m = sensor_.proportional_sigma * path_.path_A_m().norm();
    Vector3 sigma;
    for (std::size_t i = 0; i < 3; ++i)
      sigma(static_cast<int>(i)) =
          sigma_of(std::hypot(sensor_.sigma[i], share_m), sample_.sigma_m, sensor_.use_sample_sigma);
    return sigma;
  }

 private:
  const SensorConfig& sensor_;
  const UsblSample& sample_;
  UsblPath path_;
};

}  // namespace fathom::estimation
