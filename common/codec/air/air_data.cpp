#include "codec/air/air_data.hpp"

#include <cmath>

#include "base/units.hpp"

namespace fathom::codec {
namespace {

constexpr double kSeaLevel_K = 288.15;
constexpr double kSeaLevel_Pa = 101'325.0;
constexpr double kLapse_K_m = 0.0065;
constexpr double kTropopause_m = 11'000.0;
constexpr double kTropopause_K = kSeaLevel_K - kLapse_K_m * kTropopause_m;
constexpr double kGas_J_kg_K = 287.052874;  // 8314.32 J/(kmol K) over 28.964420 kg/kmol
constexpr double kHeatRatio = 1.4;
constexpr double kTroposphere = kStandardGravity_m_s2 / (kGas_J_kg_K * kLapse_K_m);
constexpr double kHeatExponent = kHeatRatio / (kHeatRatio - 1.0);  // 3.5
constexpr double kMachFactor = 0.5 * (kHeatRatio - 1.0);           // 0.2

double tropopause_Pa() {
  return kSeaLevel_Pa * std::pow(kTropopause_K / kSeaLevel_K, kTroposphere);
}

/// Impact pressure over static pressure, and back.
double pressure_ratio(double mach) {
  const double ratio = std::pow(1.0 + kMachFactor * mach * mach, kHeatExponent) - 1.0;
  return std::copysign(ratio, mach);
}
double mach_of_ratio(double ratio) {
  const double mach = std::sqrt((std::pow(1.0 + std::abs(ratio), 1.0 / kHeatExponent) - 1.0) / kMachFactor);
  return std::copysign(mach, ratio);
}

}  // namespace

double standard_temperature_K(double altitude_m) {
  return altitude_m < kTropopause_m ? kSeaLevel_K - kLapse_K_m * altitude_m : kTropopause_K;
}

double standard_pressure_Pa(double altitude_m) {
  if (altitude_m < kTropopause_m)
    return kSeaLevel_Pa * std::pow(standard_temperature_K(altitude_m) / kSeaLevel_K, kTroposphere);
  const double above_m = altitude_m - kTropopause_m;
  return tropopause_Pa() * std::exp(-kStandardGravity_m_s2 * above_m / (kGas_J_kg_K * kTropopause_K));
}

double pressure_altitude_m(double static_Pa) {
  if (static_Pa > tropopause_Pa())
    return kSeaLevel_K / kLapse_K_m * (1.0 - std::pow(static_Pa / kSeaLevel_Pa, 1.0 / kTroposphere));
  return kTropopause_m +
         kGas_J_kg_K * kTropopause_K / kStandardGravity_m_s2 * std::log(tropopause_Pa() / static_Pa);
}

double indicated_airspeed_m_s(double impact_Pa) {
  return speed_of_sound_m_s(kSeaLevel_K) * mach_of_ratio(impact_Pa / kSeaLevel_Pa);
}

double impact_pressure_Pa(double indicated_m_s) {
  return kSeaLevel_Pa * pressure_ratio(indicated_m_s / speed_of_sound_m_s(kSeaLevel_K));
}

double mach_number(double impact_Pa, double static_Pa) {
  return mach_of_ratio(impact_Pa / static_Pa);
}

double static_temperature_K(double total_K, double mach) {
  return total_K / (1.0 + kMachFactor * mach * mach);
}

double speed_of_sound_m_s(double static_K) {
  return std::sqrt(kHeatRatio * kGas_J_kg_K * static_K);
}

double impact_pressure_at_Pa(double true_m_s, double static_Pa, double static_K) {
  return static_Pa * pressure_ratio(true_m_s / speed_of_sound_m_s(static_K));
}

}  // namespace fathom::codec
