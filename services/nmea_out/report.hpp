#pragma once

#include <array>
#include <string>

#include "config/doors/nmea_out_config.hpp"
#include "exchange/nmea/sentences.hpp"
#include "samples/nav_state.hpp"

namespace fathom::nmea_out {

/// What sentences are made of.
struct Report {
  exchange::Point point;
  exchange::nmea::Validity validity = exchange::nmea::Validity::not_valid;
  exchange::nmea::Uncertainty uncertainty;
  double forward_m_s = kUnknown;  ///< over ground, in the horizontal
  double starboard_m_s = kUnknown;
  double turn_deg_per_min = kUnknown;  ///< of the heading
  double below_m = kUnknown;           ///< water below the vehicle
};

/// Of a navigation state, at a point of the vehicle. Where the state has no position to be used (mode none or
/// aligning, not finite), there is none, no course and no sigma of it; the heading follows as soon as
/// alignment gave one. A position by satellites has quality 1, one that was reckoned 6; it is valid within
/// `valid_95_m`.
[[nodiscard]] Report report_of(const NavState& state, const config::NmeaOutConfig& config);

/// That there is nothing to report.
[[nodiscard]] Report nothing_at(TimeNs utc_ns);

[[nodiscard]] std::string sentence_of(const Report& report, config::NmeaSentence sentence,
                                      const std::string& talker);

}  // namespace fathom::nmea_out
