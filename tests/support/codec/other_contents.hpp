#pragma once

#include <cstdint>
#include <string_view>

#include "support/codec/decode_run.hpp"

namespace fathom::test {

/// A copy of a stream of good frames in which some frames have other contents and a checksum that holds: no
/// error of transmission, but a device that says what cannot be. Numbers become those at the ends of their
/// types, or none at all; of text, what a number may be written like. The same for the same seed.
[[nodiscard]] ByteVector with_other_contents(std::string_view protocol, const ByteVector& stream,
                                             std::uint64_t seed);

}  // namespace fathom::test
