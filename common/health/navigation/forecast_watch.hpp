#pragma once

#include "health/instant.hpp"
#include "samples/forecast.hpp"
#include "samples/status/health.hpp"

namespace fathom::health {

struct ForecastWatchConfig {
  Name limit = "horizontal_100m";  ///< of the forecast's limits, the one an outage is graded by; empty: none
  double warning_s = 60.0;         ///< an outage is a warning when this limit will be passed sooner
  double critical_s = 15.0;        ///< and critical when sooner than this
  double hold_s = 2.0;             ///< every forecast of this time has to say so
};

/// What the forecast means for a GPS outage. One forecast moves nothing: the grade of the last `hold_s`
/// counts, and its mildest. Without fusion there is no forecast, and duration alone decides.
class ForecastWatch {
 public:
  explicit ForecastWatch(const ForecastWatchConfig& config) : config_(config) {}

  void add(const Forecast& forecast, const Instant& now);

  /// Notice when no fresh forecast says worse.
  [[nodiscard]] Severity severity(const Instant& now) const;
  /// As last forecast; NaN when unknown or no longer fresh.
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
