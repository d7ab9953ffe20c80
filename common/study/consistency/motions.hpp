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

}  // namespace fathom::study::motions
