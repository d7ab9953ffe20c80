#pragma once

#include <map>
#include <utility>
#include <vector>

#include "health/alarm_book.hpp"
#include "health/instant.hpp"
#include "health/instruments/stream_watch.hpp"
#include "samples/verdict.hpp"

namespace fathom::health {

/// An expected sensor.
struct ExpectedSensor {
  Name name;
  SourceKind kind = SourceKind::imu;
  double rate_hz = 1.0;
  double missing_s = 0.0;  ///< 0: follows from the rate, see StreamLimits::from_rate
  Severity severity = Severity::warning;
};

[[nodiscard]] StreamLimits limits_of(const ExpectedSensor& sensor);
/// What a stream of unknown rate is judged by: present or not, generously.
[[nodiscard]] StreamLimits limits_of_unexpected();

/// A watch over every sensor stream of the vehicle. Unexpected sensors are listed too, without alarms.
class SensorWatch {
 public:
  static constexpr std::size_t kMaxSensors = 32;

  /// `startup_s`: how long after the start a sensor may stay silent.
  SensorWatch(const std::vector<ExpectedSensor>& expected, double startup_s, const Instant& start);

  void heard(SourceKind kind, const Name& name, const Instant& now);
  void evaluate(const Instant& now);
  /// Whether each expected sensor has been heard at least once.
  [[nodiscard]] bool all_heard() const;
  /// Alarms "sensor_missing:<name>" with the severity of the sensor, "sensor_slow:<name>" as a notice.
  void report(AlarmBook& book, const Instant& now) const;
  /// The expected sensors in the order of the configuration, then the others.
  [[nodiscard]] std::vector<WatchedItem> items(const Instant& now) const;

 private:
  struct Sensor {
    ExpectedSensor what;
    bool expected = false;
    StreamWatch stream;
  };

  double startup_s_;
  Instant start_;
  std::vector<Sensor> sensors_;
  std::map<std::pair<SourceKind, Name>, std::size_t> index_;
};

}  // namespace fathom::health
