#include "codec/dvl/nortek.hpp"

#include <cmath>
#include <limits>
#include <string>
#include <string_view>

#include <gtest/gtest.h>

#include "base/bytes/little_endian.hpp"
#include "capture.hpp"

namespace fathom::codec::nortek_test {
namespace {

using capture::ByteVector;
using capture::decode;
using capture::Harvest;
using capture::of_kind;

ByteVector from_hex(std::string_view text) {
  ByteVector bytes;
  for (std::size_t i = 0; i + 1 < text.size(); i += 2)
    bytes.push_back(static_cast<std::uint8_t>(std::stoi(std::string(text.substr(i, 2)), nullptr, 16)));
  return bytes;
}

ByteVector operator+(ByteVector a, const ByteVector& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

// The first record of a DVL333 (smarc-project/nortek_dvl333_driver, data/dvl.bin).
constexpr std::string_view kAfloat =
    "a50a1b10d40021cc419d0124149b01007b0a0f0925270a00040000000000ffff0f100080bb4400d1b440f775e03deb9a"
    "843dbe0b373dc7d27dbd85f024bd7da66c40f51c80407da66c40c7dc62404ddaf03a56ba883a40f8ac3ab06a7b3a12f2"
    "813ceec9833c2406813c915c7e3c6abe20bfacaf20bfcac520bf89d420bf47c4143cb7231c3c47c4143cd7640d3cdb05"
    "363e69a20f3d40dcc83ad8b11f3bf1e9123befe9123be874a33a0dc44c3af753833cf753833c1c7c813cf753833c5bb3"
    "20bf5bb320bf1ac220bf5bb320bf92fb1d3c92fb1d3c249c163c92fb1d3c";

// A DVL1000 in air (GSO-soslab/whoi_ds, test_nortekdvl1000_parsing.cpp).
constexpr std::string_view kInAir =
    "a50a1b10d4000c0d2cde0124848a01007707080e31150a00040000000000000000200080bb44e0b6af411f856b3d6f12"
    "03c26f1203c26f1203c26f1203c2000000000000000000000000000000000000204100002041000020410000204140c2"
    "b03c40c2b03c40c2b03c40c2b03c41290abe41290abe41290abe41290abe000000000000000000000000000000006f12"
    "03c26f1203c26f1203c26f1203c20000204100002041000020410000204140c2b03c40c2b03c40c2b03c40c2b03c4129"
    "0abe41290abe41290abe41290abe00000000000000000000000000000000";

/// What is behind the header of a record.
ByteVector data_of(std::string_view hex) {
  ByteVector bytes = from_hex(hex);
  return {bytes.begin() + 10, bytes.end()};
}

/// A record of any kind with its checksums: words added to 0xB58C.
ByteVector record(std::uint8_t kind, const ByteVector& data, std::size_t header = 10,
                  std::uint8_t family = 0x10) {
  const auto sum = [](ByteVector bytes) {
    if (bytes.size() % 2 == 1) bytes.insert(bytes.end() - 1, 0);  // an odd last byte is the high one
    unsigned total = 0xB58C;
    for (std::size_t i = 0; i < bytes.size(); i += 2) total += bytes[i] + 256U * bytes[i + 1];
    return static_cast<std::uint16_t>(total);
  };
  ByteVector out{0xA5, static_cast<std::uint8_t>(header), kind, family};
  if (header == 10) {
    append_le<std::uint16_t>(out, static_cast<std::uint16_t>(data.size()));
  } else {
    append_le<std::uint32_t>(out, static_cast<std::uint32_t>(data.size()));
  }
  append_le<std::uint16_t>(out, sum(data));
  append_le<std::uint16_t>(out, sum(out));
  return out + data;
}

constexpr std::size_t kStatus = 20;
constexpr std::size_t kBeams = 36;  // six groups of four numbers, then five of the axes
constexpr std::size_t kAxes = 132;
constexpr std::uint32_t kAllValid = 0x000FFFFF;

/// The record afloat with something changed.
class Changed {
 public:
  Changed& status(std::uint32_t word) {
    store_le<std::uint32_t>(data_, kStatus, word);
    return *this;
  }
  Changed& number(std::size_t at, std::size_t i, float value) {
    store_le<float>(data_, at + 4 * i, value);
    return *this;
  }
  Changed& byte(std::size_t at, int value) {
    data_[at] = static_cast<std::uint8_t>(value);
    return *this;
  }
  Changed& size(std::size_t bytes) {
    data_.resize(bytes);
    return *this;
  }
  [[nodiscard]] ByteVector as(std::uint8_t kind, std::size_t header = 10) const {
    return record(kind, data_, header);
  }

 private:
  ByteVector data_ = data_of(kAfloat);
};

DvlSample one(const ByteVector& bytes) {
  const auto dvl = of_kind<DvlSample>(decode("nortek", bytes));
  EXPECT_EQ(dvl.size(), 1U);
  return dvl.empty() ? DvlSample{} : dvl[0].second;
}

TEST(Nortek, ReadsARecord) {
  const Harvest run = decode("nortek", from_hex(kAfloat));
  const auto dvl = of_kind<DvlSample>(run);
  ASSERT_EQ(dvl.size(), 1U);
  const DvlSample& s = dvl[0].second;
  EXPECT_EQ(s.mode, DvlMode::bottom);
  EXPECT_EQ(s.recorded_frame, DvlFrame::instrument);
  const std::array<double, 3> velocity{0.177757, 0.035067, 0.5 * (0.00153244 + 0.00243675)};
  const std::array<double, 4> beams{0.0647486, 0.0446889, -0.0619686, -0.0402684};
  const std::array<double, 4> ranges{3.69766, 4.00353, 3.69766, 3.54473};
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(s.velocity_D_m_s[i], velocity[i], 1e-6);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(s.beam_velocity_m_s[i], beams[i], 1e-6);
    EXPECT_NEAR(s.beam_range_m[i], ranges[i], 1e-5);
  }
  EXPECT_NEAR(s.altitude_m, 3.735895, 1e-5);
  EXPECT_NEAR(s.sigma_m_s, 0.00224173, 1e-8);
  EXPECT_NEAR(s.error_velocity_m_s, 1.5164 * (0.00153244 - 0.00243675), 1e-7);
  EXPECT_EQ(s.sound_speed_m_s, 1500.0);
  EXPECT_FALSE(known(s.beam_angle_rad));  // the record does not say it
  // 2023-11-15T09:37:39.001 was the trigger; the echo 16.03 ms later, 627.74 ms before the output.
  EXPECT_NEAR(static_cast<double>(*dvl[0].first.time.clock_ns - 1'700'041'059'001'000'000), 16'031'248, 2);
  EXPECT_NEAR(static_cast<double>(*dvl[0].first.time.age_ns), 627'736'747, 2);
  EXPECT_FALSE(dvl[0].first.time.utc_ns.has_value());
  EXPECT_EQ(run.totals.skipped_bytes, 0U);
}

TEST(Nortek, InAirItIsAliveWithoutVelocity) {
  const Harvest run = decode("nortek", from_hex(kInAir));
  const auto dvl = of_kind<DvlSample>(run);
  ASSERT_EQ(dvl.size(), 1U);
  const DvlSample& s = dvl[0].second;
  for (const double v : s.velocity_D_m_s) EXPECT_FALSE(known(v));
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_FALSE(known(s.beam_velocity_m_s[i]));
    EXPECT_FALSE(known(s.beam_range_m[i]));
  }
  EXPECT_FALSE(known(s.altitude_m));
  EXPECT_FALSE(known(s.sigma_m_s));
  EXPECT_FALSE(known(s.error_velocity_m_s));
  EXPECT_EQ(s.sound_speed_m_s, 1500.0);
  // 2019-08-08T14:49:21.001 on a clock that is tracked, whatever it shows.
  EXPECT_NEAR(static_cast<double>(*dvl[0].first.time.clock_ns - 1'565'275'761'001'000'000), 21'577'000, 2);
  EXPECT_NEAR(static_cast<double>(*dvl[0].first.time.age_ns), 134'923'000, 1'000);
}

TEST(Nortek, TheWaterTrackHasNoDistance) {
  const DvlSample s = one(Changed().as(0x1D));
  EXPECT_EQ(s.mode, DvlMode::water);
  EXPECT_NEAR(s.velocity_D_m_s[0], 0.177757, 1e-6);
  EXPECT_NEAR(s.beam_velocity_m_s[3], -0.0402684, 1e-7);
  EXPECT_FALSE(known(s.altitude_m));
  EXPECT_FALSE(known(s.beam_range_m[0]));
}

TEST(Nortek, ALostBeamTakesNoOtherNumberWithIt) {
  // The status of such a record in the same recording: beam 2 and Z2 are lost.
  const DvlSample s = one(Changed().status(0x10077DDD).as(0x1B));
  EXPECT_FALSE(known(s.beam_velocity_m_s[1]));
  EXPECT_FALSE(known(s.beam_range_m[1]));
  for (const std::size_t i : {0U, 2U, 3U}) EXPECT_TRUE(known(s.beam_velocity_m_s[i]));
  EXPECT_NEAR(s.velocity_D_m_s[0], 0.177757, 1e-6);
  EXPECT_NEAR(s.velocity_D_m_s[2], 0.00153244, 1e-8);  // Z1 alone
  EXPECT_FALSE(known(s.error_velocity_m_s));
  EXPECT_NEAR(s.altitude_m, (3.69766 + 3.69766 + 3.54473) / 3.0, 1e-5);
}

TEST(Nortek, TwoBeamsGiveWhatTheyMeasure) {
  const DvlSample s = one(Changed().status(0x0000'80AA).as(0x1B));  // beams 2 and 4, and Z2
  EXPECT_FALSE(known(s.velocity_D_m_s[0]));
  EXPECT_FALSE(known(s.velocity_D_m_s[1]));
  EXPECT_NEAR(s.velocity_D_m_s[2], 0.00243675, 1e-8);
  EXPECT_TRUE(known(s.beam_velocity_m_s[1]) && known(s.beam_velocity_m_s[3]));
  EXPECT_FALSE(known(s.sigma_m_s));
}

TEST(Nortek, TheWordsForNothingAreNoNumbersWhateverTheStatusSays) {
  const DvlSample s = one(Changed()
                              .number(kAxes, 1, -32.768F)
                              .number(kBeams + 16, 2, 0.0F)
                              .number(kAxes + 16, 0, 10.0F)
                              .as(0x1B));
  EXPECT_TRUE(known(s.velocity_D_m_s[0]));
  EXPECT_FALSE(known(s.velocity_D_m_s[1]));
  EXPECT_FALSE(known(s.beam_range_m[2]));
  EXPECT_FALSE(known(s.sigma_m_s));
}

TEST(Nortek, WhatIsNotValidMayBeAnything) {
  Changed changed;
  changed.status(kAllValid & ~0x0000'2001U);  // without beam 1 and Y
  changed.number(kBeams, 0, std::numeric_limits<float>::quiet_NaN()).number(kAxes, 1, 4e9F);
  const DvlSample s = one(changed.as(0x1B));
  EXPECT_FALSE(known(s.beam_velocity_m_s[0]));
  EXPECT_FALSE(known(s.velocity_D_m_s[1]));
  EXPECT_TRUE(known(s.velocity_D_m_s[0]));
}

TEST(Nortek, TimesAreThoseOfTheFirstNumberThatIsGood) {
  Changed changed;
  changed.status(0x0000'4005);  // beams 1 and 3, and Z1
  changed.number(kAxes + 32, 0, std::numeric_limits<float>::quiet_NaN());
  const Harvest axes = decode("nortek", changed.as(0x1B));
  ASSERT_EQ(axes.samples.size(), 1U);
  EXPECT_NEAR(static_cast<double>(*axes.samples[0].time.age_ns), 627'961'755, 2);
  const Harvest beam = decode("nortek", changed.status(0x0000'0008).as(0x1B));
  ASSERT_EQ(beam.samples.size(), 1U);
  EXPECT_NEAR(static_cast<double>(*beam.samples[0].time.clock_ns % kNsPerSecond), 1'000'000 + 15'525'000, 2);
  // Where nothing is good, times that are none do not matter.
  const Harvest nothing = decode("nortek", changed.status(0).as(0x1B));
  ASSERT_EQ(nothing.samples.size(), 1U);
  EXPECT_FALSE(nothing.samples[0].time.clock_ns.has_value());
  EXPECT_FALSE(nothing.samples[0].time.age_ns.has_value());
}

TEST(Nortek, AClockWithoutDateIsNone) {
  const Harvest run = decode("nortek", Changed().byte(7, 12).as(0x1B));  // a thirteenth month
  ASSERT_EQ(run.samples.size(), 1U);
  EXPECT_FALSE(run.samples[0].time.clock_ns.has_value());
  EXPECT_TRUE(run.samples[0].time.age_ns.has_value());
}

TEST(Nortek, TheLongerHeaderIsRead) {
  EXPECT_NEAR(one(Changed().as(0x1B, 12)).velocity_D_m_s[0], 0.177757, 1e-6);
}

TEST(Nortek, OtherRecordsOfTheFamilyAreIgnored) {
  const ByteVector text = record(0xA0, ByteVector(33, 'x'));  // of an odd number of bytes
  const ByteVector profile = record(0x16, ByteVector(5000, 0xA5), 12);
  const ByteVector nucleus = record(0x1B, data_of(kAfloat), 10, 0x20);
  const Harvest run = decode("nortek", text + profile + nucleus + from_hex(kAfloat));
  EXPECT_EQ(run.totals.frames_ignored, 3U);
  EXPECT_EQ(run.totals.samples, 1U);
  EXPECT_EQ(run.totals.rejected, 0U);
  EXPECT_EQ(run.totals.skipped_bytes, 0U);
}

struct NortekFault {
  const char* name;
  ByteVector bytes;
  RejectReason reason;
};

ByteVector flipped(std::size_t at) {
  ByteVector bytes = from_hex(kAfloat);
  bytes[at] ^= 0x10;
  return bytes;
}

class NortekFaults : public ::testing::TestWithParam<NortekFault> {};

TEST_P(NortekFaults, AreRefusedOnceAndTheNextRecordIsFound) {
  const Harvest run = decode("nortek", GetParam().bytes + from_hex(kAfloat));
  ASSERT_EQ(run.rejected.size(), 1U);
  EXPECT_EQ(run.rejected[0].reason, GetParam().reason);
  EXPECT_EQ(run.rejected[0].offset, 0U);
  EXPECT_EQ(run.totals.samples, 1U);
}

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

INSTANTIATE_TEST_SUITE_P(
    All, NortekFaults,
    ::testing::Values(
        NortekFault{"header", flipped(4), RejectReason::checksum},
        NortekFault{"data", flipped(100), RejectReason::checksum},
        NortekFault{"too_long", record(0x1B, ByteVector(20'000, 0), 12), RejectReason::length},
        NortekFault{"too_short", Changed().size(200).as(0x1B), RejectReason::structure},
        NortekFault{"nearly_empty", record(0x1B, ByteVector(3, 1)), RejectReason::structure},
        NortekFault{"other_version", Changed().byte(0, 3).as(0x1B), RejectReason::structure},
        NortekFault{"data_in_the_head", Changed().byte(1, 20).as(0x1B), RejectReason::structure},
        NortekFault{"data_beyond_the_end", Changed().byte(1, 40).as(0x1B), RejectReason::structure},
        NortekFault{"three_beams", Changed().byte(14, 3).as(0x1B), RejectReason::structure},
        NortekFault{"no_number", Changed().number(kAxes, 0, kNaN).as(0x1B), RejectReason::field},
        NortekFault{"impossible_speed", Changed().number(kBeams, 2, 51.0F).as(0x1B),
                    RejectReason::out_of_range},
        NortekFault{"negative_distance", Changed().number(kBeams + 16, 0, -1.0F).as(0x1B),
                    RejectReason::out_of_range},
        NortekFault{"negative_figure", Changed().number(kAxes + 16, 1, -0.1F).as(0x1B),
                    RejectReason::out_of_range},
        NortekFault{"echo_before_trigger", Changed().number(kAxes + 32, 0, -0.01F).as(0x1B),
                    RejectReason::out_of_range},
        NortekFault{"time_that_is_none", Changed().number(kAxes + 48, 0, kNaN).as(0x1B),
                    RejectReason::field}),
    [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace fathom::codec::nortek_test
