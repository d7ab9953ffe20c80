#pragma once

#include <memory>

#include "codec/registry.hpp"

namespace fathom::codec {

/// One number a line, for echo sounders without a protocol of their own (Tritech "012.345m", Teledyne Benthos
/// "R034.56", and others).
///
/// The line is that of NumberLines with `ascii_prefix`. The number times `ascii_scale` plus `ascii_offset` is
/// metres to the bottom. A number of 0 is unknown: no echo sounder measures so near, and those that hear no
/// bottom send it.
[[nodiscard]] std::unique_ptr<Codec> make_ascii_altitude(const CodecOptions& options);

}  // namespace fathom::codec
