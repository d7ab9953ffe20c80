#include "support/codec/other_contents.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <limits>
#include <random>
#include <span>
#include <string>

#include "base/bytes/big_endian.hpp"
#include "base/bytes/little_endian.hpp"
#include "codec/byte_sum.hpp"
#include "codec/crc16.hpp"
#include "codec/crc32.hpp"
#include "codec/dvl/nortek.hpp"
#include "codec/fletcher.hpp"
#include "codec/imu/sbg.hpp"
#include "codec/imu/stim300.hpp"
#include "codec/imu/vectornav.hpp"
#include "codec/imu/xsens.hpp"
#include "codec/satellite/novatel/novatel.hpp"
#include "codec/text/nmea_sentence.hpp"
#include "mavlink/crc.hpp"
#include "mavlink/known.hpp"
#include "support/codec/seed_streams.hpp"

namespace fathom::test {
namespace {

using Frame = std::span<std::uint8_t>;
using Random = std::mt19937_64;

void put_fletcher(Frame frame, std::size_t from) {
  const auto sum = codec::fletcher8(frame.subspan(from, frame.size() - from - 2));
  std::copy(sum.begin(), sum.end(), frame.end() - 2);
}

/// How a protocol's frames begin, how long they are, and how they are closed.
struct Seal {
  std::string_view protocol;
  /// Of the frame at the beginning of these bytes; 0 where none begins, or it says no length.
  std::size_t (*length)(Frame at);
  std::size_t contents;  ///< first byte behind the header
  void (*close)(Frame frame);
};

std::size_t ubx_length(Frame at) {
  return at[0] == 0xB5 && at[1] == 0x62 ? 8 + load_le<std::uint16_t>(at, 4) : 0U;
}
std::size_t novatel_length(Frame at) {
  if (at[0] != 0xAA || at[1] != 0x44) return 0;
  return at[2] == 0x13 ? 16U + at[3] : at[3] + load_le<std::uint16_t>(at, 8) + 4U;
}
std::size_t sbf_length(Frame at) {
  return at[0] == '$' && at[1] == '@' ? load_le<std::uint16_t>(at, 6) : 0U;
}
std::size_t pd0_length(Frame at) {
  return at[0] == 0x7F && at[1] == 0x7F ? 2 + load_le<std::uint16_t>(at, 2) : 0U;
}
std::size_t xsens_length(Frame at) {
  return at[0] == 0xFA && at[1] == 0xFF && at[3] != 0xFF ? 5U + at[3] : 0U;
}
std::size_t microstrain_length(Frame at) {
  return at[0] == 0x75 && at[1] == 0x65 ? 6U + at[3] : 0U;
}
std::size_t sbg_length(Frame at) {
  return at[0] == 0xFF && at[1] == 0x5A ? 9 + load_le<std::uint16_t>(at, 4) : 0U;
}
std::size_t nortek_length(Frame at) {
  return at[0] == 0xA5 && at[1] == 10 ? 10 + load_le<std::uint16_t>(at, 4) : 0U;
}
std::size_t ping_length(Frame at) {
  return at[0] == 'B' && at[1] == 'R' ? 10 + load_le<std::uint16_t>(at, 2) : 0U;
}
std::size_t mavlink_length(Frame at) {
  return at[0] == 0xFD && at[2] == 0 ? 12U + at[1] : 0U;
}
std::size_t kvh_length(Frame at) {
  if (at[0] != 0xFE || at[1] != 0x81 || at[2] != 0xFF) return 0;
  return at[3] == 0x55 ? 36U : at[3] == 0x56 ? 40U : at[3] == 0x57 ? 38U : 0U;
}
void put_be32(Frame frame, std::size_t at, std::uint32_t value) {
  for (std::size_t i = 0; i < 4; ++i) frame[at + i] = static_cast<std::uint8_t>(value >> (24U - 8U * i));
}
/// Their frames do not say how long they are: these are found by their samples.
std::size_t says_none(Frame /*at*/) {
  return 0;
}

constexpr std::array kSeals{
    Seal{"ubx", ubx_length, 6, [](Frame frame) { put_fletcher(frame, 2); }},
    Seal{"novatel", novatel_length, 12,
         [](Frame frame) {
           const std::size_t sealed = frame.size() - 4;
           store_le<std::uint32_t>(frame, sealed, codec::novatel::crc32(frame.first(sealed)));
         }},
    Seal{"sbf", sbf_length, 8,
         [](Frame frame) { store_le<std::uint16_t>(frame, 2, codec::crc16_ccitt(frame.subspan(4))); }},
    Seal{"pd0", pd0_length, 6,
         [](Frame frame) {
           const std::size_t sealed = frame.size() - 2;
           store_le<std::uint16_t>(frame, sealed, codec::byte_sum(frame.first(sealed)));
         }},
    Seal{"xsens", xsens_length, 4,
         [](Frame frame) { frame.back() = codec::xsens::checksum(frame.subspan(1, frame.size() - 2)); }},
    Seal{"microstrain", microstrain_length, 4, [](Frame frame) { put_fletcher(frame, 0); }},
    Seal{"sbg", sbg_length, 6,
         [](Frame frame) {
           const std::size_t sealed = frame.size() - 3;
           store_le<std::uint16_t>(frame, sealed, codec::sbg::crc16(frame.subspan(2, sealed - 2)));
           frame.back() = 0x33;
         }},
    Seal{"nortek", nortek_length, 10,
         [](Frame frame) {
           store_le<std::uint16_t>(frame, 6, codec::nortek::checksum(frame.subspan(10)));
           store_le<std::uint16_t>(frame, 8, codec::nortek::checksum(frame.first(8)));
         }},
    Seal{"ping", ping_length, 8,
         [](Frame frame) {
           const std::size_t sealed = frame.size() - 2;
           store_le<std::uint16_t>(frame, sealed, codec::byte_sum(frame.first(sealed)));
         }},
    Seal{"mavlink", mavlink_length, 10,
         [](Frame frame) {
           const std::uint32_t id = frame[7] | frame[8] << 8U | frame[9] << 16U;
           const auto* known = mavlink::find_known(id);
           if (known == nullptr) return;
           const std::size_t sealed = frame.size() - 2;
           const std::uint16_t crc = mavlink::crc_of(frame.subspan(1, sealed - 1));
           store_le<std::uint16_t>(frame, sealed, mavlink::crc_with(known->crc_extra, crc));
         }},
    Seal{"vectornav", says_none, 6,
         [](Frame frame) {
           if (frame[0] != 0xFA) return;
           const std::size_t sealed = frame.size() - 2;
           const std::uint16_t crc = codec::vectornav_crc16(frame.subspan(1, sealed - 1));
           frame[sealed] = static_cast<std::uint8_t>(crc >> 8U);
           frame[sealed + 1] = static_cast<std::uint8_t>(crc & 0xFFU);
         }},
    Seal{"kvh", kvh_length, 4,
         [](Frame frame) {
           const std::size_t sealed = frame.size() - 4;
           put_be32(frame, sealed, codec::crc32_mpeg2(frame.first(sealed)));
         }},
    Seal{"stim300", says_none, 1,
         [](Frame frame) {
           const std::size_t sealed = frame.size() - 4;
           put_be32(frame, sealed, codec::stim300::crc32(frame.first(sealed)));
         }},
};

/// Infinite where it is too large.
float as_float(double real) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  if (std::abs(real) > 3e38) return real > 0.0 ? kInfinity : -kInfinity;
  return static_cast<float>(real);
}

/// A number at the end of its type, or none, at a place in a frame.
void put_extreme(Frame contents, Random& random) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  static constexpr std::array kReals{
      kInfinity, -kInfinity, std::numeric_limits<double>::quiet_NaN(), 1e300, -1e300, 1e-310, -0.0, 1e30};
  ByteVector bytes;
  const double real = kReals[random() % kReals.size()];
  switch (random() % 8) {
    case 0:
      append_le<double>(bytes, real);
      break;
    case 1:
      append_be<double>(bytes, real);
      break;
    case 2:
      append_le<float>(bytes, as_float(real));
      break;
    case 3:
      append_be<float>(bytes, as_float(real));
      break;
    case 4:
      bytes.assign(1 + random() % 8, 0xFF);
      break;
    case 5:
      bytes.assign(1 + random() % 8, 0x00);
      break;
    case 6:
      bytes = {0xFF, 0xFF, 0xFF, 0x7F};
      break;
    default:
      bytes = {0x00, 0x00, 0x00, 0x80};
  }
  bytes.resize(std::min(bytes.size(), contents.size()));
  const std::size_t at = random() % (contents.size() - bytes.size() + 1);
  std::copy(bytes.begin(), bytes.end(), contents.begin() + static_cast<std::ptrdiff_t>(at));
}

