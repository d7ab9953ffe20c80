#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "estimation/engine_config.hpp"
#include "study/consistency/figures.hpp"
#include "study/consistency/manoeuvres.hpp"
#include "study/consistency/truth_path.hpp"

/// The cells of the consistency study: vehicle, motion, instruments, start and latitude.
namespace fathom::study {

enum class CellStart : std::uint8_t {
  at_rest,      ///< levelled at rest, heading from the compass
  gyrocompass,  ///< levelled at rest, heading from the gyros
  in_motion,    ///< course and mean specific force
  under_way,    ///< compass, GPS and mean specific force, too slow for a course
  given,        ///< a state drawn at the sigmas that go with it
};

struct Cell {
  std::string_view name;
  Manoeuvres (*motion)(std::uint64_t seed);
  CellStart start;
  const ImuGrade* inertial;
  double latitude_deg;
  double height_m;
  double duration_s;
  bool under_water = false;    ///< DVL, depth and compass; GPS until the outage
  bool on_wheels = false;      ///< and the filter is told so
  double outage_from_s = 0.0;  ///< GPS is gone from here to the end
  double forecast_at_s = 0.0;  ///< when the next minutes are forecast
  GpsFigures gps{};
  DvlFigures dvl{};
  double imu_rate_hz = 100.0;
};

[[nodiscard]] std::span<const Cell> consistency_cells();

/// What is simulated and what a user of these instruments would write for the named configuration. Nothing of
/// it depends on what was drawn.
[[nodiscard]] estimation::EngineConfig consistency_config(const Cell& cell, std::string_view configuration);
/// The state of a `given` start, its errors drawn at its sigmas; none where the vehicle finds its own.
[[nodiscard]] std::optional<estimation::InitialState> draw_given_start(const Cell& cell, const Pose& truth,
                                                                       std::uint64_t seed);
/// Height of the water's surface above the ellipsoid.
inline constexpr double kSurfaceHeight_m = 20.0;
inline constexpr CompassFigures kCompass{};
inline constexpr DepthFigures kDepthGauge{};

}  // namespace fathom::study
