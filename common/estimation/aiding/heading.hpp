#pragma once

#include "estimation/aiding/model.hpp"
#include "samples/heading.hpp"

namespace fathom::estimation {

/// What an instrument of this kind has where its configuration says nothing.
inline void set_defaults(SensorConfig& sensor, const HeadingSample* /*kind*/) {
  sensor.sigma = {0.0087, 0.0087, 0.0087};
  sensor.robust = RobustKind::student_t;
  sensor.reacquire_s = 30.0;
  sensor.dispute_s = 300.0;
  sensor.frozen_change = 0.1;
}

/// Heading from true north of the sample; NaN when it is magnetic and no variation is known. The variation
/// the instrument reports goes before the configured one.
[[nodiscard]] inline double true_heading(const HeadingSample& sample, double configured_variation_rad) {
  if (sample.north == North::true_north) return sample.heading_rad;
  const double variation = known(sample.variation_rad) ? sample.variation_rad : configured_variation_rad;
  return sample.heading_rad + variation;
}

/// Whether a start may take its heading from this sensor.
[[nodiscard]] inline bool heading_wanted(const AlignmentConfig& alignment, const SensorConfig& sensor) {
  if (alignment.heading_source == HeadingSource::two_antenna) return sensor.two_antenna;
  return alignment.heading_source != HeadingSource::compass || !sensor.two_antenna;
}

/// What a heading at the start may be wrong by: a compass as configured for all of them, two antennas as they
/// say themselves.
[[nodiscard]] inline double heading_sigma(const AlignmentConfig& alignment, const SensorConfig& sensor,
                                          const HeadingSample& sample) {
  return sensor.two_antenna ? sigma_of(sensor.sigma[0], sample.sigma_rad, sensor.use_sample_sigma)
                            : alignment.compass_sigma_rad;
}

/// Heading of the vehicle with the compass's deviation curve A to E (AID-HDG-1..2). The baseline between two
/// antennas has none, but a slow error: how it is mounted, and multipath.
class Heading {
 public:
  using Sample = HeadingSample;
  static constexpr const char* kName = "heading";

  [[nodiscard]] static Usable append_rows(const AidingInput& in, const Sample& sample, Observation& out) {
    const Usable can = usable(in.state, sample);
    return can == Usable::yes ? append(Heading(in.state, in.sensor, sample), in, out) : can;
  }
  [[nodiscard]] static AidingPolicy policy(const SensorConfig& /*sensor*/, const Sample& sample) {
    AidingPolicy policy;
    policy.heading_alone = true;
    policy.reading = {sample.heading_rad, 0.0, 0.0};
    return policy;
  }

  Heading(const AidingState& s, const SensorConfig& sensor, const HeadingSample& sample)
      : s_(s), sensor_(sensor), sample_(sample), rpy_(geo::to_rpy(s.state.nav.q_NB)) {}

  [[nodiscard]] static Usable usable(const AidingState& s, const HeadingSample& sample) {
    if (!(std::abs(sample.heading_rad) <= 12.6)) return Usable::out_of_range;
    if (!known(true_heading(sample, s.variation_rad))) return Usable::unknown_frame;
    // Near the vertical the heading says nothing.
    return s.C_NB.col(0).head<2>().norm() > 0.2 ? Usable::yes : Usable::out_of_range;
  }
  [[nodiscard]] int dimension() const { return 1; }
  [[nodiscard]] Vector3 measured() const {
    return {true_heading(sample_, s_.variation_rad) - sensor_.mounting_rpy_rad[2], 0.0, 0.0};
  }
  [[nodiscard]] Vector3 predicted() const {
    // (AID-HDG-1)
    const double psi = rpy_.z();
    if (sensor_.two_antenna) return {psi + s_.value(Group::antenna_bias, 0), 0.0, 0.0};
    return {psi + s_.value(Group::heading_bias, 0) + s_.value(Group::heading_deviation, 0) * std::sin(psi) +
                s_.value(Group::heading_deviation, 1) * std::cos(psi) +
                s_.value(Group::heading_deviation, 2) * std::sin(2.0 * psi) +
                s_.value(Group::heading_deviation, 3) * std::cos(2.0 * psi),
            0.0, 0.0};
  }
  void jacobian(Jacobian& h) const {
    // (AID-HDG-2)
    const double psi = rpy_.z();
    const double sine = std::sin(psi);
    const double cosine = std::cos(psi);
    const double curve = sensor_.two_antenna ? 0.0 : 1.0;
    const double slope = 1.0 + curve * (s_.value(Group::heading_deviation, 0) * cosine -
                                        s_.value(Group::heading_deviation, 1) * sine +
                                        2.0 * s_.value(Group::heading_deviation, 2) * std::cos(2.0 * psi) -
                                        2.0 * s_.value(Group::heading_deviation, 3) * std::sin(2.0 * psi));
    const double tilt = std::tan(rpy_.y());
    h.set(0, Group::attitude, 0, -slope * cosine * tilt);
    h.set(0, Group::attitude, 1, -slope * sine * tilt);
    h.set(0, Group::attitude, 2, -slope);
    if (sensor_.two_antenna) {
      h.set(0, Group::antenna_bias, 0, -1.0);
      return;
    }
    h.set(0, Group::heading_bias, 0, -1.0);
    h.set(0, Group::heading_deviation, 0, -sine);
    h.set(0, Group::heading_deviation, 1, -cosine);
    h.set(0, Group::heading_deviation, 2, -std::sin(2.0 * psi));
    h.set(0, Group::heading_deviation, 3, -std::cos(2.0 * psi));
  }
  [[nodiscard]] Vector3 noise() const {
    return {sigma_of(sensor_.sigma[0], sample_.sigma_rad, sensor_.use_sample_sigma), 0.0, 0.0};
  }
  [[nodiscard]] StatedError stated(int /*axis*/) const {
    if (!sensor_.two_antenna) return {};
    const double sigma = stated_sigma(sensor_.sigma[0], sample_.sigma_rad, sensor_.use_sample_sigma);
    return {sigma * sigma, Group::antenna_bias, 0};
  }
  [[nodiscard]] static double wrapped(double difference_rad) { return geo::wrap_pi(difference_rad); }

 private:
  const AidingState& s_;
  const SensorConfig& sensor_;
  const HeadingSample& sample_;
  Vector3 rpy_;
};

}  // namespace fathom::estimation
