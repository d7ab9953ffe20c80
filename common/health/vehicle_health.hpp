#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "health/alarm_book.hpp"
#include "health/freshness.hpp"
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

/// What the monitor watches, and its limits.
struct HealthConfig {
  Name vehicle = "auv";
  double startup_s = 15.0;  ///< sensors, services and the navigation state may stay silent this long
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

/// The health of one vehicle, all that the monitor knows. The caller adds every sample, calls evaluate()
/// often, and takes out the status and the alarms. Pure: time is an argument, and durations are measured on
/// the monotonic clock. Samples of other vehicles are ignored.
class VehicleHealth {
 public:
  /// `describe` gives the names of writers in alarms.
  VehicleHealth(const HealthConfig& config, const Instant& start, DescribeWriter describe = {});

  /// Records that a sample of any sensor came, and who wrote it.
  void heard(SourceKind kind, const SampleHeader& header, const Instant& now, const WriterGuid& writer = {});
  /// These include heard().
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
  /// Takes acknowledgements, and looks at orders to navigation. Returns how many alarms were acknowledged.
  int apply(const Command& command, const Instant& now);
  /// See AlarmBook::restore(). An active alarm stays active for as long as sensors and services may stay
  /// silent after the start.
  void restore(const Alarm& alarm, const Instant& now) { book_.restore(alarm, now, config_.startup_s); }
  /// See GpsOutage::resume() and books().
  void resume(const std::vector<GpsOutageBook>& books, const Instant& now) { gps_.resume(books, now); }
  [[nodiscard]] std::vector<GpsOutageBook> books(const Instant& now) const { return gps_.books(now); }
  /// Holds or releases an alarm about the monitor itself, e.g. when it cannot write its journal.
  void set(bool active, const Condition& condition, const Instant& now) { book_.set(active, condition, now); }

  /// Brings the alarm book up to date with all watches.
  void evaluate(const Instant& now);

  /// The status as of the last evaluate(). The header has vehicle and stamps; the writer fills the rest.
  [[nodiscard]] MonitorStatus status(const Instant& now) const;
  /// See AlarmBook::take_transitions().
  [[nodiscard]] std::vector<AlarmTransition> take_transitions() { return book_.take_transitions(); }
  [[nodiscard]] const AlarmBook& alarms() const { return book_; }
  /// The 95 % radius of the last navigation state; NaN when it is unknown or missing.
  [[nodiscard]] double horizontal_95_m() const { return nav_.horizontal_95_m(); }

 private:
  /// Whether enough has arrived since the start to say how the vehicle is.
  [[nodiscard]] bool known(const Instant& now) const;
  /// Whether the sample is the water-layer half of a ping whose bottom half came before.
  bool is_second_half(const DvlSample& sample);
  [[nodiscard]] bool ours(const SampleHeader& header) const { return header.vehicle == config_.vehicle; }

  HealthConfig config_;
  Instant start_;
  Freshness fresh_;
  DescribeWriter describe_;
  AlarmBook book_;
  GpsOutage gps_;
  FixWatch fixes_;
  std::map<Name, TimeNs> pings_;  ///< stamp of the last ping on the bottom, by DVL
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
