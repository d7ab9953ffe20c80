#pragma once

#include <string>

#include "codec/registry.hpp"
#include "samples/depth.hpp"

namespace fathom::sim::encode {

/// `*0001value` CR LF, with a known temperature `*0001P4=value,temperature`; the options are those that the
/// codec is given. The pressure is the sample's own where known, else computed from its depth. An unknown
/// depth sends nothing, like the instrument.
[[nodiscard]] std::string paroscientific(const DepthSample& sample, const codec::CodecOptions& options);

/// Prefix, number, CR LF, as the ascii_depth codec with the same options reads it.
[[nodiscard]] std::string ascii_depth(const DepthSample& sample, const codec::CodecOptions& options);

}  // namespace fathom::sim::encode
