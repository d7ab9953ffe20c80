#pragma once

#include "health/instant.hpp"
#include "samples/forecast.hpp"
#include "samples/status/health.hpp"

namespace fathom::health {

struct ForecastWatchConfig {
  Name limit = "horizontal_100m";  ///< the limit of the forecast that grades an outage; empty: none
  double warning_s = 60.0;         ///< an outage is a warning when the limit will be passed in less than this
  double critical_s = 15.0;        ///< an outage is critical when the limit will be passed in less than this
  double hold_s = 2.0;             ///< every forecast of this time has to agree
};

/// The grade that the forecast gives a GPS outage. It is the mildest grade of all forecasts of the last
/// `hold_s`, so that a single forecast changes nothing. Without fusion there is no forecast, and the duration
/// alone decides.
class ForecastWatch {
 public:
  explicit ForecastWatch(const ForecastWatchConfig& config) : config_(config) {}

  void add(const Forecast& forecast, const Instant& now);

  /// The grade: a notice, unless fresh forecasts say worse.
  [[nodiscard]] Severity severity(const Instant& now) const;
  /// The time in the last forecast; NaN when it is unknown or no longer fresh.
  [[nodiscard]] double time_to_limit_s(const Instant& now) const;
  [[nodiscard]] const Name& limit() const { return config_.limit; }

 private:
  [[nodiscard]] bool fresh(const Instant& now) const;

  ForecastWatchConfig config_;
  bool heard_ = false;
  TimeNs heard_ns_ = 0;
  double time_to_limit_s_ = kUnknown;
  bool below_warning_ = false;
  bool below_critical_ = false;
  TimeNs warning_since_ns_ = 0;
  TimeNs critical_since_ns_ = 0;
};

}  // namespace fathom::health
