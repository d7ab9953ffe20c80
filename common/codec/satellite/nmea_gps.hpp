#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "base/time.hpp"
#include "base/unknown.hpp"
#include "codec/text/nmea_sentence.hpp"
#include "samples/gps.hpp"

namespace fathom::codec {

/// The sentences that together make one GPS sample.
enum class GpsSentence : std::uint8_t { gga = 0, gns = 1, rmc = 2, vtg = 3, gst = 4, zda = 5 };
inline constexpr std::size_t kGpsSentences = 6;

/// What one of them says. Unknown is NaN or empty.
struct GpsReport {
  GpsSentence type = GpsSentence::gga;
  std::array<char, 2> talker{};
  std::optional<DurationNs> time_of_day;
  std::optional<TimeNs> midnight;  ///< 00:00 UTC of the date it carries
  GpsFix fix = GpsFix::none;       ///< of GGA, GNS, RMC; VTG: `none` where it declares its data invalid
  double latitude_rad = kUnknown;
  double longitude_rad = kUnknown;
  double altitude_msl_m = kUnknown;
  double geoid_separation_m = kUnknown;  ///< of mean sea level above the ellipsoid
  std::int32_t satellites = -1;
  double hdop = kUnknown;
  double speed_m_s = kUnknown;
  double course_rad = kUnknown;
  std::array<double, 3> sigma_N_m{kUnknown, kUnknown, kUnknown};
};

/// Which of them a sentence is; nothing where it is none.
[[nodiscard]] std::optional<GpsSentence> gps_sentence(const Sentence& sentence);

/// Reads one. Refuses wrong field counts (sentences glued by a lost line carry valid checksums now and then),
/// malformed fields and impossible values.
[[nodiscard]] std::optional<RejectReason> parse_gps(GpsSentence type, const Sentence& sentence,
                                                    GpsReport& report);

}  // namespace fathom::codec
