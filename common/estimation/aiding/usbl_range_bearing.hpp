#pragma once

#include "estimation/aiding/usbl_position.hpp"
#include "estimation/aiding/usbl_station.hpp"

namespace fathom::estimation {

/// Relative acoustic fix by range and direction, as the instrument measures it (AID-USBLP-1..2). The
/// direction makes two rows: the angles by which the predicted path leaves the measured one sideways and up
/// or down. They have the same noise and stay well defined straight below the transceiver, where a bearing
/// means nothing. Range, bearing and depression stand alone: without a depression the bearing is compared in
/// the horizontal, without a bearing the depression with that of the predicted path.
class UsblRangeBearing {
 public:
  using Sample = UsblSample;
  static constexpr const char* kName = "usbl_range_bearing";

  [[nodiscard]] static Usable append_rows(const AidingInput& in, const Sample& sample, Observation& out) {
    if (sample.frame == UsblFrame::geodetic || !present(sample)) return Usable::other_model;
    const Usable can = usable(in.sensor, sample);
    return can == Usable::yes
               ? append(UsblRangeBearing(in.state, in.sensor, sample, in.surface_altitude_m), in, out)
               : can;
  }
  [[nodiscard]] static AidingPolicy policy(const SensorConfig& /*sensor*/, const Sample& sample) {
    return usbl_policy({sample.range_m, sample.bearing_rad, sample.depression_rad},
                       known(sample.range_m) && known(sample.bearing_rad));
  }

  UsblRangeBearing(const AidingState& s, const SensorConfig& sensor, const UsblSample& sample,
                   double surface_altitude_m)
      : sensor_(sensor), sample_(sample), path_(s, sensor, sample, surface_altitude_m) {
    const Vector3& p = path_.path_A_m();
    const bool has_bearing = known(sample.bearing_rad);
    const bool has_depression = known(sample.depression_rad);
    const double azimuth = has_bearing ? sample.bearing_rad : std::atan2(p.y(), p.x());
    const double dip = has_depression ? sample.depression_rad : 0.0;
    const Vector3 along(std::cos(dip) * std::cos(azimuth), std::cos(dip) * std::sin(azimuth), std::sin(dip));
    const Vector3 aside(-std::sin(azimuth), std::cos(azimuth), 0.0);
    const Vector3 down(-std::sin(dip) * std::cos(azimuth), -std::sin(dip) * std::sin(azimuth), std::cos(dip));
    predicted_.x() = p.norm();
    rows_.row(0) = p.transpose() / std::max(predicted_.x(), kLeastPath_m);
    rows_.row(1) = angle(predicted_.y(), aside, along);
    rows_.row(2) = angle(predicted_.z(), down, along);
    measured_ = {sample.range_m, has_bearing ? 0.0 : kUnknown, has_depression ? 0.0 : kUnknown};
  }

  [[nodiscard]] static bool present(const UsblSample& sample) {
    return known(sample.range_m) || known(sample.bearing_rad) || known(sample.depression_rad);
  }
  [[nodiscard]] static Usable usable(const SensorConfig& sensor, const UsblSample& sample) {
    const auto beyond = [](double value, double low, double high) {
      return known(value) && !(value >= low && value <= high);
    };
    if (beyond(sample.range_m, 1e-3, kMostUsblRange_m) ||
        beyond(sample.bearing_rad, -6.2831853071795865, 6.2831853071795865) ||
        beyond(sample.depression_rad, -1.5707963267948966, 1.5707963267948966))
      return Usable::out_of_range;
    return UsblStation::usable(sensor, sample);
  }
  [[nodiscard]] int dimension() const { return 3; }
  [[nodiscard]] Vector3 measured() const { return measured_; }
  [[nodiscard]] Vector3 predicted() const { return predicted_; }
  void jacobian(Jacobian& h) const {
    // (AID-USBLP-2)
    ProjectedRows<3> rows{h, rows_};
    path_.jacobian(rows);
  }
  [[nodiscard]] Vector3 noise() const {
    const UsblNoise noise(sensor_, sample_);
    return {noise.range_m, noise.angle_rad, noise.angle_rad};
  }

 private:
  /// (AID-USBLP-1): how far the path is turned from `along` towards `across`, and its slope.
  Eigen::RowVector3d angle(double& value, const Vector3& across, const Vector3& along) const {
    const Vector3& p = path_.path_A_m();
    const double a = across.dot(p);
    const double b = along.dot(p);
    value = std::atan2(a, b);
    return (b * across - a * along).transpose() / std::max(a * a + b * b, kLeastPath_m * kLeastPath_m);
  }

  static constexpr double kLeastPath_m = 0.1;  ///< nearer, a direction has no slope worth its name

  const SensorConfig& sensor_;
  const UsblSample& sample_;
  UsblPath path_;
  Vector3 measured_;
  Vector3 predicted_;
  Matrix3 rows_;
};

}  // namespace fathom::estimation
