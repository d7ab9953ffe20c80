#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "estimation/engine_config.hpp"
#include "sim/scenario.hpp"
#include "study/baselines/fixed_gain_navigator.hpp"

/// The flight, its instruments and what the estimators are told about them.
namespace fathom::study {

inline constexpr double kFlight_s = 900.0;
inline constexpr double kFlightImu_hz = 20.0;
inline constexpr std::size_t kFlightCases = 9;

struct FlightCase {
  std::string_view name;
  double outage_at_s = 0.0;  ///< 0: none
  double scored_after_s = 0.0;
  double gps_late_s = 0.0;  ///< fixes are stamped and arrive this late
  bool random = false;      ///< outages of random start and length, to see how often the forecast holds
};
[[nodiscard]] std::span<const FlightCase, kFlightCases> flight_cases();

/// GPS is there all the time: outages are what the estimators are not told.
[[nodiscard]] sim::Scenario flight_scenario();

/// Outages of 5 to 60 s at random, with GPS for most of a minute between them.
[[nodiscard]] std::vector<sim::Window> draw_outages(std::uint64_t seed);

/// Where the flight begins, known as well as a first fix and a compass tell.
[[nodiscard]] estimation::InitialState draw_flight_start(std::uint64_t seed);

enum class FlightFilter : std::uint8_t { ekf15, ekf24, ekf36 };
[[nodiscard]] estimation::EngineConfig flight_config(FlightFilter filter, double gps_latency_s);
/// The same filter, that is given nothing and begins by the velocities of GPS.
[[nodiscard]] estimation::EngineConfig begun_in_flight(estimation::EngineConfig config);
[[nodiscard]] fixed_gain::Navigator::Config flight_config(fixed_gain::OutageMode mode);

}  // namespace fathom::study
