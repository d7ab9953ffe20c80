#pragma once

#include <optional>

#include "codec/text/nmea_sentence.hpp"
#include "samples/heading.hpp"

namespace fathom::codec {

/// A field in degrees as heading, [0, 2 pi); kUnknown where empty.
[[nodiscard]] double read_heading(FieldReader& fields, std::size_t index);

/// HDT, HDM, HDG, THS.
[[nodiscard]] bool is_heading(const Sentence& sentence);

/// HDT and THS give true heading, HDM magnetic. HDG gives magnetic heading: the compass reading with its
/// deviation, where sent, already added; deviation and variation are reported beside it, so that
/// true = heading_rad + variation_rad. An empty field, or a THS mode other than autonomous, gives a sample
/// with unknown heading: the instrument is alive and has none.
[[nodiscard]] std::optional<RejectReason> parse_heading(const Sentence& sentence, HeadingSample& sample);

}  // namespace fathom::codec
