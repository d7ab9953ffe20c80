#pragma once

#include <memory>

#include "codec/codec.hpp"
#include "codec/registry.hpp"

namespace fathom::codec {

/// One number a line, for depth sensors without a protocol of their own.
///
/// The line is `ascii_prefix`, blanks, a decimal number, then nothing, a unit, or a separator (blank, comma,
/// semicolon, `*`) and anything. The number times `ascii_scale` plus `ascii_offset` is metres of depth with
/// `value_is_depth`, else absolute pressure in pascal. Lines that begin otherwise are good and carry no
/// sample. A line that begins with `$` and ends with `*hh` must have the right NMEA checksum.
[[nodiscard]] std::unique_ptr<Codec> make_ascii_depth(const CodecOptions& options);

}  // namespace fathom::codec
