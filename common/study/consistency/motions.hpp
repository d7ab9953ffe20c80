#pragma once

#include <cstdint>

#include "study/consistency/manoeuvres.hpp"

/// How the vehicles of the consistency study move. The first heading, and what of the rest is chance, is
/// drawn.
namespace fathom::study::motions {

// Submersibles: 60 s afloat at rest, two minutes on the surface, then under water.
[[nodiscard]] Manoeuvres survey_straight(std::uint64_t seed);
[[nodiscard]] Manoeuvres survey_lawn(std::uint64_t seed);
[[nodiscard]] Manoeuvres survey_yoyo(std::uint64_t seed);
/// Never at rest: under way on the surface from the beginning.
[[nodiscard]] Manoeuvres survey_under_way(std::uint64_t seed);
/// A boat in swell, always under way.
[[nodiscard]] Manoeuvres boat_in_swell(std::uint64_t seed);

// Aircraft: in the air from the beginning unless said.
[[nodiscard]] Manoeuvres flight_straight(std::uint64_t seed);
[[nodiscard]] Manoeuvres flight_circuit(std::uint64_t seed);
[[nodiscard]] Manoeuvres flight_banks(std::uint64_t seed);
/// Rolls, pitch to 60 degrees and turns of 70 degrees of bank.
[[nodiscard]] Manoeuvres flight_aerobatic(std::uint64_t seed);
/// At rest on the runway, take-off, circuit.
[[nodiscard]] Manoeuvres flight_from_runway(std::uint64_t seed);

// Cars.
[[nodiscard]] Manoeuvres drive_town(std::uint64_t seed);
[[nodiscard]] Manoeuvres drive_highway(std::uint64_t seed);
[[nodiscard]] Manoeuvres drive_mountain(std::uint64_t seed);
/// The same, with what wheels and springs do to a unit ahead of the rear axle.
[[nodiscard]] Manoeuvres roll_through_town(std::uint64_t seed);
[[nodiscard]] Manoeuvres roll_on_highway(std::uint64_t seed);
[[nodiscard]] Manoeuvres roll_in_mountains(std::uint64_t seed);
inline constexpr double kAheadOfAxle_m = 1.2;
inline constexpr double kAxleKnown_m = 1.0;  ///< sigma of where it is
inline constexpr double kWheels_m_s = 0.2;   ///< slip and bounce, root of the mean square
inline constexpr double kWheelsLast_s = 0.8;
inline constexpr double kWheelsAskew_rad = 0.035;

}  // namespace fathom::study::motions
