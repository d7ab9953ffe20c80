#pragma once

#include "estimation/aiding/model.hpp"
#include "samples/gps.hpp"
#include "samples/gps_quality.hpp"

namespace fathom::estimation {

/// What an instrument of this kind has where its configuration says nothing.
inline void set_defaults(SensorConfig& sensor, const GpsSample* /*kind*/) {
  sensor.sigma = {1.5, 1.5, 3.0};
  sensor.reacquire_s = 21.0;
  sensor.frozen_change = 2.0;
}

/// Whether the receiver has a fix of the quality that is asked for, and one that it does not disown itself.
[[nodiscard]] inline Usable usable_fix(const SensorConfig& sensor, const GpsSample& sample) {
  if (static_cast<std::uint8_t>(sample.fix) < sensor.min_fix) return Usable::no_fix;
  const bool disowned = sensor.refuse_spoofed && sample.spoofing == GpsSpoofing::affirmed;
  return disowned ? Usable::out_of_range : Usable::yes;
}
[[nodiscard]] inline bool is_fixed(const SensorConfig& sensor, const GpsSample& sample) {
  return usable_fix(sensor, sample) == Usable::yes;
}

/// What a frozen receiver repeats.
[[nodiscard]] inline std::array<double, 3> gps_reading(const GpsSample& sample) {
  return {sample.latitude_rad, sample.longitude_rad, sample.altitude_m};
}

/// Position of the GPS antenna, NED metres relative to the estimated position of the IMU (AID-GPSP-1..2). The
/// latency state is what remains of the fix's age after the configured latency.
class GpsPosition {
 public:
  using Sample = GpsSample;
  static constexpr const char* kName = "gps_position";

  [[nodiscard]] static Usable append_rows(const AidingInput& in, const Sample& sample, Observation& out) {
    if (!in.sensor.use_position) return Usable::not_estimated;
    const Usable can = usable(in.sensor, sample);
    return can == Usable::yes ? append(GpsPosition(in.state, in.sensor, sample), in, out) : can;
  }
  [[nodiscard]] static AidingPolicy policy(const SensorConfig& /*sensor*/, const Sample& sample) {
    AidingPolicy policy;
    policy.position = policy.follows_motion = true;
    // A fix of kilometres has its weight in the filter, but nobody navigates by it.
    if (is_accurate(sample)) policy.fix = Fix::satellite;
    policy.velocity = VelocityOver::ground;  // one fix after the other
    policy.along_vehicle = false;
    policy.frozen_by_path = true;
    policy.reading = gps_reading(sample);
    return policy;
  }

  GpsPosition(const AidingState& s, const SensorConfig& sensor, const GpsSample& sample)
      : s_(s),
        sensor_(sensor),
        sample_(sample),
        lever_B_(geo::vec(sensor.lever_B_m) + s.value3(Group::gps_lever)),
        lever_N_(s.C_NB * lever_B_),
        swing_N_(s.C_NB * geo::cross(s.rate_nb_B_rad_s, lever_B_)),
        latency_s_(s.value(Group::gps_latency, 0)) {}

  [[nodiscard]] static Usable usable(const SensorConfig& sensor, const GpsSample& sample) {
    if (const Usable fix = usable_fix(sensor, sample); fix != Usable::yes) return fix;
    const bool placed = is_on_earth(sample.latitude_rad, sample.longitude_rad);
    const bool high = !known(sample.altitude_m) || std::abs(sample.altitude_m) < 5e4;
    return placed && high ? Usable::yes : Usable::out_of_range;
  }
  [[nodiscard]] int dimension() const { return 3; }
  [[nodiscard]] Vector3 measured() const {
    const geo::Geodetic& here = s_.state.nav.position;
    const bool has_altitude = known(sample_.altitude_m);
    Vector3 m = geo::difference_N(here, {sample_.latitude_rad, sample_.longitude_rad,
                                         has_altitude ? sample_.altitude_m : here.altitude_m});
    if (!has_altitude) m.z() = kUnknown;
    return m;
  }
  [[nodiscard]] Vector3 predicted() const {
    return lever_N_ + s_.value3(Group::gps_position_bias) - latency_s_ * (s_.state.nav.v_N_m_s + swing_N_);
  }
  void jacobian(Jacobian& h) const {
    // (AID-GPSP-2)
    h.block(Group::position, Matrix3::Identity());
    h.block(Group::velocity, -latency_s_ * Matrix3::Identity());
    h.block(Group::attitude, geo::skew(lever_N_ - latency_s_ * swing_N_));
    h.block(Group::gyro_bias, latency_s_ * s_.C_NB * geo::skew(lever_B_));
    h.block(Group::gps_position_bias, -Matrix3::Identity());
    h.block(Group::gps_latency, s_.state.nav.v_N_m_s + swing_N_);
    h.block(Group::gps_lever, s_.C_NB * (latency_s_ * geo::skew(s_.rate_nb_B_rad_s) - Matrix3::Identity()));
  }
  [[nodiscard]] Vector3 noise() const {
    Vector3 sigma;
    for (std::size_t i = 0; i < 3; ++i)
      sigma(static_cast<int>(i)) = sigma_of(sensor_.sigma[i], sample_.position_sigma_N_m[i],
                                            sensor_.use_sample_sigma || !is_accurate(sample_));
    return sigma;
  }

 private:
  const AidingState& s_;
  const SensorConfig& sensor_;
  const GpsSample& sample_;
  Vector3 lever_B_;
  Vector3 lever_N_;
  Vector3 swing_N_;
  double latency_s_;
};

}  // namespace fathom::estimation
