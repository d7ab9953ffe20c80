#include "codec/imu/xsens.hpp"

#include <cmath>
#include <limits>
#include <numbers>
#include <span>

#include <gtest/gtest.h>

#include "base/bytes/big_endian.hpp"
#include "capture.hpp"

namespace fathom::codec::xsens_test {
namespace {

using capture::ByteVector;
using capture::decode;
using capture::Harvest;
using capture::of_kind;
using xsens::Item;

ByteVector operator+(ByteVector a, const ByteVector& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

ByteVector item(std::uint16_t identifier, const ByteVector& data) {
  ByteVector bytes;
  append_be<std::uint16_t>(bytes, identifier);
  bytes.push_back(static_cast<std::uint8_t>(data.size()));
  return bytes + data;
}

ByteVector floats(const std::vector<float>& values) {
  ByteVector bytes;
  for (const float v : values) append_be<float>(bytes, v);
  return bytes;
}

ByteVector counter(std::uint16_t value) {
  ByteVector data;
  append_be<std::uint16_t>(data, value);
  return item(Item::packet_counter, data);
}

ByteVector fine(std::uint32_t ticks) {
  ByteVector data;
  append_be<std::uint32_t>(data, ticks);
  return item(Item::sample_time_fine, data);
}

ByteVector status(std::uint32_t word) {
  ByteVector data;
  append_be<std::uint32_t>(data, word);
  return item(Item::status_word, data);
}

/// A message of any kind, with the longer length where its data ask for it.
ByteVector xsens_message(std::uint8_t message, const ByteVector& data) {
  ByteVector bytes{0xFA, 0xFF, message};
  if (data.size() < 0xFF) {
    bytes.push_back(static_cast<std::uint8_t>(data.size()));
  } else {
    bytes.push_back(0xFF);
    append_be<std::uint16_t>(bytes, static_cast<std::uint16_t>(data.size()));
  }
  bytes = bytes + data;
  bytes.push_back(xsens::checksum(std::span(bytes).subspan(1)));
  return bytes;
}

ByteVector data2(const ByteVector& items) {
  return xsens_message(xsens::kMtData2, items);
}

const ByteVector kForce = item(Item::acceleration, floats({1, 2, 3}));
const ByteVector kRate = item(Item::rate_of_turn, floats({0.5F, -0.25F, 0.125F}));
const ByteVector kIncrements = item(Item::delta_v, floats({0.01F, 0.02F, 0.098F})) +
                               item(Item::delta_q, floats({1, 1e-3F, 2e-3F, 3e-3F}));
const ByteVector kGood = data2(kForce + kRate);

std::vector<ImuSample> imu_of(const Harvest& run) {
  std::vector<ImuSample> out;
  for (const auto& [decoded, sample] : of_kind<ImuSample>(run)) out.push_back(sample);
  return out;
}

TEST(Xsens, AllBytesBehindThePreambleSumUpToNothing) {
  // A recorded request for the configuration: FA FF 0C 00 F5.
  EXPECT_EQ(xsens_message(0x0C, {}), (ByteVector{0xFA, 0xFF, 0x0C, 0x00, 0xF5}));
}

// A message of an MTi-300 and what the maker's MT Manager read from it (recorded by Scottapotamas, xsens-mti,
// mtmanager_packets.md).
TEST(Xsens, ReadsWhatTheMakersProgramReads) {
  const ByteVector payload{
      0x10, 0x20, 0x02, 0x91, 0x8D, 0x10, 0x60, 0x04, 0x01, 0x36, 0x3F, 0xA6, 0x20, 0x10, 0x10, 0x3F, 0x35,
      0xE0, 0x42, 0x3F, 0x31, 0xCD, 0x15, 0xBD, 0x9F, 0x49, 0xDB, 0xBD, 0xA9, 0x38, 0xCF, 0x40, 0x20, 0x0C,
      0xBD, 0x63, 0x5A, 0x90, 0x41, 0x1D, 0x08, 0xD4, 0x3E, 0x5F, 0xAA, 0x50, 0x40, 0x10, 0x0C, 0xB9, 0x11,
      0x68, 0x00, 0x3C, 0xC9, 0x01, 0x00, 0x3A, 0x0F, 0x7D, 0x00, 0x40, 0x30, 0x0C, 0xBC, 0x3B, 0x29, 0x80,
      0x3C, 0x35, 0xFC, 0x00, 0x3C, 0xA4, 0x6E, 0x00, 0x80, 0x20, 0x0C, 0x3C, 0xAE, 0xA2, 0x41, 0xBB, 0x56,
      0xD8, 0x00, 0xBA, 0xD5, 0xAC, 0x01, 0x80, 0x30, 0x10, 0x3F, 0x80, 0x00, 0x00, 0x37, 0xDF, 0x88, 0x01,
      0xB6, 0x89, 0x80, 0x00, 0xB6, 0x08, 0xC0, 0x00, 0xC0, 0x20, 0x0C, 0xBE, 0xFB, 0xFB, 0xF2, 0x3F, 0x33,
      0xC4, 0x85, 0xBF, 0xA0, 0xA2, 0xC1, 0x08, 0x10, 0x04, 0x42, 0x16, 0x80, 0x00, 0x30, 0x10, 0x04, 0x00,
      0x01, 0x86, 0xE1, 0xE0, 0x20, 0x04, 0x00, 0x40, 0x00, 0x03};
  const Harvest run = decode("xsens", data2(payload));
  const auto imu = imu_of(run);
  ASSERT_EQ(imu.size(), 1U);
  const ImuSample& s = imu[0];
  EXPECT_NEAR(s.specific_force_B_m_s2[0], -0.05550629, 1e-8);
  EXPECT_NEAR(s.specific_force_B_m_s2[1], -9.81465530, 1e-8);  // its y is left
  EXPECT_NEAR(s.specific_force_B_m_s2[2], -0.21842313, 1e-8);  // its z is up
  EXPECT_NEAR(s.angular_rate_B_rad_s[0], 0.02131760, 1e-8);
  EXPECT_NEAR(s.angular_rate_B_rad_s[1], 0.00327826, 1e-8);
  EXPECT_NEAR(s.angular_rate_B_rad_s[2], 0.00163019, 1e-8);
  EXPECT_DOUBLE_EQ(s.temperature_degC, 37.625);
  EXPECT_EQ(run.samples[0].time.clock_ns, 20'332'454 * 100'000LL);
  EXPECT_FALSE(run.samples[0].time.utc_ns.has_value());
  EXPECT_FALSE(known(s.delta_time_s));  // of one message alone nobody knows the interval
  EXPECT_FALSE(known(s.delta_angle_B_rad[0]));
}

TEST(Xsens, ReadsEveryNumberFormat) {
  ByteVector fixed12;
  ByteVector fixed16;
  ByteVector doubles;
  for (const double v : {1.0, -2.5, 9.75}) {
    append_be<std::int32_t>(fixed12, static_cast<std::int32_t>(v * 1'048'576.0));
    const double whole = std::floor(v);
    append_be<std::uint32_t>(fixed16, static_cast<std::uint32_t>((v - whole) * 4'294'967'296.0));
    append_be<std::int16_t>(fixed16, static_cast<std::int16_t>(whole));
    append_be<double>(doubles, v);
  }
  const std::vector<ByteVector> forces{
      item(Item::acceleration, floats({1.0F, -2.5F, 9.75F})), item(Item::acceleration | 1, fixed12),
      item(Item::acceleration | 2, fixed16), item(Item::acceleration | 3, doubles)};
  for (const ByteVector& force : forces) {
    const auto imu = imu_of(decode("xsens", data2(force + kRate)));
    ASSERT_EQ(imu.size(), 1U);
    EXPECT_EQ(imu[0].specific_force_B_m_s2, (std::array<double, 3>{1.0, 2.5, -9.75}));
  }
}

TEST(Xsens, TheFrameOfItsOrientationIsNotThatOfItsRates) {
  for (const std::uint16_t frame : {0x0, 0x4, 0x8}) {  // ENU, NED, NWU
    const auto rate = static_cast<std::uint16_t>(Item::rate_of_turn | frame);
    const auto imu = imu_of(decode("xsens", data2(kForce + item(rate, floats({0.5F, -0.25F, 0.125F})))));
    ASSERT_EQ(imu.size(), 1U);
    EXPECT_EQ(imu[0].angular_rate_B_rad_s, (std::array<double, 3>{0.5, 0.25, -0.125}));
  }
}

TEST(Xsens, PrefersTheHighRateOutputs) {
  const auto imu = imu_of(decode("xsens", data2(item(Item::acceleration_hr, floats({4, 5, 6})) + kForce +
                                                kRate + item(Item::rate_of_turn_hr, floats({1, 1, 1})))));
  ASSERT_EQ(imu.size(), 1U);
  EXPECT_EQ(imu[0].specific_force_B_m_s2, (std::array<double, 3>{4, -5, -6}));
  EXPECT_EQ(imu[0].angular_rate_B_rad_s, (std::array<double, 3>{1, -1, -1}));
}

TEST(Xsens, IncrementsAloneGiveRatesFromTheSecondMessageOn) {
  const Harvest run = decode("xsens", data2(counter(0xFFFF) + fine(1000) + kIncrements) +
                                          data2(counter(0) + fine(1100) + kIncrements));
  EXPECT_EQ(run.totals.frames_ignored, 1U);
  const auto imu = imu_of(run);
  ASSERT_EQ(imu.size(), 1U);
  const ImuSample& s = imu[0];
  EXPECT_NEAR(s.delta_time_s, 0.01, 1e-15);
  EXPECT_NEAR(s.delta_angle_B_rad[0], 2e-3, 2e-8);
  EXPECT_NEAR(s.delta_angle_B_rad[1], -4e-3, 4e-8);
  EXPECT_NEAR(s.angular_rate_B_rad_s[2], -0.6, 6e-6);
  EXPECT_NEAR(s.delta_velocity_B_m_s[2], -0.098, 1e-8);
  EXPECT_NEAR(s.specific_force_B_m_s2[2], -9.8, 1e-6);
}

TEST(Xsens, TheIntervalOfIncrementsIsKnownOnlyWhereNoMessageWasLost) {
  const ByteVector all = kForce + kRate + kIncrements;
  struct Case {
    const char* name;
    ByteVector between;
    ByteVector last;
    bool known;
  };
  const std::vector<Case> cases{{"next", {}, counter(8) + fine(1100) + all, true},
                                {"one lost", {}, counter(9) + fine(1200) + all, false},
                                {"one of another kind between, sampled before", data2(counter(8) + fine(900)),
                                 counter(9) + fine(1100) + all, true},
                                {"no counter", {}, fine(1100) + all, false},
                                {"no clock", {}, counter(8) + all, false},
                                {"clock stepped back", {}, counter(8) + fine(900) + all, false},
                                {"longer than a second", {}, counter(8) + fine(11'100) + all, false}};
  for (const Case& c : cases) {
    const auto imu =
        imu_of(decode("xsens", data2(counter(7) + fine(1000) + all) + c.between + data2(c.last)));
    ASSERT_EQ(imu.size(), 2U) << c.name;
    EXPECT_FALSE(known(imu[0].delta_time_s)) << c.name;
    EXPECT_EQ(known(imu[1].delta_time_s), c.known) << c.name;
    EXPECT_EQ(known(imu[1].delta_angle_B_rad[0]), c.known) << c.name;
    EXPECT_EQ(imu[1].specific_force_B_m_s2, (std::array<double, 3>{1, -2, -3})) << c.name;
    if (c.known) {
      EXPECT_NEAR(imu[1].delta_time_s, 0.01, 1e-15) << c.name;
    }
  }
}

TEST(Xsens, TurnsInCoarseStepsAreUsedOnlyWhereThereIsNoRate) {
  ByteVector turn;
  for (const int step : {1'048'576, 10, -20, 30}) append_be<std::int32_t>(turn, step);
  const ByteVector increments =
      item(Item::delta_v, floats({0.01F, 0.02F, 0.098F})) + item(Item::delta_q | 1, turn);
  for (const bool with_rate : {false, true}) {
    const ByteVector more = with_rate ? kForce + kRate : ByteVector{};
    const auto imu = imu_of(decode("xsens", data2(counter(1) + fine(100) + increments + more) +
                                                data2(counter(2) + fine(200) + increments + more)));
    ASSERT_FALSE(imu.empty());
    EXPECT_EQ(known(imu.back().delta_time_s), !with_rate);
    EXPECT_NEAR(imu.back().angular_rate_B_rad_s[0], with_rate ? 0.5 : 20.0 / 1'048'576.0 / 0.01, 1e-9);
  }
}

TEST(Xsens, TheClockGoesOnWhereItsBitsBeginAgain) {
  const Harvest run =
      decode("xsens", data2(fine(0xFFFF'FFF0U) + kForce + kRate) + data2(fine(0x54U) + kForce + kRate));
  ASSERT_EQ(run.samples.size(), 2U);
  EXPECT_EQ(*run.samples[1].time.clock_ns - *run.samples[0].time.clock_ns, 100 * 100'000);
}

TEST(Xsens, UtcOnlyWhenItSaysThatItIsValid) {
  for (const std::uint8_t flags : {0x00, 0x03, 0x37}) {
    const ByteVector utc{0x07, 0x44, 0x0B, 0xE0, 0x07, 0xE3, 0x01, 0x14, 0x0D, 0x2F, 0x18, flags};
    const Harvest run = decode("xsens", data2(item(Item::utc_time, utc) + kForce + kRate));
    ASSERT_EQ(run.samples.size(), 1U);
    ASSERT_EQ(run.samples[0].time.utc_ns.has_value(), flags == 0x37);
    if (flags == 0x37) {
      EXPECT_EQ(to_iso8601(*run.samples[0].time.utc_ns, 4), "2019-01-20T13:47:24.1219Z");
    }
  }
}

TEST(Xsens, AnAxisThatWasClippedIsUnknown) {
  // From a recording of a unit that was shaken: accelerometer z and gyro y.
  const auto imu = imu_of(decode("xsens", data2(kForce + kRate + status(0x0048'1401))));
  ASSERT_EQ(imu.size(), 1U);
  EXPECT_EQ(imu[0].specific_force_B_m_s2[0], 1.0);
  EXPECT_EQ(imu[0].specific_force_B_m_s2[1], -2.0);
  EXPECT_FALSE(known(imu[0].specific_force_B_m_s2[2]));
  EXPECT_EQ(imu[0].angular_rate_B_rad_s[0], 0.5);
  EXPECT_FALSE(known(imu[0].angular_rate_B_rad_s[1]));
  EXPECT_EQ(imu[0].angular_rate_B_rad_s[2], -0.125);
}

TEST(Xsens, MessagesWithoutBothTriadsAreIgnored) {
  const Harvest run = decode("xsens", data2(kForce) + data2(kRate) + data2({}) + xsens_message(0x42, {1}) +
                                          xsens_message(0x0D, ByteVector(1000, 0)));
  EXPECT_EQ(run.totals.samples, 0U);
  EXPECT_EQ(run.totals.frames_ignored, 5U);
  EXPECT_EQ(run.totals.rejected, 0U);
}

TEST(Xsens, AnExtendedMessageIsReadLikeAShortOne) {
  const auto filler = item(0x7030, ByteVector(200, 0)) + item(0x7020, ByteVector(200, 0));
  const Harvest run = decode("xsens", data2(filler + kForce + kRate));
  EXPECT_EQ(run.totals.samples, 1U);
  EXPECT_EQ(run.totals.skipped_bytes, 0U);
}

/// The first item GNSS PVT Data of a recording (einride, xsens-go, testdata 1).
ByteVector pvt() {
  return {0x02, 0xF5, 0xC9, 0x2A, 0x07, 0xE3, 0x01, 0x14, 0x0D, 0x2F, 0x18, 0x37, 0x00, 0x00, 0x00, 0x05,
          0x0E, 0xE3, 0x2A, 0x24, 0x03, 0x01, 0x0B, 0x00, 0x07, 0x15, 0x22, 0xE8, 0x22, 0x61, 0x2F, 0x55,
          0x00, 0x01, 0x3F, 0x71, 0x00, 0x00, 0xA9, 0x2A, 0x00, 0x00, 0x08, 0xD3, 0x00, 0x00, 0x08, 0x18,
          0xFF, 0xFF, 0xFF, 0xE5, 0x00, 0x00, 0x00, 0x0A, 0xFF, 0xFF, 0xFF, 0xFE, 0x00, 0x00, 0x00, 0x1D,
          0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x01, 0x5E, 0x00, 0xE5, 0x51, 0x9A, 0x00, 0x02, 0x00, 0x00,
          0x00, 0x9A, 0x00, 0x8B, 0x00, 0x44, 0x00, 0x70, 0x00, 0x53, 0x00, 0x37, 0x00, 0x3E};
}
ByteVector changed(ByteVector bytes, std::size_t at, std::uint8_t value) {
  bytes.at(at) = value;
  return bytes;
}
ByteVector fix_of(const ByteVector& fields) {
  return item(Item::gnss_pvt, fields);
}
constexpr std::size_t kMonthAt = 6;
constexpr std::size_t kValidAt = 11;
constexpr std::size_t kFlagsAt = 21;
constexpr std::size_t kLatitudeAt = 28;  // its highest byte; 0x22 of it are 57.7 degrees

TEST(XsensFix, ReadsTheFieldsOfTheReceiver) {
  const Harvest run = decode("xsens", data2(fix_of(pvt()) + fine(51'704'404)));
  ASSERT_EQ(run.samples.size(), 1U);
  EXPECT_EQ(to_iso8601(*run.samples[0].time.utc_ns, 9), "2019-01-20T13:47:24.249768484Z");
  EXPECT_FALSE(run.samples[0].time.clock_ns.has_value());
  const auto& s = std::get<GpsSample>(run.samples[0].sample);
  constexpr double kRad = std::numbers::pi / 180.0;
  EXPECT_EQ(s.fix, GpsFix::fix_3d);
  EXPECT_EQ(s.satellites, 11);
  EXPECT_NEAR(s.latitude_rad, 57.6794453 * kRad, 1e-14);
  EXPECT_NEAR(s.longitude_rad, 11.8825704 * kRad, 1e-14);
  EXPECT_NEAR(s.altitude_m, 81.777, 1e-9);
  EXPECT_NEAR(s.altitude_msl_m, 43.306, 1e-9);
  EXPECT_NEAR(s.position_sigma_N_m[0], 2.259 / std::numbers::sqrt2, 1e-9);
  EXPECT_NEAR(s.position_sigma_N_m[1], 2.259 / std::numbers::sqrt2, 1e-9);
  EXPECT_NEAR(s.position_sigma_N_m[2], 2.072, 1e-9);
  EXPECT_NEAR(s.velocity_N_m_s[0], -0.027, 1e-9);
  EXPECT_NEAR(s.velocity_N_m_s[1], 0.010, 1e-9);
  EXPECT_NEAR(s.velocity_N_m_s[2], -0.002, 1e-9);
  EXPECT_NEAR(s.velocity_sigma_N_m_s[2], 0.350, 1e-9);
  EXPECT_NEAR(s.hdop, 0.83, 1e-9);
}

TEST(XsensFix, ComesAfterTheInertialDataOfItsMessage) {
  const Harvest run = decode("xsens", data2(fix_of(pvt()) + kForce + kRate));
  ASSERT_EQ(run.samples.size(), 2U);
  EXPECT_TRUE(std::holds_alternative<ImuSample>(run.samples[0].sample));
  EXPECT_TRUE(std::holds_alternative<GpsSample>(run.samples[1].sample));
}

TEST(XsensFix, HasNoPositionOutsideOfItsLimits) {
  const Harvest run = decode("xsens", data2(fix_of(changed(pvt(), kFlagsAt, 0))));
  ASSERT_EQ(run.samples.size(), 1U);
  const auto& s = std::get<GpsSample>(run.samples[0].sample);
  EXPECT_EQ(s.fix, GpsFix::none);
  EXPECT_EQ(s.satellites, 11);
  EXPECT_FALSE(known(s.latitude_rad));
  EXPECT_FALSE(known(s.velocity_N_m_s[0]));
  EXPECT_FALSE(known(s.hdop));
}

TEST(XsensFix, TimeOnlyWhenFullyResolved) {
  for (const std::uint8_t valid : {0x00, 0x03, 0x37}) {
    const Harvest run = decode("xsens", data2(fix_of(changed(pvt(), kValidAt, valid))));
    ASSERT_EQ(run.samples.size(), 1U);
    EXPECT_EQ(run.samples[0].time.utc_ns.has_value(), valid == 0x37);
  }
}

TEST(XsensFix, AnImpossibleOneIsRefusedAndIsNoneBesideGoodInertialData) {
  ByteVector cut = pvt();
  cut.pop_back();
  const std::vector<std::pair<ByteVector, RejectReason>> faults{
      {changed(pvt(), kLatitudeAt, 0x7F), RejectReason::out_of_range},
      {changed(pvt(), kMonthAt, 13), RejectReason::out_of_range},
      {changed(pvt(), kFlagsAt, 0xC1), RejectReason::field},
      {cut, RejectReason::structure}};
  for (const auto& [fields, reason] : faults) {
    const Harvest alone = decode("xsens", data2(fix_of(fields)));
    EXPECT_EQ(alone.totals.samples, 0U);
    ASSERT_EQ(alone.rejected.size(), 1U);
    EXPECT_EQ(alone.rejected[0].reason, reason);

    const Harvest kept = decode("xsens", data2(fix_of(fields) + kForce + kRate));
    EXPECT_EQ(of_kind<ImuSample>(kept).size(), 1U);
    const auto fixes = of_kind<GpsSample>(kept);
    ASSERT_EQ(fixes.size(), 1U);
    EXPECT_EQ(fixes[0].second.fix, GpsFix::none) << "which is seen";
    EXPECT_FALSE(known(fixes[0].second.latitude_rad));
    EXPECT_EQ(kept.totals.rejected, 0U);
  }
}

TEST(XsensFix, IsKeptWhereTheInertialDataCannotBe) {
  const Harvest run =
      decode("xsens", data2(item(Item::acceleration, floats({0, 500, 0})) + kRate + fix_of(pvt())));
  EXPECT_EQ(of_kind<GpsSample>(run).size(), 1U);
  EXPECT_EQ(run.totals.samples, 1U);
  EXPECT_EQ(run.totals.rejected, 0U);
}

struct XsensFault {
  const char* name;
  ByteVector bytes;
  RejectReason reason;
};

class XsensFaults : public ::testing::TestWithParam<XsensFault> {};

TEST_P(XsensFaults, AreRefusedOnceAndTheNextMessageIsFound) {
  const Harvest run = decode("xsens", GetParam().bytes + kGood);
  ASSERT_EQ(run.rejected.size(), 1U);
  EXPECT_EQ(run.rejected[0].reason, GetParam().reason);
  EXPECT_EQ(run.rejected[0].offset, 0U);
  EXPECT_EQ(run.totals.samples, 1U);
}

ByteVector damaged() {
  auto bytes = kGood;
  bytes[10] ^= 0x40U;
  return bytes;
}

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
const auto kUtcOfMonth13 = item(Item::utc_time, {0, 0, 0, 0, 0x07, 0xE3, 13, 1, 0, 0, 0, 0x07});

INSTANTIATE_TEST_SUITE_P(
    All, XsensFaults,
    ::testing::Values(
        XsensFault{"checksum", damaged(), RejectReason::checksum},
        XsensFault{"too_long", {0xFA, 0xFF, 0x36, 0xFF, 0x08, 0x01}, RejectReason::length},
        XsensFault{"item_beyond_the_end", data2({0x40, 0x20, 0x0C, 0, 0}), RejectReason::structure},
        XsensFault{"item_of_two_bytes", data2({0x40, 0x20}), RejectReason::structure},
        XsensFault{"two_numbers", data2(item(Item::acceleration, floats({1, 2})) + kRate),
                   RejectReason::structure},
        XsensFault{"floats_said_to_be_doubles",
                   data2(item(Item::acceleration | 3, floats({1, 2, 3})) + kRate), RejectReason::structure},
        XsensFault{"not_a_number", data2(item(Item::rate_of_turn, floats({0, kNan, 0})) + kForce),
                   RejectReason::field},
        XsensFault{"impossible_rate", data2(item(Item::rate_of_turn, floats({0, 0, 60})) + kForce),
                   RejectReason::out_of_range},
        XsensFault{"impossible_force", data2(item(Item::acceleration, floats({0, 500, 0})) + kRate),
                   RejectReason::out_of_range},
        XsensFault{"no_turn", data2(item(Item::delta_q, floats({0.9F, 0, 0, 0})) + kForce + kRate),
                   RejectReason::out_of_range},
        XsensFault{"impossible_temperature", data2(item(Item::temperature, floats({1000})) + kForce + kRate),
                   RejectReason::out_of_range},
        XsensFault{"month_13", data2(kUtcOfMonth13 + kForce + kRate), RejectReason::out_of_range}),
    [](const auto& info) { return std::string(info.param.name); });

TEST(Xsens, CutMessageAtTheEndIsTruncated) {
  auto bytes = kGood;
  bytes.resize(bytes.size() - 3);
  const Harvest run = decode("xsens", bytes);
  ASSERT_EQ(run.rejected.size(), 1U);
  EXPECT_EQ(run.rejected[0].reason, RejectReason::truncated);
}

}  // namespace
}  // namespace fathom::codec::xsens_test
