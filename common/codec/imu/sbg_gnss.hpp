#pragma once

#include <cstdint>
#include <optional>

#include "codec/codec.hpp"
#include "codec/framer.hpp"
#include "codec/satellite/fix_epochs.hpp"
#include "samples/gps.hpp"
#include "samples/heading.hpp"

namespace fathom::codec::sbg {

/// Of the status of a position: bits 0 to 5; and its kind, bits 6 to 11.
inline constexpr unsigned kSolutionComputed = 0;
inline constexpr unsigned kInsufficientObservations = 1;
enum class PositionType : std::uint8_t {
  none = 0,
  unknown = 1,
  single = 2,
  differential = 3,
  sbas = 4,
  omnistar = 5,
  rtk_float = 6,
  rtk_fixed = 7,
  ppp_float = 8,
  ppp_fixed = 9,
  told = 10,  ///< somebody has set the position
};
/// The same of a velocity.
enum class VelocityType : std::uint8_t { none = 0, unknown = 1, doppler = 2, differential = 3 };

/// GPS1_POS or GPS2_POS.
struct Position {
  std::uint32_t stamp_us = 0;
  std::uint32_t time_of_week_ms = 0;
  GpsSample sample;
};
[[nodiscard]] std::optional<RejectReason> read_position(Bytes data, Position& into);

/// GPS1_VEL or GPS2_VEL.
[[nodiscard]] std::optional<RejectReason> read_velocity(Bytes data, EpochVelocity& into);

/// With this accuracy or a larger one there is no heading (sbgEComLogGnssHdt.c of sbgECom).
inline constexpr double kNoHeading_deg = 180.0;

/// GPS1_HDT or GPS2_HDT; unknown where there is no solution.
struct Heading {
  std::uint32_t stamp_us = 0;
  std::uint32_t time_of_week_ms = 0;
  HeadingSample sample;
};
[[nodiscard]] std::optional<RejectReason> read_heading(Bytes data, Heading& into);

}  // namespace fathom::codec::sbg
