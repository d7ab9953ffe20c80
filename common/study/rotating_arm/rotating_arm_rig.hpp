#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "estimation/engine_config.hpp"
#include "geo/wgs84.hpp"
#include "sim/scenario.hpp"

/// The rotating arm, its instruments and what the filters are told about them.
namespace fathom::study {

inline constexpr double kArmRest_s = 10.0;
inline constexpr double kArmDuration_s = 610.0;
inline constexpr std::size_t kArmCases = 14;

struct ArmCase {
  std::string_view name;
  double speed_m_s = 1.5;
  double dvl_hz = 5.0;
  int imu_every = 1;  ///< of 100 Hz
  double outlier_probability = 0.0;
  double dropout_s = 0.0;
};
[[nodiscard]] std::span<const ArmCase, kArmCases> arm_cases();

enum class Instruments : std::uint8_t { real, perfect };
[[nodiscard]] sim::Scenario arm_scenario(const ArmCase& one, Instruments instruments);

/// What is known of the start: the axle is surveyed, the arm's azimuth read to half a degree. Default: the
/// truth.
struct ArmStart {
  ArmStart();
  geo::Geodetic position;
  double heading_rad;
};
[[nodiscard]] ArmStart draw_start(std::uint64_t seed);

enum class ArmFilter : std::uint8_t {
  imu_only,
  hybrid25,        ///< the published filter with the published settings
  hybrid25_equal,  ///< its 25 states with the sensor settings of `full`: what the states alone are worth
  full,
  bound,  ///< full, with the statistics of the instruments as they are drawn, and nothing else
};
[[nodiscard]] estimation::EngineConfig arm_config(const ArmCase& one, ArmFilter filter,
                                                  const ArmStart& start);

}  // namespace fathom::study
