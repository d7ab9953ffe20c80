#pragma once

#include <deque>
#include <map>
#include <vector>

#include "health/alarm_book.hpp"
#include "health/gps/outage_clock.hpp"
#include "health/instant.hpp"
#include "health/navigation/forecast_watch.hpp"
#include "samples/gps.hpp"
#include "samples/nav_state.hpp"
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
  std::vector<Name> receivers;       ///< those that count for the vehicle; empty: every one
};

/// The outages of one receiver, or of the vehicle under an empty name; instants are UTC.
struct GpsOutageBook {
  Name receiver;
  OutageRecord record;
};

/// A fix that position may rest on: three-dimensional or better, at a finite place on earth, accurate as
/// samples/gps_quality.hpp asks for.
[[nodiscard]] bool is_usable(const GpsSample& sample);

/// GPS outages per receiver and for the vehicle as a whole (no receiver gives a usable fix).
///
/// Works from the receivers alone, so it works when fusion is dead. Where fusion's verdicts are heard, a fix
/// that fusion refused, or whose receiver it does not listen to, was none: it neither keeps an outage from
/// beginning nor ends one. For the vehicle only the configured receivers count. A fix with the same stamp as
/// the one before it is no new fix.
///
/// A monitor that is started again goes on from its books of before (resume()); until fixes, fusion or a
/// silence of `limit_s` have told what holds now, known() is false.
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
  /// How long fusion has been without a fix: counts where nothing was heard here yet.
  void add(const NavState& state, const Instant& now);
  /// To be called before anything is heard.
  void resume(const std::vector<GpsOutageBook>& books, const Instant& now);
  /// What resume() of a later process goes on from: the vehicle and each receiver that ever had a fix.
  [[nodiscard]] std::vector<GpsOutageBook> books(const Instant& now) const;
  /// Whether there is anything to be said about GPS now.
  [[nodiscard]] bool known(const Instant& now) const;
  /// A usable fix not longer ago than the limit, or none expected.
  [[nodiscard]] bool good() const { return !config_.expected || (overall_.known() && !overall_.active()); }
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
  /// A fix that fusion has not judged yet.
  struct Unjudged {
    TimeNs stamp_ns = 0;
    TimeNs monotonic_ns = 0;
  };
  struct Receiver {
    OutageClock clock;
    std::deque<Unjudged> unjudged{};
    TimeNs taken_ns = 0;    ///< monotonic, of the last fix that fusion took, or did not refuse
    bool refusing = false;  ///< fusion refused the last one that it judged
    TimeNs last_stamp_ns = 0;
    bool heard = false;
    Severity severity = Severity::notice;  ///< of the present outage
  };

  void unusable(const Name& name, Receiver& receiver);
  [[nodiscard]] bool counts(const Name& receiver) const;
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
  bool fusion_heard_ = false;
  Name overall_source_;  ///< the receiver that gave the last usable fix
  std::map<Name, Receiver> receivers_;
};

}  // namespace fathom::health
