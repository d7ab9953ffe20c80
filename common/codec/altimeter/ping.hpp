#pragma once

#include <memory>
#include <string_view>

#include "codec/registry.hpp"

namespace fathom::codec {

/// Ping protocol of Blue Robotics' echo sounders (Ping1D, Ping2) and of Cerulean's (S500): "BR", length and
/// identifier of the contents, two device numbers, contents, sum of all bytes; little-endian ("Format" and
/// "Messages" of the protocol's documentation).
///
/// distance_simple (1211), distance (1212), profile (1300), distance2 (1223) and profile6_t (1308) give the
/// range of their last ping; the strengths along a profile are not handed on. Below
/// CodecOptions::least_confidence_percent the altitude is unknown: the instrument is alive and is not sure of
/// a bottom. Other identifiers, and what others ask of the instrument on the same line, carry no sample.
///
/// A ping is told once. One that has a number is known by it, however often it is told and in whatever
/// message; distance_simple has none and counts as long as no other message tells ranges.
///
/// Ping1D and Ping2 are silent until they are asked: kPingGreeting asks for profiles, which is what they
/// stream.
[[nodiscard]] std::unique_ptr<Codec> make_ping(const CodecOptions& options);

/// continuous_start (1400) of profile (1300).
extern constinit const std::string_view kPingGreeting;

}  // namespace fathom::codec
