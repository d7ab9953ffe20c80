#pragma once

#include "estimation/aiding/airspeed.hpp"

namespace fathom::estimation {

/// An aircraft flies nearly straight into the air: sideslip and angle of attack are their states, which are
/// small and change slowly, and a rest that is noise (AID-FLOW-1..2). Comes with each airspeed, whose wind it
/// shares; a sigma of 0 leaves the row out.
class FlowAngles {
 public:
  using Sample = AirspeedSample;
  static constexpr const char* kName = "flow_angles";
  static constexpr int kFirstComponent = 1;

  [[nodiscard]] static Usable append_rows(const AidingInput& in, const Sample& sample, Observation& out) {
    if (!has_flow_angles(in.sensor)) return Usable::not_estimated;
    const Usable can = Airspeed::usable(in.state, sample);
    if (can != Usable::yes) return can;
    out.each_alone = true;
    return append(FlowAngles(in.state, in.sensor, in.unused_s), in, out);
  }
  [[nodiscard]] static AidingPolicy policy(const SensorConfig& sensor, const Sample& sample) {
    return air_data_policy(sensor, sample);
  }

  using Vector2 = Eigen::Vector2d;

  /// `unused_s`: since the last sample that was used, unknown before the first.
  FlowAngles(const AidingState& s, const SensorConfig& sensor, double unused_s = kUnknown)
      : s_(s),
        sensor_(sensor),
        lasting_(lasting_gust(sensor, unused_s)),
        through_N_(s.velocity_through_medium_N_m_s()),
        through_B_(s.C_NB.transpose() * through_N_),
        angles_(s.value(Group::flow_angles, 0), s.value(Group::flow_angles, 1)) {}

  [[nodiscard]] int dimension() const { return 2; }
  [[nodiscard]] Vector2 measured() const {
    return {sensor_.sideslip_sigma_rad > 0.0 ? 0.0 : kUnknown,
            sensor_.attack_sigma_rad > 0.0 ? 0.0 : kUnknown};
  }
  // (AID-FLOW-1)
  [[nodiscard]] Vector2 predicted() const { return through_B_.tail<2>() - through_B_.x() * angles_; }
  void jacobian(Jacobian& h) const {
    // (AID-FLOW-2)
    Eigen::Matrix<double, 2, 3> d;
    d << -angles_(0), 1.0, 0.0, -angles_(1), 0.0, 1.0;
    const Eigen::Matrix<double, 2, 3> to_flow = d * s_.C_NB.transpose();
    h.block(Group::velocity, to_flow);
    h.block(Group::attitude, -to_flow * geo::skew(through_N_));
    h.block(Group::current, to_flow.leftCols<2>());
    h.block(Group::flow_angles, through_B_.x() * Eigen::Matrix2d::Identity());
  }
  [[nodiscard]] Vector2 noise() const {
    return lasting_ * through_N_.norm() * Vector2(sensor_.sideslip_sigma_rad, sensor_.attack_sigma_rad);
  }

 private:
  const AidingState& s_;
  const SensorConfig& sensor_;
  double lasting_;
  Vector3 through_N_;
  Vector3 through_B_;
  Vector2 angles_;
};

}  // namespace fathom::estimation
