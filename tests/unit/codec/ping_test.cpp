// Ping protocol: the example of its documentation, and messages laid out by hand from its tables.

#include <bit>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "nmea_text.hpp"

namespace fathom::codec {
namespace {

using test::decode_text;
using test::DecodeRun;

class Message {
 public:
  explicit Message(std::uint16_t identifier) : identifier_(identifier) {}
  Message& u8(unsigned value) { return put(value, 1); }
  Message& u16(unsigned value) { return put(value, 2); }
  Message& u32(unsigned value) { return put(value, 4); }
  Message& real(float value) { return put(std::bit_cast<std::uint32_t>(value), 4); }
  /// As it goes over the line.
  [[nodiscard]] std::string text() const {
    std::string out = "BR";
    const auto size = static_cast<unsigned>(contents_.size());
    for (const unsigned byte : {size & 0xFFU, size >> 8U, identifier_ & 0xFFU, identifier_ >> 8U, 1U, 0U})
      out += static_cast<char>(byte);
    out += contents_;
    unsigned sum = 0;
    for (const char byte : out) sum += static_cast<unsigned char>(byte);
    out += static_cast<char>(sum & 0xFFU);
    out += static_cast<char>(sum >> 8U & 0xFFU);
    return out;
  }

 private:
  Message& put(unsigned value, int bytes) {
    for (int i = 0; i < bytes; ++i) contents_ += static_cast<char>(value >> (8 * i) & 0xFFU);
    return *this;
  }
  unsigned identifier_;
  std::string contents_;
};

Message distance(unsigned range_mm, unsigned confidence, unsigned number) {
  return Message(1212).u32(range_mm).u16(confidence).u16(120).u32(number).u32(0).u32(30'000).u32(3);
}
Message profile(unsigned range_mm, unsigned confidence, unsigned number, unsigned strengths) {
  Message out(1300);
  out.u32(range_mm).u16(confidence).u16(120).u32(number).u32(0).u32(30'000).u32(3).u16(strengths);
  for (unsigned i = 0; i < strengths; ++i) out.u8(i);
  return out;
}
Message averaged(unsigned range_mm, unsigned confidence, unsigned time_ms) {
  return Message(1223).u32(range_mm).u32(9'999).u16(0).u8(confidence).u8(90).u32(time_ms);
}
Message strong_profile(float range_m, unsigned confidence, unsigned number) {
  Message out(1308);
  out.u32(number).u32(0).u32(5'000).u32(480'000).u32(520'000).u32(100'000).u32(77).u32(0);
  out.real(1e-4F).real(1.0F).real(80.0F).real(20.0F).real(range_m).real(9.9F).real(0.0F);
  return out.u8(confidence).u8(2).u8(1).u8(90).u16(3).u16(1).u16(2).u16(3);
}

std::vector<double> altitudes(const std::string& text, const CodecOptions& options = {}) {
  std::vector<double> out;
  for (const AltimeterSample& sample : decode_text("ping", text, options).all<AltimeterSample>())
    out.push_back(sample.altitude_m);
  return out;
}

RejectReason refusal(const std::string& text) {
  const DecodeRun run = decode_text("ping", text);
  EXPECT_EQ(run.rejected.size(), 1U);
  EXPECT_TRUE(run.samples.empty());
  return run.rejected.empty() ? RejectReason::truncated : run.rejected[0].reason;
}

// "Unpack" of the documentation: 7.515 m, 100 %.
TEST(Ping, TheExampleOfItsDocumentation) {
  const std::string reply{"\x42\x52\x05\x00\xBB\x04\x00\x00\x5B\x1D\x00\x00\x64\x34\x02", 15};
  EXPECT_EQ(altitudes(reply), std::vector{7.515});
  // Its "Pack": what is asked of the device carries no sample.
  const std::string request{"\x42\x52\x02\x00\x06\x00\x00\x00\xBB\x04\x5B\x01", 12};
  EXPECT_EQ(decode_text("ping", request + reply).totals.frames_ignored, 1U);
}

TEST(Ping, EachMessageThatTellsARange) {
  EXPECT_EQ(altitudes(distance(12'345, 80, 1).text()), std::vector{12.345});
  EXPECT_EQ(altitudes(profile(250, 100, 1, 200).text()), std::vector{0.25});
  EXPECT_EQ(altitudes(profile(250, 100, 1, 0).text()), std::vector{0.25});
  EXPECT_EQ(altitudes(averaged(3'500, 60, 1).text()), std::vector{3.5});
  EXPECT_EQ(altitudes(strong_profile(6.5F, 70, 1).text()), std::vector{6.5});
}

TEST(Ping, ARangeOfWhichItIsNotSureIsUnknown) {
  const std::string pings =
      distance(5'000, 49, 1).text() + distance(6'000, 50, 2).text() + distance(0, 0, 3).text();
  const auto half = altitudes(pings);
  ASSERT_EQ(half.size(), 3U);
  EXPECT_TRUE(std::isnan(half[0]));
  EXPECT_EQ(half[1], 6.0);
  EXPECT_TRUE(std::isnan(half[2]));
  CodecOptions sure;
  sure.least_confidence_percent = 60.0;
  EXPECT_TRUE(std::isnan(altitudes(pings, sure)[1]));
}

TEST(Ping, APingIsToldOnce) {
  const std::string simple = Message(1211).u32(4'000).u8(100).text();
  const DecodeRun run =
      decode_text("ping", profile(4'000, 100, 7, 10).text() + simple + distance(4'000, 100, 7).text() +
                              distance(4'100, 100, 8).text());
  EXPECT_EQ(run.samples.size(), 2U);
  EXPECT_EQ(run.totals.frames_ignored, 2U);
  // The other message ends: distance_simple counts again.
  std::string later = distance(4'000, 100, 7).text();
  for (int i = 0; i < 60; ++i) later += simple;
  EXPECT_EQ(altitudes(later).size(), 11U);
}

TEST(Ping, DamageAndNonsenseAreRefused) {
  std::string damaged = distance(4'000, 100, 7).text();
  damaged[9] = 'x';
  EXPECT_EQ(refusal(damaged), RejectReason::checksum);
  EXPECT_EQ(refusal(distance(4'000, 101, 7).text()), RejectReason::out_of_range);
  EXPECT_EQ(refusal(distance(12'000'001, 100, 7).text()), RejectReason::out_of_range);
  EXPECT_EQ(refusal(strong_profile(-1.0F, 100, 7).text()), RejectReason::out_of_range);
  EXPECT_EQ(refusal(strong_profile(std::nanf(""), 100, 7).text()), RejectReason::field);
  EXPECT_EQ(refusal(distance(4'000, 100, 7).u8(0).text()), RejectReason::length);
  EXPECT_EQ(refusal(Message(1211).u32(4'000).text()), RejectReason::structure);
  EXPECT_EQ(refusal(profile(4'000, 100, 7, 10).u8(0).text()), RejectReason::structure);
  EXPECT_EQ(refusal({"BR\xFF\xFF\xBB\x04\x01\x00", 8}), RejectReason::length);
}

// A length that is damaged must not swallow what follows.
TEST(Ping, TheNextOneIsFoundInsideOfWhatWasRefused) {
  std::string longer = distance(4'000, 100, 7).text();
  longer[2] = 40;
  EXPECT_EQ(altitudes(longer + distance(4'100, 100, 8).text() + distance(4'200, 100, 9).text()),
            (std::vector{4.1, 4.2}));
}

}  // namespace
}  // namespace fathom::codec
