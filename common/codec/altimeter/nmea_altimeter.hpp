#pragma once

#include <optional>

#include "codec/text/nmea_sentence.hpp"
#include "samples/altimeter.hpp"

namespace fathom::codec {

/// DPT and DBT.
[[nodiscard]] bool is_altimeter(const Sentence& sentence);

/// DPT: metres below the transducer, the transducer's offset, and from version 3 of the standard on the
/// largest range in use. DBT: depth below the transducer in feet, metres and fathoms, of which the metres are
/// taken. The offset is reported beside the depth and not added to it. An empty field gives a sample with
/// unknown altitude: the instrument is alive and hears no bottom.
[[nodiscard]] std::optional<RejectReason> parse_altimeter(const Sentence& sentence, AltimeterSample& sample);

}  // namespace fathom::codec
