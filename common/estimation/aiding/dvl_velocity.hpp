#pragma once

#include "estimation/aiding/model.hpp"
#include "samples/dvl.hpp"

namespace fathom::estimation {

/// A component that is greater is none that a DVL can measure.
inline constexpr double kMostDvlSpeed_m_s = 50.0;

/// A live DVL does not repeat three components, each with its noise, to the last bit on a way that is longer.
/// On a shorter one it may: a driver repeats the last ping until the next one.
inline constexpr double kDvlFrozenPath_m = 5.0;

/// What an instrument of this kind has where its configuration says nothing.
inline void set_defaults(SensorConfig& sensor, const DvlSample* /*kind*/) {
  sensor.sigma = {0.01, 0.01, 0.01};
  sensor.proportional_sigma = 0.002;
  sensor.robust = RobustKind::student_t;
  sensor.reacquire_s = 5.0;
  sensor.frozen_change = 0.1;
}

/// What a measurement of a DVL means, by vector or by beams.
[[nodiscard]] inline AidingPolicy dvl_policy(const DvlSample& sample) {
  AidingPolicy policy;
  policy.velocity = sample.mode == DvlMode::water ? VelocityOver::medium : VelocityOver::ground;
  policy.doppler = policy.shows_level = true;
  policy.frozen_path_m = kDvlFrozenPath_m;
  const auto& v = sample.velocity_D_m_s;
  const auto& beams = sample.beam_velocity_m_s;
  const bool vector = known(v[0]) || known(v[1]) || known(v[2]);
  if (vector) {
    policy.reading = v;
  } else {
    policy.reading = {beams[0], beams[1], known(beams[2]) ? beams[2] : beams[3]};
  }
  return policy;
}

/// Beams are to be used, and there are some.
[[nodiscard]] inline bool has_beams(const SensorConfig& sensor, const DvlSample& sample) {
  bool any = false;
  for (const double beam : sample.beam_velocity_m_s) any = any || known(beam);
  return sensor.use_beams && any;
}

/// Velocity relative to the bottom, or to the water where the current is estimated, along the DVL's own axes
/// D. Product form: scale and misalignment multiply (AID-DVL-1..2). Each component stands alone: the ones the
/// instrument declared bad are left out.
class DvlVelocity {
 public:
  using Sample = DvlSample;
  static constexpr const char* kName = "dvl_velocity";

  [[nodiscard]] static Usable append_rows(const AidingInput& in, const Sample& sample, Observation& out) {
    if (has_beams(in.sensor, sample)) return Usable::other_model;
    const Usable can = usable(in.state, sample);
    return can == Usable::yes ? append(DvlVelocity(in.state, in.sensor, sample), in, out) : can;
  }
  [[nodiscard]] static AidingPolicy policy(const SensorConfig& /*sensor*/, const Sample& sample) {
    return dvl_policy(sample);
  }

  DvlVelocity(const AidingState& s, const SensorConfig& sensor, const DvlSample& sample)
      : s_(s),
        sensor_(sensor),
        sample_(sample),
        C_DB_(geo::to_matrix(geo::from_rpy(geo::vec(sensor.mounting_rpy_rad))).transpose()),
        lever_B_(geo::vec(sensor.lever_B_m)) {
    const Vector3 through_N =
        sample.mode == DvlMode::water ? s.velocity_through_medium_N_m_s() : s.state.nav.v_N_m_s;
    v_B_ = s.C_NB.transpose() * through_N + geo::cross(s.rate_nb_B_rad_s, lever_B_);
    scale_ = Vector3::Constant(1.0 + s.value(Group::dvl_scale, 0)) + s.value3(Group::dvl_scale_xyz);
    turn_ = Matrix3::Identity() - geo::skew(s.value3(Group::dvl_misalignment));
    through_N_ = through_N;
  }

  [[nodiscard]] static Usable usable(const AidingState& s, const DvlSample& sample) {
    bool any = false;
    for (const double v : sample.velocity_D_m_s) {
      if (known(v) && !(std::abs(v) < kMostDvlSpeed_m_s)) return Usable::out_of_range;
      any = any || known(v);
    }
    if (!any) return Usable::out_of_range;
    if (sample.mode == DvlMode::water && !s.index.has(Group::current)) return Usable::not_estimated;
    return Usable::yes;
  }
  [[nodiscard]] int dimension() const { return 3; }
  [[nodiscard]] Vector3 measured() const { return geo::vec(sample_.velocity_D_m_s); }
  [[nodiscard]] Vector3 predicted() const {
    // (AID-DVL-1)
    return scale_.cwiseProduct(turn_ * (C_DB_ * v_B_)) + s_.value3(Group::dvl_bias);
  }
  /// `h` takes the three rows block by block: the rows of H, or what projects them (dvl_beams.hpp).
  template <class Rows>
  void jacobian(Rows& h) const {
    // (AID-DVL-2)
    const Vector3 v_D = C_DB_ * v_B_;
    const Matrix3 d = scale_.asDiagonal() * turn_ * C_DB_;
    const Matrix3 to_D = d * s_.C_NB.transpose();
    h.block(Group::velocity, to_D);
    h.block(Group::attitude, -to_D * geo::skew(through_N_));
    h.block(Group::gyro_bias, -d * geo::skew(lever_B_));
    const Vector3 turned = turn_ * v_D;
    h.block(Group::dvl_scale, -turned);
    h.block(Group::dvl_scale_xyz, Matrix3((-turned).asDiagonal()));
    h.block(Group::dvl_misalignment, -(scale_.asDiagonal() * geo::skew(v_D)));
    h.block(Group::dvl_bias, -Matrix3::Identity());
    if (sample_.mode == DvlMode::water) h.block(Group::current, to_D.leftCols<2>());
  }
  [[nodiscard]] Vector3 noise() const {
    const double extra = sensor_.proportional_sigma * v_B_.norm();
    Vector3 sigma;
    for (std::size_t i = 0; i < 3; ++i)
      sigma(static_cast<int>(i)) =
          sigma_of(std::hypot(sensor_.sigma[i], extra), sample_.sigma_m_s, sensor_.use_sample_sigma);
    return sigma;
  }

 private:
  const AidingState& s_;
  const SensorConfig& sensor_;
  const DvlSample& sample_;
  Matrix3 C_DB_;
  Vector3 lever_B_;
  Vector3 through_N_;
  Vector3 v_B_;
  Vector3 scale_;
  Matrix3 turn_;
};

}  // namespace fathom::estimation
