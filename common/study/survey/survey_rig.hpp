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
/// 1 sigma of what is wrong with the DVL of the uncalibrated cases, as the filters are told.
inline constexpr double kUncalibratedScale = 0.01;
inline constexpr double kUncalibratedYaw_rad = 0.017453292519943295;

/// What is wrong with an uncalibrated DVL in one run.
struct DvlFault {
  double scale = 0.0;
  double yaw_rad = 0.0;  ///< of the instrument in the body, about down
};

/// How the five minutes on the surface go. What they show of the DVL, the compass and the heading decides
/// much of the hour that follows.
enum class SurfaceLeg : std::uint8_t {
  turns,          ///< sixteen quarter turns both ways at two speeds
  same_course,    ///< straight ahead, on the course of the dive
  course_90_off,  ///< straight ahead, 90 degrees to port of it
};

struct SurveyCase {
  std::string_view name;
  SurfaceLeg surface = SurfaceLeg::turns;
  bool navigation_grade = false;
  bool lawn = false;
  bool uncalibrated = false;  ///< the errors of the DVL are drawn at 1 sigma as told
  double fault_sigma = 0.0;   ///< uncalibrated: not drawn, but this many sigma of each
  bool usbl = false;
  double outlier_probability = 0.0;
  int beams = 4;
  bool water_track = false;
  bool less_kind = false;  ///< GPS once a second with coarser velocities, accelerometers that drift more
};
[[nodiscard]] std::span<const SurveyCase> survey_cases();

/// The compass deviation is the vehicle's own: it is drawn from the seed.
[[nodiscard]] sim::Scenario survey_scenario(const SurveyCase& one, std::uint64_t seed);
/// What survey_scenario() injects; nothing where the case is not `uncalibrated`.
[[nodiscard]] DvlFault draw_dvl_fault(const SurveyCase& one, std::uint64_t seed);

enum class SurveyFilter : std::uint8_t {
  hybrid25,        ///< the published filter with the published settings
  hybrid25_equal,  ///< its 25 states with the sensor settings of `full`
  full,
};
[[nodiscard]] estimation::EngineConfig survey_config(const SurveyCase& one, SurveyFilter filter);

}  // namespace fathom::study
