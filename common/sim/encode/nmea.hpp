#pragma once

#include <string>
#include <string_view>

#include "base/time.hpp"
#include "samples/actuator.hpp"
#include "samples/gps.hpp"
#include "samples/heading.hpp"
#include "samples/usbl.hpp"

namespace fathom::sim::encode {

/// `$body*hh` CR LF.
[[nodiscard]] std::string nmea_sentence(std::string_view body);

/// One epoch of a receiver: GGA, RMC, VTG, GST, all with the same time (to the millisecond). Without fix the
/// position fields are empty, quality is 0 and the status V. The altitude field is above mean sea level; an
/// unknown altitude_msl_m is sent as altitude_m with separation 0. A two-dimensional fix has no altitude.
/// NMEA has no vertical velocity and no velocity sigma.
[[nodiscard]] std::string nmea_gps(const GpsSample& sample, TimeNs utc_ns, std::string_view talker = "GP");

/// HDT for true heading, HDG for magnetic (deviation and variation where known). Unknown heading is an empty
/// field.
[[nodiscard]] std::string nmea_heading(const HeadingSample& sample, std::string_view talker = "HE");

/// PASHR for true heading, OHPR for magnetic, which cannot say the variation. Neither says roll and pitch.
/// Unknown heading is an empty field; `utc_ns` is when it was valid.
[[nodiscard]] std::string nmea_attitude(const HeadingSample& sample, TimeNs utc_ns);

/// RPM of shaft 1; unknown is sent with status V.
[[nodiscard]] std::string nmea_rpm(const PropulsionSample& sample, std::string_view talker = "II");

/// RSA for the rudder (bow to starboard positive, the opposite of FinsSample) and XDR `STERN` for the stern
/// plane, in the sign of FinsSample.
[[nodiscard]] std::string nmea_fins(const FinsSample& sample, std::string_view talker = "II");

/// $PSIMSSB: C,H for vessel axes, C,N for north-east-down, R,G for geodetic. A sample without position is
/// sent as a transponder that did not reply. `utc_ns` is when the fix was valid. A station that is known goes
/// ahead as GGA and HDT, as a topside merges them. Range and direction have no place in it.
[[nodiscard]] std::string psimssb(const UsblSample& sample, TimeNs utc_ns);

/// $PSONLLD of a geodetic fix; one without position, and of any other frame, is sent with status V. `utc_ns`
/// is when the fix was valid.
[[nodiscard]] std::string psonlld(const UsblSample& sample, TimeNs utc_ns);

}  // namespace fathom::sim::encode
