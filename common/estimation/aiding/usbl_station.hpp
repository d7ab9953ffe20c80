#pragma once

#include <optional>

#include "estimation/aiding/model.hpp"
#include "samples/usbl.hpp"

namespace fathom::estimation {

inline constexpr double kMostUsblRange_m = 100e3;

/// The known end of the acoustic path: what the sample says of it, else the configured place.
struct UsblStation {
  double latitude_rad = kUnknown;
  double longitude_rad = kUnknown;
  double depth_m = kUnknown;
  Matrix3 C_NA = Matrix3::Identity();  ///< from the axes of a transceiver that it carries into N

  /// yes, or what keeps a relative fix from being placed.
  [[nodiscard]] static Usable usable(const SensorConfig& sensor, const UsblSample& sample) {
    constexpr double kRightAngle = 1.5707963267948966;
    const bool placed = known(sample.station_latitude_rad) && known(sample.station_longitude_rad);
    if (!placed && !sensor.transceiver_known) return Usable::unknown_frame;
    if (placed && !(std::abs(sample.station_latitude_rad) <= kRightAngle &&
                    std::abs(sample.station_longitude_rad) <= 4.0 * kRightAngle))
      return Usable::out_of_range;
    if (known(sample.station_depth_m) &&
        !(sample.station_depth_m > -1000.0 && sample.station_depth_m < 12000.0))
      return Usable::out_of_range;
    if (sample.frame != UsblFrame::vessel_frd) return Usable::yes;
    for (const double angle : sample.station_rpy_rad) {
      if (!known(angle)) return Usable::unknown_frame;
      if (!(std::abs(angle) <= 4.0 * kRightAngle)) return Usable::out_of_range;
    }
    return Usable::yes;
  }

  UsblStation(const SensorConfig& sensor, const UsblSample& sample)
      : latitude_rad(sensor.transceiver_latitude_rad),
        longitude_rad(sensor.transceiver_longitude_rad),
        depth_m(known(sample.station_depth_m) ? sample.station_depth_m : sensor.transceiver_depth_m) {
    if (known(sample.station_latitude_rad) && known(sample.station_longitude_rad)) {
      latitude_rad = sample.station_latitude_rad;
      longitude_rad = sample.station_longitude_rad;
    }
    if (sample.frame == UsblFrame::vehicle_frd) return;
    C_NA = geo::to_matrix(geo::from_rpy(geo::vec(sensor.mounting_rpy_rad)));
    if (sample.frame == UsblFrame::vessel_frd)
      C_NA = geo::to_matrix(geo::from_rpy(geo::vec(sample.station_rpy_rad))) * C_NA;
  }
};

/// Sigmas of range and direction of a polar fix.
struct UsblNoise {
  double range_m;
  double angle_rad;
  UsblNoise(const SensorConfig& sensor, const UsblSample& sample)
      : range_m(sigma_of(std::hypot(sensor.sigma[0], proportional(sensor, sample)), sample.sigma_m,
                         sensor.use_sample_sigma)),
        angle_rad(sigma_of(sensor.angle_sigma_rad, sample.sigma_rad, sensor.use_sample_sigma)) {}

 private:
  [[nodiscard]] static double proportional(const SensorConfig& sensor, const UsblSample& sample) {
    return known(sample.range_m) ? sensor.proportional_sigma * sample.range_m : 0.0;
  }
};

/// From the near end of the acoustic path to the far one along the axes A of the transceiver
/// (AID-USBLR-1..2): from the station to the vehicle's transponder, or from the vehicle's transceiver to the
/// station.
class UsblPath {
 public:
  UsblPath(const AidingState& s, const SensorConfig& sensor, const UsblSample& sample,
           double surface_altitude_m)
      : inverted_(sample.frame == UsblFrame::vehicle_frd), lever_N_(s.C_NB * geo::vec(sensor.lever_B_m)) {
    const UsblStation station(sensor, sample);
    const geo::Geodetic& here = s.state.nav.position;
    Vector3 from_station_N =
        -geo::difference_N(here, {station.latitude_rad, station.longitude_rad, here.altitude_m});
    from_station_N.z() =
        s.value(Group::surface_altitude, 0, surface_altitude_m) - station.depth_m - here.altitude_m;
    const Vector3 bias_N(s.value(Group::usbl_bias, 0), s.value(Group::usbl_bias, 1), 0.0);
    const Matrix3 C_NA =
        inverted_ ? Matrix3(s.C_NB * geo::to_matrix(geo::from_rpy(geo::vec(sensor.mounting_rpy_rad))))
                  : station.C_NA;
    const double sign = inverted_ ? -1.0 : 1.0;
    path_N_ = sign * (from_station_N + lever_N_) + bias_N;
    before_A_ = C_NA.transpose() * path_N_;
    turn_ = Matrix3::Identity() - geo::skew(s.value3(Group::usbl_misalignment));
    to_A_ = turn_ * C_NA.transpose();
    path_A_ = turn_ * before_A_;
  }

