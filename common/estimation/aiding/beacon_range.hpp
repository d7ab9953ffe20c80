#pragma once

#include "estimation/aiding/model.hpp"
#include "samples/range.hpp"

namespace fathom::estimation {

/// What an instrument of this kind has where its configuration says nothing.
inline void set_defaults(SensorConfig& sensor, const RangeSample* /*kind*/) {
  sensor.sigma = {1.0, 1.0, 1.0};
  sensor.robust = RobustKind::student_t;
  sensor.reacquire_s = 60.0;
}

/// Slant range to a beacon whose place is known (AID-RNG-1..3). A sphere is not flat within the uncertainty
/// of the position: the mean of its curvature is taken out, and its spread is noise.
class BeaconRange {
 public:
  using Sample = RangeSample;
  static constexpr const char* kName = "beacon_range";

  [[nodiscard]] static Usable append_rows(const AidingInput& in, const Sample& sample, Observation& out) {
    const Usable can = usable(in.sensor, sample);
    return can == Usable::yes ? append(BeaconRange(in, sample), in, out) : can;
  }
  /// A part of a position: with it alone nobody knows where the vehicle is.
  [[nodiscard]] static AidingPolicy policy(const SensorConfig& /*sensor*/, const Sample& sample) {
    AidingPolicy policy;
    policy.position = true;
    policy.reading = {sample.range_m, sample.beacon_latitude_rad, sample.beacon_longitude_rad};
    return policy;
  }

  BeaconRange(const AidingInput& in, const Sample& sample)
      : sensor_(in.sensor),
        sample_(sample),
        place_(2 * (in.beacon % kPlacedBeacons)),
        lever_N_(in.state.C_NB * geo::vec(in.sensor.lever_B_m)) {
    const SensorConfig& sensor = in.sensor;
    const bool placed = is_placed(sample);
    const geo::Geodetic& here = in.state.state.nav.position;
    const double latitude_rad = placed ? sample.beacon_latitude_rad : sensor.transceiver_latitude_rad;
    const double longitude_rad = placed ? sample.beacon_longitude_rad : sensor.transceiver_longitude_rad;
    const double depth_m = placed ? sample.beacon_depth_m : sensor.transceiver_depth_m;
    Vector3 path_N = -geo::difference_N(here, {latitude_rad, longitude_rad, here.altitude_m});
    path_N.z() =
        in.state.value(Group::surface_altitude, 0, in.surface_altitude_m) - depth_m - here.altitude_m;
    path_N += lever_N_ - Vector3(in.state.value(Group::beacon_place, place_),
                                 in.state.value(Group::beacon_place, place_ + 1), 0.0);
    range_m_ = std::max(path_N.norm(), kLeastRange_m);
    along_N_ = path_N / range_m_;
    // (AID-RNG-3): of the second order in the error of the position.
    const Matrix3 curvature = (Matrix3::Identity() - along_N_ * along_N_.transpose()) / range_m_;
    const Matrix3 spread = curvature * in.position_covariance_N_m2;
    bend_m_ = 0.5 * spread.trace();
    bend_sigma_m_ = std::sqrt(0.5 * (spread * spread).trace());
  }

  [[nodiscard]] static Usable usable(const SensorConfig& sensor, const Sample& sample) {
    if (!(sample.range_m >= 1e-3 && sample.range_m <= kMostRange_m)) return Usable::out_of_range;
    if (!is_placed(sample)) return sensor.transceiver_known ? Usable::yes : Usable::unknown_frame;
    const bool in_water = sample.beacon_depth_m > -1000.0 && sample.beacon_depth_m < 12000.0;
    const bool placed = is_on_earth(sample.beacon_latitude_rad, sample.beacon_longitude_rad);
    return placed && in_water ? Usable::yes : Usable::out_of_range;
  }
  [[nodiscard]] int dimension() const { return 1; }
  [[nodiscard]] Vector3 measured() const { return {sample_.range_m, kUnknown, kUnknown}; }
  [[nodiscard]] Vector3 predicted() const { return {range_m_ + bend_m_, kUnknown, kUnknown}; }
  void jacobian(Jacobian& h) const {
    // (AID-RNG-2)
    const Eigen::RowVector3d along = along_N_.transpose();
    h.block(Group::position, along);
    h.block(Group::attitude, Eigen::RowVector3d(along * geo::skew(lever_N_)));
    h.set(0, Group::surface_altitude, 0, -along_N_.z());
    h.set(0, Group::beacon_place, place_, along_N_.x());
    h.set(0, Group::beacon_place, place_ + 1, along_N_.y());
  }
  [[nodiscard]] Vector3 noise() const {
    const double own_m = std::hypot(sensor_.sigma[0], sensor_.proportional_sigma * sample_.range_m);
    return Vector3::Constant(
        std::hypot(sigma_of(own_m, sample_.sigma_m, sensor_.use_sample_sigma), bend_sigma_m_));
  }

 private:
  static constexpr double kLeastRange_m = 1.0;  ///< nearer, it has no direction worth its name
  static constexpr double kMostRange_m = 100e3;

  [[nodiscard]] static bool is_placed(const Sample& sample) {
    return known(sample.beacon_latitude_rad) && known(sample.beacon_longitude_rad) &&
           known(sample.beacon_depth_m);
  }

  const SensorConfig& sensor_;
  const Sample& sample_;
  int place_;  ///< of the group, the first of its states
  Vector3 lever_N_;
  Vector3 along_N_;  ///< from the beacon to the modem
  double range_m_ = 0.0;
  double bend_m_ = 0.0;
  double bend_sigma_m_ = 0.0;
};

}  // namespace fathom::estimation
