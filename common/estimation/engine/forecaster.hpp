#pragma once

#include <vector>

#include "estimation/aiding/registry.hpp"
#include "estimation/engine/motion_memory.hpp"
#include "samples/forecast.hpp"

namespace fathom::estimation {

/// Radius that holds 95 % of a two-dimensional normal distribution with these axes' sigmas; exact to 0.3 %.
[[nodiscard]] double radius_95(double larger_sigma, double smaller_sigma);
/// Likewise of the one that holds half; exact to 0.7 %.
[[nodiscard]] double radius_50(double larger_sigma, double smaller_sigma);

/// Propagates the covariance on without position fixes, along the motion as it went on when it
/// last was like now (FC-2), with the other aiding that was in use a moment ago or without it, and with what
/// is known of the motion without an instrument (FC-1). What wheels tell depends on the turns to come: for
/// them the vehicle may go on as at other times as well, and the widest of all counts (FC-3).
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

  /// A way in which the vehicle may go on, and what is known at the instant that is looked at.
  struct Course {
    explicit Course(const StateIndex& index) : filter(index) {}

    ErrorFilter filter;
    FilterState state;     ///< as it may be then
    double ahead_s = 0.0;  ///< of the present
    /// Remembered seconds from the first on and over again, turned about the vertical; none: straight ahead.
    int first = -1;
    int second = -1;              ///< the next one
    double straight_for_s = 0.0;  ///< before those
    double turned_rad = 0.0;
    double turn_of_pattern_rad = 0.0;
    MotionMemory::Second straight;
  };
  struct Reach;  ///< what 95 % and half of such vehicles would not exceed

  void begin();
  /// `first`: of the remembered seconds.
  void begin(Course& course, int first) const;
  [[nodiscard]] const MotionMemory::Second& next_second(Course& course) const;
  void step(int lost, double dt_s);
  void step(Course& course, int lost, double dt_s) const;
  /// A measurement of that instrument of a sensor, as far as it aids, at the instant that is looked at.
  void aid(Course& course, int sensor, int instrument, const Instrument& known, const AidingState& state,
           double dt_s) const;
  void constrain(Course& course, const AidingState& state, double dt_s) const;
  /// Any instrument of it does.
  [[nodiscard]] bool aids(int sensor) const;
  [[nodiscard]] bool aids(int sensor, int instrument, const Instrument& known) const;
  /// The widest of all courses.
  [[nodiscard]] Reach reach() const;
  void follow(int lost, Forecast& out, std::uint32_t first);

  const Setup* setup_;
  Past past_;
  // Of the instant of take().
  Navigator navigator_;
  Past taken_;
  int likely_ = -1;  ///< first of the remembered seconds, looked for once for each present
  // The instant that is looked at.
  std::vector<Course> courses_;
  std::size_t count_ = 1;  ///< of courses that are followed
};

}  // namespace fathom::estimation
