#pragma once

#include "estimation/aiding/dvl_velocity.hpp"

namespace fathom::estimation {

/// Velocity along each beam that was heard, one to four of them (AID-BEAM-1..2): the vector model with all
/// its states, seen along the beam. Two beams, of which the instrument itself makes no velocity, still aid.
class DvlBeams {
 public:
  using Sample = DvlSample;
  static constexpr const char* kName = "dvl_beams";

  [[nodiscard]] static Usable append_rows(const AidingInput& in, const Sample& sample, Observation& out) {
    if (!has_beams(in.sensor, sample)) return Usable::other_model;
    const Usable can = usable(in.state, sample);
    if (can != Usable::yes) return can;
    out.each_alone = true;
    return append(DvlBeams(in.state, in.sensor, sample), in, out);
  }
  [[nodiscard]] static AidingPolicy policy(const SensorConfig& /*sensor*/, const Sample& sample) {
    return dvl_policy(sample);
  }

  using Vector4 = Eigen::Vector4d;

  DvlBeams(const AidingState& s, const SensorConfig& sensor, const DvlSample& sample)
      : velocity_(s, sensor, sample), sample_(sample) {
    const double angle = known(sample.beam_angle_rad) ? sample.beam_angle_rad : sensor.beam_angle_rad;
    for (int i = 0; i < 4; ++i) {
      const double azimuth = sensor.beam_azimuth_rad[static_cast<std::size_t>(i)];
      along_D_.row(i) << std::sin(angle) * std::cos(azimuth), std::sin(angle) * std::sin(azimuth),
          std::cos(angle);
    }
    // What a beam must have for four of them to give the horizontal velocity the sigma it is known to have.
    beam_share_ = std::sqrt(2.0) * std::sin(angle);
  }

  [[nodiscard]] static Usable usable(const AidingState& s, const DvlSample& sample) {
    if (known(sample.beam_angle_rad) && !(sample.beam_angle_rad > 0.05 && sample.beam_angle_rad < 1.4))
      return Usable::out_of_range;
    for (const double beam : sample.beam_velocity_m_s)
      if (known(beam) && !(std::abs(beam) < kMostDvlSpeed_m_s)) return Usable::out_of_range;
    if (sample.mode == DvlMode::water && !s.index.has(Group::current)) return Usable::not_estimated;
    return Usable::yes;
  }
  [[nodiscard]] int dimension() const { return 4; }
  [[nodiscard]] Vector4 measured() const { return Vector4(sample_.beam_velocity_m_s.data()); }
  [[nodiscard]] Vector4 predicted() const { return along_D_ * velocity_.predicted(); }  // (AID-BEAM-1)
  void jacobian(Jacobian& h) const {
    // (AID-BEAM-2)
    ProjectedRows<4> rows{h, along_D_};
    velocity_.jacobian(rows);
  }
  [[nodiscard]] Vector4 noise() const { return Vector4::Constant(beam_share_ * velocity_.noise().x()); }

 private:
  DvlVelocity velocity_;
  const DvlSample& sample_;
  Eigen::Matrix<double, 4, 3> along_D_;
  double beam_share_ = 0.0;
};

}  // namespace fathom::estimation
