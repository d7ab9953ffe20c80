#pragma once

#include <array>
#include <cstdio>
#include <string>
#include <string_view>

#include "codec/text/nmea_sentence.hpp"
#include "support/codec/decode_run.hpp"

namespace fathom::test {

/// `$body*hh` CR LF.
inline std::string sentence(std::string_view body) {
  std::array<char, 8> tail{};
  (void)std::snprintf(tail.data(), tail.size(), "*%02X\r\n", codec::nmea_checksum(body));
  return "$" + std::string(body) + tail.data();
}

inline DecodeRun decode_text(std::string_view protocol, std::string_view text,
                             const codec::CodecOptions& options = {}) {
  return decode_whole(protocol, bytes_of(text), options);
}

}  // namespace fathom::test