  [[nodiscard]] const Vector3& path_A_m() const { return path_A_; }
  /// The three rows of the path, block by block.
  template <class Rows>
  void jacobian(Rows& h) const {
    // (AID-USBLR-2)
    const Matrix3 along = inverted_ ? Matrix3(-to_A_) : to_A_;
    h.block(Group::position, along);
    // The axes turn with the vehicle in the inverted case, the lever in both.
    h.block(Group::attitude, inverted_ ? Matrix3(along * geo::skew(path_N_ + lever_N_))
                                       : Matrix3(along * geo::skew(lever_N_)));
    h.block(Group::usbl_misalignment, -geo::skew(before_A_));
    h.block(Group::usbl_bias, -to_A_.leftCols<2>());
    h.block(Group::surface_altitude, -along.col(2));
  }

 private:
  bool inverted_;
  Vector3 lever_N_;
  Vector3 path_N_;
  Vector3 before_A_;  ///< as well-aligned axes would see it
  Vector3 path_A_;
  Matrix3 turn_;
  Matrix3 to_A_;
};

/// Where a fix puts the transponder, the surface being at that altitude; nothing where the attitude of the
/// vehicle would be needed or a component is missing.
[[nodiscard]] inline std::optional<geo::Geodetic> usbl_place(const SensorConfig& sensor,
                                                             const UsblSample& sample,
                                                             double surface_altitude_m) {
  if (sample.frame == UsblFrame::geodetic) {
    if (!(std::abs(sample.latitude_rad) <= 1.5707963267948966) ||
        !(std::abs(sample.longitude_rad) <= 6.2831853071795865) || !std::isfinite(sample.depth_m))
      return std::nullopt;
    return geo::Geodetic{sample.latitude_rad, sample.longitude_rad, surface_altitude_m - sample.depth_m};
  }
  if (sample.frame == UsblFrame::vehicle_frd || UsblStation::usable(sensor, sample) != Usable::yes)
    return std::nullopt;
  Vector3 path_A = geo::vec(sample.relative_m);
  if (known(sample.range_m)) {
    const double level_m = sample.range_m * std::cos(sample.depression_rad);
    path_A = {level_m * std::cos(sample.bearing_rad), level_m * std::sin(sample.bearing_rad),
              sample.range_m * std::sin(sample.depression_rad)};
  }
  if (!(path_A.norm() <= kMostUsblRange_m)) return std::nullopt;
  const UsblStation station(sensor, sample);
  return geo::moved_by({station.latitude_rad, station.longitude_rad, surface_altitude_m - station.depth_m},
                       station.C_NA * path_A);
}

/// What `place`, that of such a fix, is wrong by per radian that the transceiver is turned about its axes
/// (AID-USBL-2, AID-USBLR-2): N metres. Zero where the place of the transceiver is unknown.
[[nodiscard]] inline Matrix3 usbl_turned_N_m(const SensorConfig& sensor, const UsblSample& sample,
                                             const geo::Geodetic& place, double surface_altitude_m) {
  const bool geodetic = sample.frame == UsblFrame::geodetic;
  if (geodetic && !sensor.transceiver_known) return Matrix3::Zero();
  UsblStation station(sensor, sample);
  if (geodetic) {
    station.latitude_rad = sensor.transceiver_latitude_rad;
    station.longitude_rad = sensor.transceiver_longitude_rad;
    station.depth_m = sensor.transceiver_depth_m;
    station.C_NA = Matrix3::Identity();
  }
  const Vector3 path_N_m = geo::difference_N(
      {station.latitude_rad, station.longitude_rad, surface_altitude_m - station.depth_m}, place);
  return geo::skew(path_N_m) * station.C_NA;
}

}  // namespace fathom::estimation
