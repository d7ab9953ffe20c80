#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "health/alarm_book.hpp"
#include "health/gps/dispute_watch.hpp"
#include "health/gps/fix_watch.hpp"
#include "health/gps/gps_outage.hpp"
#include "health/gps/interference_watch.hpp"
#include "health/instant.hpp"
#include "health/instruments/clock_watch.hpp"
#include "health/instruments/refusal_watch.hpp"
#include "health/instruments/sensor_watch.hpp"
#include "health/instruments/stamp_watch.hpp"
#include "health/navigation/alignment_watch.hpp"
#include "health/navigation/nav_watch.hpp"
#include "health/navigation/order_watch.hpp"
#include "health/writers/intruder_watch.hpp"
#include "health/writers/service_watch.hpp"
#include "health/writers/writer_change.hpp"
#include "health/writers/writer_watch.hpp"
#include "samples/command.hpp"

namespace fathom::health {

/// What the monitor watches and when it speaks up.
struct HealthConfig {
  Name vehicle = "auv";
  double startup_s = 15.0;  ///< sensors, services and the navigation state may stay unheard of this long
  GpsOutageConfig gps;
  NavWatchConfig nav;
  AlignmentWatchConfig alignment;
  ServiceWatchConfig service;
  RefusalWatchConfig refusal;
  FixWatchConfig fixes;
  StampWatchConfig stamps;
  std::vector<ExpectedSensor> sensors;
  std::vector<ExpectedService> services;
};

/// Everything the monitor knows: feed it what is heard, evaluate it often, take status and alarms out.
/// Pure: time is an argument, durations are measured on the monotonic clock. Samples of other vehicles are
/// ignored.
class VehicleHealth {
 public:
  /// `describe` is asked for the names of writers that raise an alarm.
  VehicleHealth(const HealthConfig& config, const Instant& start, DescribeWriter describe = {});

  /// Any sensor sample: that it came, and who wrote it.
  void heard(SourceKind kind, const SampleHeader& header, const Instant& now, const WriterGuid& writer = {});
  /// heard() is included.
  void add(const GpsSample& sample, const Instant& now, const WriterGuid& writer = {});
  void add(const DvlSample& sample, const Instant& now, const WriterGuid& writer = {});
  void add(const NavState& state, const Instant& now, const WriterGuid& writer = {});
  void add(const AlignmentStatus& status, const Instant& now);
  void add(const ServiceStatus& status, const Instant& now);
  void add(const Verdict& verdict, const Instant& now);
  void add(const Forecast& forecast, const Instant& now);
  /// See IntruderWatch::strangers().
  void strangers(std::vector<std::string> present, const Instant& now) {
    intruders_.strangers(std::move(present), now);
  }
  /// Acknowledgements, and positions far from where navigation is; other orders are not for the monitor.
  /// Returns how many alarms were acknowledged.
  int apply(const Command& command, const Instant& now);
  /// See AlarmBook::restore(). What was active stays so for the time that sensors and services have to be
  /// heard.
  void restore(const Alarm& alarm, const Instant& now) { book_.restore(alarm, now, config_.startup_s); }
  /// See GpsOutage::resume() and books().
  void resume(const std::vector<GpsOutageBook>& books, const Instant& now) { gps_.resume(books, now); }
  [[nodiscard]] std::vector<GpsOutageBook> books(const Instant& now) const { return gps_.books(now); }
  /// What the monitor cannot do itself, e.g. keep its journal: an alarm while `active`.
  void set(bool active, const Condition& condition, const Instant& now) { book_.set(active, condition, now); }

  /// States of all watchers into the alarm book.
  void evaluate(const Instant& now);

  /// As of the last evaluate(). header: vehicle and stamps; the rest is the writer's.
  [[nodiscard]] MonitorStatus status(const Instant& now) const;
  [[nodiscard]] std::vector<Alarm> take_changes() { return book_.take_changes(); }
  [[nodiscard]] const AlarmBook& alarms() const { return book_; }
  /// Of the last navigation state; NaN when unknown or missing.
  [[nodiscard]] double horizontal_95_m() const { return nav_.horizontal_95_m(); }

 private:
  /// Whether enough was heard since the start to say how the vehicle is.
  [[nodiscard]] bool known(const Instant& now) const;
  /// What a ping measured of the water layer, behind what it measured of the bottom.
  bool is_second_half(const DvlSample& sample);
  [[nodiscard]] bool ours(const SampleHeader& header) const { return header.vehicle == config_.vehicle; }

  HealthConfig config_;
  Instant start_;
  DescribeWriter describe_;
  AlarmBook book_;
  GpsOutage gps_;
  FixWatch fixes_;
  std::map<Name, TimeNs> pings_;  ///< stamp of the last one on the bottom, by DVL
  InterferenceWatch interference_;
  DisputeWatch disputes_;
  StampWatch stamps_;
  WriterWatch writers_;
  WriterChange changes_;
  OrderWatch orders_;
  NavWatch nav_;
  AlignmentWatch alignment_;
  RefusalWatch refusal_;
  SensorWatch sensors_;
  ServiceWatch services_;
  IntruderWatch intruders_;
  ClockWatch clocks_;
};

}  // namespace fathom::health
