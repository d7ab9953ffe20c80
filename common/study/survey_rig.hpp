#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "estimation/engine_config.hpp"
#include "sim/scenario.hpp"

/// The survey vehicle, its mission and instruments, and what the filters are told about them.
namespace fathom::study {

inline constexpr double kSurveyDive_s = 300.0;
inline constexpr double kSurveyDuration_s = 3900.0;
/// Injected into the DVL of the uncalibrated cases; the filters are told only that errors of that size occur.
inline constexpr double kInjectedScale = 0.01;
inline constexpr double kInjectedYaw_rad = 0.017453292519943295;

struct SurveyCase {
  std::string_view name;
  bool navigation_grade = false;
  bool lawn = false;
  bool uncalibrated = false;
  bool usbl = false;
  double outlier_probability = 0.0;
  int beams = 4;
  bool water_track = false;
};
[[nodiscard]] std::span<const SurveyCase> survey_cases();

/// The compass deviation is the vehicle's own: it is drawn from the seed.
[[nodiscard]] sim::Scenario survey_scenario(const SurveyCase& one, std::uint64_t seed);

enum class SurveyFilter : std::uint8_t { hybrid25, full };
[[nodiscard]] estimation::EngineConfig survey_config(const SurveyCase& one, SurveyFilter filter);

}  // namespace fathom::study
