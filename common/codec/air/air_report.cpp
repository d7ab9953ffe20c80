#include "codec/air/air_report.hpp"

#include <cmath>

#include "base/units.hpp"
#include "codec/air/air_data.hpp"

namespace fathom::codec {
namespace {

using Q = AirQuantity;
using U = AirUnit;

constexpr double kZeroCelsius_K = 273.15;

struct Scale {
  double factor = 1.0;
  double offset = 0.0;
};

Scale scale_of(AirUnit unit) {
  switch (unit) {
    case U::km_h:
      return {kKmh_m_s};
    case U::kn:
      return {kKnot_m_s};
    case U::mph:
      return {0.44704};
    case U::hPa:
      return {100.0};
    case U::kPa:
      return {1e3};
    case U::bar:
      return {1e5};
    case U::psi:
      return {6'894.757293168};
    case U::inHg:
      return {3'386.389};
    case U::mmHg:
      return {133.322387415};
    case U::ft:
      return {kFoot_m};
    case U::degC:
      return {1.0, kZeroCelsius_K};
    case U::degF:
      return {5.0 / 9.0, kZeroCelsius_K - 32.0 * 5.0 / 9.0};
    default:
      return {};
  }
}

struct Range {
  double low;
  double high;
};

// What air holds up to 20 km, and an aircraft in it. Suction is what a tube at rest shows around zero; more
// of it are hoses on the wrong nipples.
Range range_of(AirQuantity quantity) {
  switch (quantity) {
    case Q::indicated_airspeed:
    case Q::true_airspeed:
      return {-30.0, 350.0};
    case Q::impact_pressure:
      return {-500.0, 9e4};
    case Q::total_pressure:
      return {5e3, 2e5};
    case Q::static_pressure:
      return {5e3, 1.2e5};
    case Q::pressure_altitude:
      return {-1'500.0, 20'000.0};
    case Q::static_temperature:
    case Q::total_temperature:
      return {170.0, 345.0};
    case Q::ignored:
      break;
  }
  return {-1e300, 1e300};
}

/// How well a report tells of speed; 0 where it does not.
int rank_of(const AirReport& report) {
  if (report.has(Q::true_airspeed)) return 4;
  if (report.has(Q::impact_pressure)) return 3;
  if (report.has(Q::total_pressure)) return 2;
  return report.has(Q::indicated_airspeed) ? 1 : 0;
}

}  // namespace

bool fits(AirQuantity quantity, AirUnit unit) {
  switch (quantity) {
    case Q::indicated_airspeed:
    case Q::true_airspeed:
      return unit <= U::mph;
    case Q::impact_pressure:
    case Q::total_pressure:
    case Q::static_pressure:
      return unit >= U::Pa && unit <= U::mmHg;
    case Q::pressure_altitude:
      return unit == U::m || unit == U::ft;
    case Q::static_temperature:
    case Q::total_temperature:
      return unit >= U::degC && unit <= U::K;
    case Q::ignored:
      break;
  }
  return unit == U::none;
}

double to_si(double value, AirUnit unit) {
  const Scale scale = scale_of(unit);
  return value * scale.factor + scale.offset;
}

double from_si(double value, AirUnit unit) {
  const Scale scale = scale_of(unit);
  return (value - scale.offset) / scale.factor;
}

std::optional<RejectReason> AirReport::set(AirQuantity quantity, double si) {
  const Range range = range_of(quantity);
  if (!(si >= range.low && si <= range.high)) return RejectReason::out_of_range;
  if (quantity != Q::ignored) value_[static_cast<std::size_t>(quantity)] = si;
  return std::nullopt;
}

bool AirReport::has_speed() const {
  return rank_of(*this) > 0;
}

std::optional<RejectReason> resolve(const AirReport& report, AirspeedWanted wanted, AirspeedSample& sample) {
  sample = AirspeedSample{};
  double static_Pa = report[Q::static_pressure];
  sample.baro_altitude_m = report[Q::pressure_altitude];
  if (known(static_Pa) && !known(sample.baro_altitude_m))
    sample.baro_altitude_m = pressure_altitude_m(static_Pa);
  if (!known(static_Pa) && known(sample.baro_altitude_m))
    static_Pa = standard_pressure_Pa(sample.baro_altitude_m);

  double impact_Pa = report[Q::impact_pressure];
  if (!known(impact_Pa)) impact_Pa = report[Q::total_pressure] - static_Pa;
  if (!known(impact_Pa)) impact_Pa = impact_pressure_Pa(report[Q::indicated_airspeed]);
  sample.airspeed_m_s =
      report.has(Q::indicated_airspeed) ? report[Q::indicated_airspeed] : indicated_airspeed_m_s(impact_Pa);
  sample.true_airspeed_m_s = report[Q::true_airspeed];
  if (!known(sample.true_airspeed_m_s)) {
    const double mach = mach_number(impact_Pa, static_Pa);
    if (mach >= 1.0) return RejectReason::out_of_range;
    const double air_K = report.has(Q::static_temperature)
                             ? report[Q::static_temperature]
                             : static_temperature_K(report[Q::total_temperature], mach);
    sample.true_airspeed_m_s = mach * speed_of_sound_m_s(air_K);
  }
  if (known(sample.true_airspeed_m_s)) return std::nullopt;
  if (wanted == AirspeedWanted::indicated && known(sample.airspeed_m_s)) return std::nullopt;
  return RejectReason::incomplete;
}

bool suffices(const AirReport& report, AirspeedWanted wanted) {
  AirspeedSample sample;
  return !resolve(report, wanted, sample);
}

bool AirMemory::complete(AirReport& report) {
  const int rank = rank_of(report);
  if (rank > 0) {
    for (int& age : age_) ++age;
    ++unheard_;
  }
  for (std::size_t i = 0; i < kAirQuantities; ++i) {
    if (!known(report.value_[i])) continue;
    last_.value_[i] = report.value_[i];
    age_[i] = 0;
  }
  if (rank == 0) return false;
  if (rank < followed_ && unheard_ <= kPatience) return false;
  followed_ = rank;
  unheard_ = 0;
  for (const Q slow :
       {Q::static_pressure, Q::pressure_altitude, Q::static_temperature, Q::total_temperature}) {
    const auto i = static_cast<std::size_t>(slow);
    if (!known(report.value_[i]) && age_[i] <= kPatience) report.value_[i] = last_.value_[i];
  }
  return true;
}

}  // namespace fathom::codec
