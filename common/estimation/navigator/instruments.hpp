#pragma once

#include <algorithm>
#include <array>
#include <optional>

#include "estimation/doubt/adaptive_noise.hpp"
#include "estimation/navigator/measurement.hpp"
#include "estimation/navigator/setup.hpp"

namespace fathom::estimation {

/// What the navigator remembers about one instrument.
struct Instrument {
  bool enabled = true;
  TimeNs stamp_ns = 0;  ///< of the last measurement, 0 before the first
  TimeNs used_ns = 0;
  TimeNs agrees_since_ns = 0;  ///< the first use since a refusal was believed, or at all; 0: none
  // Readings that repeat.
  std::array<double, 3> reading{kUnknown, kUnknown, kUnknown};
  Eigen::Vector3d first_prediction = Eigen::Vector3d::Zero();
  Eigen::Vector3d first_travelled_N_m = Eigen::Vector3d::Zero();
  bool repeats = false;  ///< the last reading was that of before, to the last bit
  /// Mean of its squared innovations over their variances, while readings change; 0 before the first.
  double normalised_square = 0.0;
  // Rejections that agree with each other.
  struct Rejections {
    TimeNs since_ns = 0;
    int count = 0;
    int accepted = 0;       ///< in between
    bool believed = false;  ///< the last of them
    std::array<double, Observation::kMaxRows> innovation{};
  };
  /// Of each row where rows are judged alone, else all of them in the first.
  std::array<Rejections, Observation::kMaxRows> rejections{};
  // Refused fixes of a position that may yet prove right: the way by the
  // velocity less that of the fixes.
  struct Candidate {
    TimeNs refused_since_ns = 0;  ///< the first refusal since the last use
    TimeNs since_ns = 0;          ///< of those that agree with each other and the motion; 0: none
    TimeNs last_ns = 0;
    int count = 0;
    geo::Geodetic origin;  ///< the estimate at the first
    Eigen::Vector2d first_N_m = Eigen::Vector2d::Zero();
    Eigen::Vector2d last_N_m = Eigen::Vector2d::Zero();
  };
  Candidate candidate;
  AdaptiveNoise noise;

  /// The reading has stood still to the last bit while `prediction` moved by more than `limit`, or the
  /// vehicle by more than `way_m`; infinite: that says nothing. Notes a new reading.
  [[nodiscard]] bool is_frozen(const std::array<double, 3>& now, const Eigen::Vector3d& prediction,
                               double limit, const Eigen::Vector3d& travelled_N_m, double way_m);
  /// A measurement was used; `now`: its squared innovation over the variance, of one component.
  void note_innovation(double now);
  /// Visits each instant that is remembered.
  template <class Self, class Visit>
  static void for_each_instant(Self& self, Visit&& visit) {
    visit(self.stamp_ns);
    visit(self.used_ns);
    visit(self.agrees_since_ns);
    for (auto& one : self.rejections) visit(one.since_ns);
    visit(self.candidate.refused_since_ns);
    visit(self.candidate.since_ns);
    visit(self.candidate.last_ns);
    AdaptiveNoise::for_each_instant(self.noise, visit);
  }
};

/// A beacon as an acoustic sample names it: by its address, or where it tells none by the place.
struct BeaconId {
  Name name;
  double latitude_rad = kUnknown;
  double longitude_rad = kUnknown;
};

/// None where the sample is of no beacon, or tells neither address nor place.
[[nodiscard]] std::optional<BeaconId> beacon_of(const EventSample& sample);

/// What one acoustic sensor measures to one of its beacons.
struct HeardBeacon {
  int sensor = -1;  ///< -1: none
  BeaconId id;      ///< the place is that of the last sample
  Instrument instrument;

  [[nodiscard]] bool is(int of_sensor, const BeaconId& other) const;
};

/// All instruments of the configuration. A ping of a DVL measures the bottom
/// and the water layer, both of one stamp: two instruments in one. An acoustic
/// one is as many as it hears beacons: an estimate that is wrong is too far
/// from one and too near to another, and refusals agree for each alone. A copy
/// costs what is in use; the rest is as constructed in every copy.
struct Instruments {
  explicit Instruments(const Setup& setup);
  Instruments(const Instruments& other) : count(other.count), layer_count(other.layer_count) { copy(other); }
  Instruments& operator=(const Instruments& other) {
    if (this != &other) copy(other);
    return *this;
  }
  ~Instruments() = default;

  std::array<Instrument, kMaxSensors> sensors{};
  std::array<Instrument, kMaxWaterLayers> water_layers{};
  std::size_t count = 0;  ///< of sensors in use: the same in all navigators of a setup
  std::size_t layer_count = 0;
  std::array<HeardBeacon, kMaxBeacons> beacons{};
  std::size_t beacon_count = 0;  ///< of those heard so far

  [[nodiscard]] bool enabled(const Measurement& measurement) const {
    return sensors[static_cast<std::size_t>(measurement.sensor)].enabled;
  }
  /// A beacon that has not been heard yet gets a place; where there is none left, that of the one that was
  /// not heard for longest.
  [[nodiscard]] Instrument& behind(const Setup& setup, const Measurement& measurement);
  /// Which of the beacons this one measures to, by when they were first heard; 0 where it is none.
  [[nodiscard]] int beacon(const Instrument& one) const;
  /// The largest factor of the noise of all that is one sensor.
  [[nodiscard]] double noise_factor(const Setup& setup, int sensor) const;
  template <class Self, class Visit>
  static void for_each(Self& self, Visit&& visit) {
    for (auto& one : self.sensors) visit(one);
    for (auto& one : self.water_layers) visit(one);
    for (auto& one : self.beacons) visit(one.instrument);
  }

 private:
  void copy(const Instruments& other) {
    std::copy_n(other.sensors.begin(), count, sensors.begin());
    std::copy_n(other.water_layers.begin(), layer_count, water_layers.begin());
    std::copy_n(other.beacons.begin(), other.beacon_count, beacons.begin());
    for (std::size_t i = other.beacon_count; i < beacon_count; ++i) beacons[i] = {};
    beacon_count = other.beacon_count;
  }
  [[nodiscard]] Instrument& behind(int sensor, const BeaconId& beacon);
};

}  // namespace fathom::estimation
