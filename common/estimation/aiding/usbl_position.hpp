#pragma once

#include "estimation/aiding/model.hpp"
#include "estimation/aiding/underwater_place.hpp"
#include "samples/usbl.hpp"

namespace fathom::estimation {

/// What an instrument of this kind has where its configuration says nothing.
inline void set_defaults(SensorConfig& sensor, const UsblSample* /*kind*/) {
  sensor.sigma = {2.0, 2.0, 2.0};
  sensor.robust = RobustKind::student_t;
  sensor.reacquire_s = 60.0;
}

/// What an acoustic measurement means that repeats `reading` when it is frozen. `complete`: it says where the
/// vehicle is horizontally; a range, a bearing or a depth alone is a part of that.
[[nodiscard]] inline AidingPolicy usbl_policy(const std::array<double, 3>& reading, bool complete) {
  AidingPolicy policy;
  policy.position = true;
  if (complete) policy.fix = Fix::acoustic;
  policy.frozen_by_path = true;
  policy.reading = reading;
  return policy;
}

/// Absolute acoustic fix of the vehicle's transponder: NED metres relative to the estimated position of the
/// IMU (AID-USBL-1..2). Where the transceiver's place is configured, its axes may be misaligned: the fix is
/// turned about that place.
class UsblPosition {
 public:
  using Sample = UsblSample;
  static constexpr const char* kName = "usbl_position";

  [[nodiscard]] static Usable append_rows(const AidingInput& in, const Sample& sample, Observation& out) {
    if (sample.frame != UsblFrame::geodetic) return Usable::other_model;
    const Usable can = usable(sample);
    return can == Usable::yes
               ? append(UsblPosition(in.state, in.sensor, sample, in.surface_altitude_m), in, out)
               : can;
  }
  [[nodiscard]] static AidingPolicy policy(const SensorConfig& /*sensor*/, const Sample& sample) {
    return usbl_policy({sample.latitude_rad, sample.longitude_rad, sample.depth_m}, true);
  }

  UsblPosition(const AidingState& s, const SensorConfig& sensor, const UsblSample& sample,
               double surface_altitude_m)
      : s_(s),
        sensor_(sensor),
        sample_(sample),
        surface_m_(s.value(Group::surface_altitude, 0, surface_altitude_m)),
        lever_N_(s.C_NB * geo::vec(sensor.lever_B_m)) {
    if (!sensor.transceiver_known) return;
    const geo::Geodetic& here = s.state.nav.position;
    from_transceiver_N_ =
        lever_N_ - geo::difference_N(here, {sensor.transceiver_latitude_rad, sensor.transceiver_longitude_rad,
                                            here.altitude_m});
    from_transceiver_N_.z() = surface_m_ - here.altitude_m + lever_N_.z() - sensor.transceiver_depth_m;
    turn_ -= geo::skew(s.value3(Group::usbl_misalignment));
  }

  [[nodiscard]] static Usable usable(const UsblSample& sample) { return usable_place(sample); }
  [[nodiscard]] int dimension() const { return 3; }
  [[nodiscard]] Vector3 measured() const { return place_N_m(s_, sample_); }
  [[nodiscard]] Vector3 predicted() const {
    const Vector3 straight{lever_N_.x() + s_.value(Group::usbl_bias, 0),
                           lever_N_.y() + s_.value(Group::usbl_bias, 1),
                           surface_m_ - s_.state.nav.position.altitude_m + lever_N_.z()};
    return straight + (turn_ - Matrix3::Identity()) * from_transceiver_N_;
  }
  void jacobian(Jacobian& h) const {
    // (AID-USBL-2)
    h.block(Group::position, turn_);
    h.block(Group::attitude, turn_ * geo::skew(lever_N_));
    h.block(Group::usbl_misalignment, -geo::skew(from_transceiver_N_));
    h.set(0, Group::usbl_bias, 0, -1.0);
    h.set(1, Group::usbl_bias, 1, -1.0);
    h.block(Group::surface_altitude, -turn_.col(2));
  }
  [[nodiscard]] Vector3 noise() const {
    const double horizontal = sigma_of(sensor_.sigma[0], sample_.sigma_m, sensor_.use_sample_sigma);
    return {horizontal, horizontal, sigma_of(sensor_.sigma[2], sample_.sigma_m, sensor_.use_sample_sigma)};
  }

  [[nodiscard]] StatedError stated(int axis) const {
    if (axis > 1) return {};
    const double sigma = stated_sigma(sensor_.sigma[static_cast<std::size_t>(axis)], sample_.sigma_m,
                                      sensor_.use_sample_sigma);
    return {sigma * sigma, Group::usbl_bias, axis};
  }

 private:
  const AidingState& s_;
  const SensorConfig& sensor_;
  const UsblSample& sample_;
  double surface_m_;
  Vector3 lever_N_;
  Vector3 from_transceiver_N_ = Vector3::Zero();  ///< of the transponder; zero where that place is unknown
  Matrix3 turn_ = Matrix3::Identity();
};

}  // namespace fathom::estimation
