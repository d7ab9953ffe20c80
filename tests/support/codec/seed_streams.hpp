#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "codec/registry.hpp"
#include "support/codec/decode_run.hpp"

namespace fathom::test {

/// A stream that the protocol's instrument could send: good frames of every kind the encoders know, written
/// by them. The same bytes on every machine.
[[nodiscard]] ByteVector seed_stream(std::string_view protocol);

/// The options under which seed_stream is good.
[[nodiscard]] codec::CodecOptions seed_options(std::string_view protocol);

/// A copy with `errors` errors as transmission makes them: flipped bits, lost, inserted, repeated and swapped
/// pieces, a cut end. The same for the same seed.
[[nodiscard]] ByteVector mutated(const ByteVector& stream, std::size_t errors, std::uint64_t seed);

/// Random bytes; the same for the same seed.
[[nodiscard]] ByteVector noise(std::size_t length, std::uint64_t seed);

}  // namespace fathom::test
