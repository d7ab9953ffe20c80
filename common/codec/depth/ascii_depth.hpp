#pragma once

#include <memory>

#include "codec/codec.hpp"
#include "codec/registry.hpp"

namespace fathom::codec {

/// One number a line, for depth sensors without a protocol of their own.
///
/// The line is that of NumberLines with `ascii_prefix`. The number times `ascii_scale` plus `ascii_offset` is
/// metres of depth with `value_is_depth`, else absolute pressure in pascal.
[[nodiscard]] std::unique_ptr<Codec> make_ascii_depth(const CodecOptions& options);

}  // namespace fathom::codec
