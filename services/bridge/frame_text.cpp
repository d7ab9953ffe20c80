#include "bridge/frame_text.hpp"

#include <algorithm>
#include <array>
#include <cstdio>

namespace fathom::bridge {
namespace {

constexpr std::size_t kMostText = 120;  // a sentence of NMEA 0183 has 82
constexpr std::size_t kMostBytes = 40;

}  // namespace

std::string shown(std::span<const std::uint8_t> frame) {
  while (!frame.empty() && (frame.back() == '\r' || frame.back() == '\n'))
    frame = frame.first(frame.size() - 1);
  const bool is_text = !frame.empty() && std::all_of(frame.begin(), frame.end(), [](std::uint8_t byte) {
    return (byte >= 0x20 && byte < 0x7F) || byte == '\t';
  });
  const auto front = frame.first(std::min(frame.size(), is_text ? kMostText : kMostBytes));
  std::string out;
  if (is_text) {
    out = "\"" + std::string(front.begin(), front.end()) + "\"";
  } else {
    for (const std::uint8_t byte : front) {
      std::array<char, 4> text{};
      std::snprintf(text.data(), text.size(), out.empty() ? "%02x" : " %02x", unsigned{byte});
      out += text.data();
    }
  }
  return front.size() < frame.size() ? out + " ..." : out;
}

std::string sentence(const codec::Rejected& rejected) {
  return "frame of " + std::to_string(rejected.length) + " bytes refused (" +
         std::string(codec::to_string(rejected.reason)) + ": " +
         std::string(codec::meaning(rejected.reason)) + "): " + shown(rejected.bytes);
}

}  // namespace fathom::bridge