void change(const Seal& seal, Frame frame, Random& random) {
  if (frame.size() <= seal.contents + 4) return;
  for (std::uint64_t i = 0; i < 1 + random() % 4; ++i)
    put_extreme(frame.subspan(seal.contents, frame.size() - seal.contents - 2), random);
  seal.close(frame);
}

ByteVector with_other_frames(const Seal& seal, ByteVector stream, Random& random) {
  const Frame all(stream);
  if (seal.length == says_none) {
    const DecodeRun run = decode_whole(seal.protocol, stream, seed_options(seal.protocol));
    for (const codec::Decoded& each : run.samples)
      if (random() % 2 == 0) change(seal, all.subspan(each.offset, each.length), random);
    return stream;
  }
  for (std::size_t at = 0; at + 12 < all.size();) {
    const std::size_t length = seal.length(all.subspan(at));
    if (length == 0 || at + length > all.size()) {
      ++at;
      continue;
    }
    if (random() % 2 == 0) change(seal, all.subspan(at, length), random);
    at += length;
  }
  return stream;
}

/// Lines of text: some numbers are others, and a sentence's checksum holds again.
ByteVector with_other_numbers(const ByteVector& stream, Random& random) {
  static constexpr std::array<std::string_view, 14> kNumbers{
      "",       "-",    "+",   ".",          "-0", "1e999", "-1e308", "nan", "inf", "99999999999999999999",
      "1e-320", "0x10", "360", "-2147483648"};
  ByteVector out;
  std::string line;
  const auto finish_line = [&] {
    const std::size_t star = line.rfind('*');
    if (star != std::string::npos && star + 3 <= line.size()) {
      const std::size_t from = line[0] == '$' || line[0] == '!' ? 1 : 0;
      std::array<char, 3> sum{};
      (void)std::snprintf(sum.data(), sum.size(), "%02X",
                          codec::nmea_checksum(std::string_view(line).substr(from, star - from)));
      line.replace(star + 1, 2, sum.data());
    }
    out.insert(out.end(), line.begin(), line.end());
    line.clear();
  };
  for (std::size_t i = 0; i < stream.size();) {
    const bool digit = std::isdigit(stream[i]) != 0;
    const bool begins = digit && (line.empty() || std::isalnum(static_cast<unsigned char>(line.back())) == 0);
    const bool of_checksum = !line.empty() && line.back() == '*';
    if (begins && !of_checksum && random() % 16 == 0) {
      while (i < stream.size() && (std::isdigit(stream[i]) != 0 || stream[i] == '.')) ++i;
      line += kNumbers[random() % kNumbers.size()];
      continue;
    }
    line.push_back(static_cast<char>(stream[i]));
    if (stream[i++] == '\n') finish_line();
  }
  finish_line();
  return out;
}

}  // namespace

ByteVector with_other_contents(std::string_view protocol, const ByteVector& stream, std::uint64_t seed) {
  Random random(seed);
  const auto* seal =
      std::find_if(kSeals.begin(), kSeals.end(), [&](const Seal& each) { return each.protocol == protocol; });
  return seal != kSeals.end() ? with_other_frames(*seal, stream, random) : with_other_numbers(stream, random);
}

}  // namespace fathom::test
