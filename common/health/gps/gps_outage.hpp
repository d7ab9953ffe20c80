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
  double warning_s = 30.0;       ///< an outage this long is a warning, a shorter one is a notice
  double critical_s = 3600.0;    ///< an outage this long is critical
  ForecastWatchConfig forecast;  ///< the forecast that makes it a warning or critical sooner
  bool expected = true;  ///< false: a vehicle without GPS, which gets no alarm for a missing first fix
  double first_fix_limit_s = 120.0;  ///< no usable fix this long after the start is an alarm
  bool per_receiver_alarms = true;   ///< with two or more receivers each has an alarm of its own as well
  std::vector<Name> receivers;       ///< receivers that count for the vehicle; empty: every one
};

/// The outages of one receiver, or of the vehicle under an empty name; instants are UTC.
struct GpsOutageBook {
  Name receiver;
  OutageRecord record;
};

/// Whether a fix may be used for position: three-dimensional or better, at a finite place on earth, and as
/// accurate as samples/gps_quality.hpp demands.
[[nodiscard]] bool is_usable(const GpsSample& sample);

/// GPS outages per receiver and for the vehicle as a whole (no receiver gives a usable fix).
///
/// The receivers alone are enough, so it works when fusion is dead. When fusion's verdicts arrive, a fix that
/// fusion refused, or whose receiver fusion does not use, does not count: it neither prevents an outage nor
/// ends one. For the vehicle only the configured receivers count. A fix with the same stamp as the fix before
/// it is not a new fix.
///
/// A monitor that is started again goes on from its earlier books (resume()). known() is false until fixes,
/// fusion or a silence of `limit_s` have shown what holds now.
///
/// The severity of an outage follows from its length and from the forecast, whichever is worse. It only rises
/// while the outage lasts. The outage ends with OutageClock's run of fixes. So neither end flaps.
class GpsOutage {
 public:
  GpsOutage(const GpsOutageConfig& config, const Instant& start)
      : config_(config), start_(start), overall_(config.outage), forecast_(config.forecast) {}

  /// `believed` false: the fix is known to be wrong, whatever quality it claims.
  void add(const GpsSample& sample, const Instant& now, bool believed = true);
  /// Verdicts of other sources are ignored.
  void add(const Verdict& verdict);
  void add(const Forecast& forecast, const Instant& now) { forecast_.add(forecast, now); }
  /// Takes over how long fusion has been without a fix, where no fix arrived here yet.
  void add(const NavState& state, const Instant& now);
  /// Goes on from earlier books. Call it before anything is added.
  void resume(const std::vector<GpsOutageBook>& books, const Instant& now);
  /// The books for resume() in a later process: the vehicle and each receiver that ever had a fix.
  [[nodiscard]] std::vector<GpsOutageBook> books(const Instant& now) const;
  /// Whether the present state of GPS is known.
  [[nodiscard]] bool known(const Instant& now) const;
  /// Whether the last usable fix is no older than the limit, or none is expected.
  [[nodiscard]] bool good() const { return !config_.expected || (overall_.known() && !overall_.active()); }
  /// Withdraws this receiver's fixes since then, and until the next add(). A fix may be found frozen only
  /// afterwards.
  void doubt(const Name& name, TimeNs since_monotonic_ns);
  void evaluate(const Instant& now);
  /// Holds or releases the outage alarms: "gps_outage", "gps_outage:<receiver>", "gps_no_fix".
  void report(AlarmBook& book, const Instant& now) const;

  [[nodiscard]] const OutageClock& overall() const { return overall_; }
  /// Null when the receiver never sent anything.
  [[nodiscard]] const OutageClock* receiver(const Name& name) const;
  /// Every receiver that sent something, by name.
  [[nodiscard]] std::vector<ReceiverOutage> receivers(const Instant& now) const;
  /// The vehicle's outage, under an empty name.
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
