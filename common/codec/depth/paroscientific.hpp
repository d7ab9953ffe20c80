#pragma once

#include <memory>

#include "codec/codec.hpp"
#include "codec/registry.hpp"

namespace fathom::codec {

/// Paroscientific Digiquartz: `*DDSSvalue` and `*DDSSP4=pressure,temperature`, DD the addressee (00 is the
/// host), SS the unit. The unit of the value is a setting of the instrument and must be configured
/// (pressure_unit_Pa, or value_is_depth).
///
/// The protocol has no checksum, so a line is believed only as a whole: anything before the `*`, or a second
/// one in the line, is what a lost line end leaves behind, and the line is refused. Lines to another
/// addressee and answers to other commands are good and carry no sample.
[[nodiscard]] std::unique_ptr<Codec> make_paroscientific(const CodecOptions& options);

}  // namespace fathom::codec
