#pragma once

#include <limits>

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

/// Higher, or deeper, is no place of a vehicle.
inline constexpr double kMostAltitude_m = 5e4;
/// An unknown height is none that is impossible.
[[nodiscard]] inline bool is_possible_height(double altitude_m) {
  return !known(altitude_m) || std::abs(altitude_m) < kMostAltitude_m;
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

/// What is white in the error of a fix, and how much of the state of its slow error is in it (AID-GPSP-3).
struct GpsNoise {
  double sigma_m = 0.0;
  double slow_share = 1.0;
  double stated_m2 = 0.0;  ///< of both, where the receiver states it
};

/// `bias_sigma_m`: of the slow error along this axis, 0 where there is no such state. A total that the
/// receiver states holds both; so does what a fix of its kind is good for. A slow error is never more than
/// nine tenths of it in variance.
[[nodiscard]] inline GpsNoise gps_noise(const SensorConfig& sensor, const GpsSample& sample, std::size_t axis,
                                        double bias_sigma_m) {
  constexpr double kMostSlow = 0.9;
  constexpr double kRtkFixed_m = 0.03;
  constexpr double kRtkFloat_m = 0.5;
  const double stated = sample.position_sigma_N_m[axis];
  const bool told = known(stated) && (sensor.use_sample_sigma || !is_accurate(sample));
  const double sigma = sigma_of(sensor.sigma[axis], stated, told);
  if (bias_sigma_m <= 0.0 || !sensor.use_sample_sigma) return {sigma, 1.0};
  double total = std::numeric_limits<double>::infinity();
  if (told) total = stated;
  if (sample.fix == GpsFix::rtk_fixed) total = std::min(total, kRtkFixed_m);
  if (sample.fix == GpsFix::rtk_float) total = std::min(total, kRtkFloat_m);
  GpsNoise out{sigma, std::min(1.0, std::sqrt(kMostSlow) * total / bias_sigma_m)};
  const double slow = out.slow_share * bias_sigma_m;
  if (told) {
    out.sigma_m = std::max(sensor.sigma[axis], std::sqrt(std::max(0.0, stated * stated - slow * slow)));
    out.stated_m2 = total * total;
  }
  return out;
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
    return can == Usable::yes
               ? append(GpsPosition(in.state, in.sensor, sample, in.gps_bias_sigma_N_m), in, out)
               : can;
  }
  [[nodiscard]] static AidingPolicy policy(const SensorConfig& /*sensor*/, const Sample& sample) {
    AidingPolicy policy;
    policy.position = policy.follows_motion = true;
    // A fix of kilometres has its weight in the filter, but nobody navigates by it.
    if (is_accurate(sample)) policy.fix = Fix::satellite;
    policy.velocity = VelocityOver::ground;  // one fix after the other
    policy.frozen_by_path = true;
    policy.reading = gps_reading(sample);
    return policy;
  }

  GpsPosition(const AidingState& s, const SensorConfig& sensor, const GpsSample& sample,
              const std::array<double, 3>& bias_sigma_N_m = {})
      : s_(s),
        sample_(sample),
        lever_B_(geo::vec(sensor.lever_B_m) + s.value3(Group::gps_lever)),
        lever_N_(s.C_NB * lever_B_),
        swing_N_(s.C_NB * geo::cross(s.rate_nb_B_rad_s, lever_B_)),
        latency_s_(s.value(Group::gps_latency, 0)) {
    for (std::size_t i = 0; i < 3; ++i) noise_[i] = gps_noise(sensor, sample, i, bias_sigma_N_m[i]);
    slow_share_ = {noise_[0].slow_share, noise_[1].slow_share, noise_[2].slow_share};
  }

  [[nodiscard]] static Usable usable(const SensorConfig& sensor, const GpsSample& sample) {
    if (const Usable fix = usable_fix(sensor, sample); fix != Usable::yes) return fix;
    const bool placed = is_on_earth(sample.latitude_rad, sample.longitude_rad);
    return placed && is_possible_height(sample.altitude_m) ? Usable::yes : Usable::out_of_range;
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
    return lever_N_ + slow_share_.cwiseProduct(s_.value3(Group::gps_position_bias)) -
           latency_s_ * (s_.state.nav.v_N_m_s + swing_N_);
  }
  void jacobian(Jacobian& h) const {
    // (AID-GPSP-2)
    h.block(Group::position, Matrix3::Identity());
    h.block(Group::velocity, -latency_s_ * Matrix3::Identity());
    h.block(Group::attitude, geo::skew(lever_N_ - latency_s_ * swing_N_));
    h.block(Group::gyro_bias, latency_s_ * s_.C_NB * geo::skew(lever_B_));
    h.block(Group::gps_position_bias, Matrix3((-slow_share_).asDiagonal()));
    h.block(Group::gps_latency, s_.state.nav.v_N_m_s + swing_N_);
    h.block(Group::gps_lever, s_.C_NB * (latency_s_ * geo::skew(s_.rate_nb_B_rad_s) - Matrix3::Identity()));
  }
  [[nodiscard]] Vector3 noise() const { return {noise_[0].sigma_m, noise_[1].sigma_m, noise_[2].sigma_m}; }
  [[nodiscard]] StatedError stated(int axis) const {
    return {noise_[static_cast<std::size_t>(axis)].stated_m2, Group::gps_position_bias, axis};
  }

 private:
  const AidingState& s_;
  const GpsSample& sample_;
  std::array<GpsNoise, 3> noise_;
  Vector3 slow_share_;
  Vector3 lever_B_;
  Vector3 lever_N_;
  Vector3 swing_N_;
  double latency_s_;
};

}  // namespace fathom::estimation
