#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "codec/codec.hpp"
#include "codec/registry.hpp"

namespace fathom::test {

using ByteVector = std::vector<std::uint8_t>;

/// Everything a codec said about a stream, in the order it said it.
struct DecodeRun final : codec::Sink {
  void on_sample(const codec::Decoded& decoded) override {
    samples.push_back(decoded);
    record(decoded);
  }
  void on_rejected(const codec::Rejected& refused) override {
    rejected.push_back(refused);
    record(refused);
  }

  template <class Sample>
  [[nodiscard]] std::vector<Sample> all() const {
    std::vector<Sample> found;
    for (const codec::Decoded& decoded : samples) {
      if (const auto* sample = std::get_if<Sample>(&decoded.sample)) found.push_back(*sample);
    }
    return found;
  }

  std::vector<codec::Decoded> samples;
  std::vector<codec::Rejected> rejected;
  codec::Totals totals;
  /// One line per event with every field exact: two runs are equal when these are.
  std::string transcript;
  bool keep_transcript = true;

 private:
  void record(const codec::Decoded& decoded);
  void record(const codec::Rejected& refused);
};

[[nodiscard]] inline ByteVector bytes_of(std::string_view text) {
  return {text.begin(), text.end()};
}

/// Feeds all bytes at once, then the end of the stream.
[[nodiscard]] DecodeRun decode_whole(std::string_view protocol, std::span<const std::uint8_t> bytes,
                                     const codec::CodecOptions& options = {});

/// Feeds pieces of 1 to `largest` bytes, drawn from `seed`; with largest 1 byte by byte.
[[nodiscard]] DecodeRun decode_chunked(std::string_view protocol, std::span<const std::uint8_t> bytes,
                                       std::size_t largest, std::uint64_t seed,
                                       const codec::CodecOptions& options = {});

/// What every run must satisfy, whatever the bytes: "" or what is wrong. Counts agree with the events, frames
/// lie inside the stream, and good, refused and skipped bytes do not exceed it.
[[nodiscard]] std::string inconsistency(const DecodeRun& run, std::size_t stream_length);

}  // namespace fathom::test
