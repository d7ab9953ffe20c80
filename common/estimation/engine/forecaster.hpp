#pragma once

#include "estimation/aiding/registry.hpp"
#include "estimation/engine/motion_memory.hpp"
#include "samples/forecast.hpp"

namespace fathom::estimation {

/// Radius that holds 95 % of a two-dimensional normal distribution with these axes' sigmas; exact to 0.3 %.
[[nodiscard]] double radius_95(double larger_sigma, double smaller_sigma);
/// Likewise of the one that holds half; exact to 0.7 %.
[[nodiscard]] double radius_50(double larger_sigma, double smaller_sigma);

/// Propagates the covariance on without position fixes, along the motion as it went on when it
/// last was like now (FC-2), with the other aiding that was in use a moment ago or without it
/// (FC-1).
///
/// The work is done on a copy of the present, so that another thread may do it while the navigator goes on:
/// take() by the one that steps the navigator, then what looks ahead by any one thread, until the next
/// take().
class Forecaster {
 public:
  explicit Forecaster(const Setup& setup);
  /// Remembers the last sample of a sensor: it stands for those to come.
  void remember(int sensor, const EventSample& sample);
  /// After each inertial step.
  void watch(const Navigator& navigator) { past_.motion.watch(navigator); }
  /// From here the following look ahead.
  void take(const Navigator& navigator);

  void fill(Forecast& out);
  /// `after_s` ahead, with what aids now; unknown without navigation.
  [[nodiscard]] double horizontal_95_m(double after_s);

 private:
  /// Which aiding goes on: a sensor that does not, or one of these.
  enum Lost : int { kNone = -1, kAll = -2 };

  /// Sensors, and behind them the water layers.
  static constexpr int kInstruments = kMaxSensors + kMaxWaterLayers;
  struct Past {
    MotionMemory motion;
    std::array<EventSample, kInstruments> last{};
    std::array<bool, kInstruments> remembered{};
  };

  void begin();
  const MotionMemory::Second& next_second();
  void step(int lost, double dt_s);
  /// A measurement of that instrument of a sensor, as far as it aids, at the instant that is looked at.
  void aid(int sensor, int instrument, const Instrument& known, const AidingState& state, double dt_s);
  /// Any instrument of it does.
  [[nodiscard]] bool aids(int sensor) const;
  [[nodiscard]] bool aids(int sensor, int instrument, const Instrument& known) const;
  void follow(int lost, Forecast& out, std::uint32_t first);

  const Setup* setup_;
  Past past_;
  // Of the instant of take().
  Navigator navigator_;
  Past taken_;
  // The instant that is looked at.
  ErrorFilter filter_;
  FilterState state_;     ///< as it may be then
  double ahead_s_ = 0.0;  ///< of the present
  // The motion that goes on: remembered seconds from the first on and over again, turned about the vertical.
  int first_ = -1;  ///< looked for once for each present
  int second_ = 0;
  double turned_rad_ = 0.0;
  double turn_of_pattern_rad_ = 0.0;
  MotionMemory::Second still_;  ///< where nothing is remembered yet: straight ahead
};

}  // namespace fathom::estimation
