#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string_view>

#include "support/codec/decode_run.hpp"
#include "support/codec/seed_streams.hpp"

namespace fathom::fuzz {

/// What must hold for any bytes at all: the codec returns, its totals agree with what it delivered, and the
/// same bytes in pieces give the same result. A violation aborts, which is what a fuzzer notices.
inline void check(std::string_view protocol, const std::uint8_t* data, std::size_t size) {
  const std::span<const std::uint8_t> bytes(data, size);
  const codec::CodecOptions options = test::seed_options(protocol);
  const test::DecodeRun whole = test::decode_whole(protocol, bytes, options);
  if (const std::string wrong = test::inconsistency(whole, size); !wrong.empty()) {
    (void)std::fprintf(stderr, "%.*s: %s\n", static_cast<int>(protocol.size()), protocol.data(),
                       wrong.c_str());
    std::abort();
  }
  const test::DecodeRun cut = test::decode_chunked(protocol, bytes, 1 + size % 40, size, options);
  if (cut.transcript != whole.transcript || cut.totals.skipped_bytes != whole.totals.skipped_bytes ||
      cut.totals.frames_ignored != whole.totals.frames_ignored) {
    (void)std::fprintf(stderr, "%.*s: whole\n%s\nin pieces\n%s\n", static_cast<int>(protocol.size()),
                       protocol.data(), whole.transcript.c_str(), cut.transcript.c_str());
    std::abort();
  }
}

}  // namespace fathom::fuzz
