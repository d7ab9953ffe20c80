#pragma once

#include <map>
#include <vector>

#include "health/alarm_book.hpp"
#include "health/forecast_watch.hpp"
#include "health/instant.hpp"
#include "health/outage_clock.hpp"
#include "samples/gps.hpp"
#include "samples/verdict.hpp"

namespace fathom::health {

struct GpsOutageConfig {
  OutageLimits outage;
  double warning_s = 30.0;           ///< an outage this long is a warning, a shorter one a notice
  double critical_s = 3600.0;        ///< and this long it is critical
  ForecastWatchConfig forecast;      ///< by which it becomes either sooner
  bool expected = true;              ///< false: a vehicle without GPS; nothing is said about the first fix
  double first_fix_limit_s = 120.0;  ///< without any usable fix this long after the start, say so
  bool per_receiver_alarms = true;   ///< with two or more receivers, an alarm for each besides the common one
};

/// A fix that position may rest on: three-dimensional or better, at a finite place on earth.
[[nodiscard]] bool is_usable(const GpsSample& sample);

/// GPS outages per receiver and for the vehicle as a whole (no receiver gives a usable fix).
///
/// Works from the receivers alone, so it works when fusion is dead. Where fusion's verdicts are heard, a fix
/// that fusion refused breaks the run that would end an outage: it is over when fixes are there and not
/// refused. A fix with the same stamp as the one before it is no new fix.
///
/// An outage is graded by its length and by the forecast, whichever is worse; while it lasts the grade only
/// rises, and it ends by OutageClock's run of fixes: neither end flaps.
class GpsOutage {
 public:
  GpsOutage(const GpsOutageConfig& config, const Instant& start)
      : config_(config), start_(start), overall_(config.outage), forecast_(config.forecast) {}

  /// `believed` false: the fix is known to be wrong whatever it claims.
  void add(const GpsSample& sample, const Instant& now, bool believed = true);
  /// Verdicts of other sources are ignored.
  void add(const Verdict& verdict);
  void add(const Forecast& forecast, const Instant& now) { forecast_.add(forecast, now); }
  /// This receiver's fixes turn out to have been worth nothing since then, and none is until the next add():
  /// for a fix found frozen after the fact.
  void doubt(const Name& name, TimeNs since_monotonic_ns);
  void evaluate(const Instant& now);
  /// States the outage alarms: "gps_outage", "gps_outage:<receiver>", "gps_no_fix".
  void report(AlarmBook& book, const Instant& now) const;

  [[nodiscard]] const OutageClock& overall() const { return overall_; }
  /// Nothing when the receiver was never heard.
  [[nodiscard]] const OutageClock* receiver(const Name& name) const;
  /// Every receiver heard, by name.
  [[nodiscard]] std::vector<ReceiverOutage> receivers(const Instant& now) const;
  /// The vehicle's, under an empty name.
  [[nodiscard]] ReceiverOutage vehicle(const Instant& now) const {
    return describe({}, overall_, overall_severity_, now);
  }

 private:
  struct Receiver {
    OutageClock clock;
    TimeNs last_stamp_ns = 0;
    bool heard = false;
    Severity severity = Severity::notice;  ///< of the present outage
  };

  void unusable(const Name& name, Receiver& receiver);
  void grade(const OutageClock& clock, Severity& severity, const Instant& now) const;
  [[nodiscard]] static ReceiverOutage describe(const Name& name, const OutageClock& clock, Severity severity,
                                               const Instant& now);
  void report_outage(AlarmBook& book, const Instant& now, const Name& key, const OutageClock& clock,
                     Severity severity, const std::string& who) const;

  GpsOutageConfig config_;
  Instant start_;
  OutageClock overall_;
  Severity overall_severity_ = Severity::notice;
  ForecastWatch forecast_;
  Name overall_source_;  ///< the receiver that gave the last usable fix
  std::map<Name, Receiver> receivers_;
};

}  // namespace fathom::health
