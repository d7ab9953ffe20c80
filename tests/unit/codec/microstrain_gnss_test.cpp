// The satellite receivers of MicroStrain units: packets laid by hand.
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "base/bytes/big_endian.hpp"
#include "base/units.hpp"
#include "capture.hpp"
#include "codec/fletcher.hpp"

namespace fathom::codec::microstrain_gnss_test {
namespace {

using capture::ByteVector;
using capture::decode;
using capture::Harvest;
using capture::of_kind;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr float kNanF = std::numeric_limits<float>::quiet_NaN();

ByteVector operator+(ByteVector a, const ByteVector& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

ByteVector packet(const ByteVector& fields, std::uint8_t set = 0x91) {
  ByteVector bytes = ByteVector{0x75, 0x65, set, static_cast<std::uint8_t>(fields.size())} + fields;
  const auto sum = fletcher8(bytes);
  return bytes + ByteVector{sum[0], sum[1]};
}

struct Place {
  double latitude_deg = -36.5;
  double longitude_deg = 127.25;
  double height_m = 44.5;
  double height_msl_m = 18.25;
  float horizontal_m = 1.5F;
  float vertical_m = 2.5F;
  std::uint16_t flags = 0x001F;
};
ByteVector place(const Place& p = {}) {
  ByteVector out{44, 0x03};
  for (const double v : {p.latitude_deg, p.longitude_deg, p.height_m, p.height_msl_m})
    append_be<double>(out, v);
  append_be<float>(out, p.horizontal_m);
  append_be<float>(out, p.vertical_m);
  append_be<std::uint16_t>(out, p.flags);
  return out;
}

ByteVector motion(std::uint16_t flags = 0x003F, float north = 1.5F, float heading_deg = -90.0F,
                  float accuracy = 0.125F) {
  ByteVector out{36, 0x05};
  for (const float v : {north, -0.5F, 0.25F, 1.6F, 1.58F, heading_deg, accuracy, 3.0F})
    append_be<float>(out, v);
  append_be<std::uint16_t>(out, flags);
  return out;
}

ByteVector fix_info(std::uint8_t type, std::uint8_t satellites = 17, std::uint16_t corrections = 0,
                    std::uint16_t valid = 7) {
  ByteVector out{8, 0x0B, type, satellites};
  append_be<std::uint16_t>(out, corrections);
  append_be<std::uint16_t>(out, valid);
  return out;
}

/// 2026-09-19, a Saturday: week 2436 began on the 13th.
ByteVector gps_time(double time_of_week_s = 556'233.25, std::uint16_t week = 2436, std::uint16_t flags = 3) {
  ByteVector out{14, 0x09};
  append_be<double>(out, time_of_week_s);
  append_be<std::uint16_t>(out, week);
  append_be<std::uint16_t>(out, flags);
  return out;
}

ByteVector utc(std::uint16_t flags = 3, std::uint8_t month = 9, std::uint32_t millisecond = 250,
               std::uint8_t second = 15) {
  ByteVector out{15, 0x08, 0x07, 0xEA, month, 19, 10, 30, second};
  append_be<std::uint32_t>(out, millisecond);
  append_be<std::uint16_t>(out, flags);
  return out;
}

ByteVector dilution(float hdop = 0.75F, std::uint16_t flags = 0x007F) {
  ByteVector out{32, 0x07};
  for (const float v : {1.75F, 1.5F, hdop, 1.25F, 1.0F, 0.5F, 0.5F}) append_be<float>(out, v);
  append_be<std::uint16_t>(out, flags);
  return out;
}

GpsSample fix_of(const ByteVector& fields) {
  const auto found = of_kind<GpsSample>(decode("microstrain", packet(fields)));
  if (found.size() != 1) throw std::runtime_error("not one fix");
  return found[0].second;
}

std::optional<TimeNs> utc_of(const ByteVector& fields) {
  return decode("microstrain", packet(fields)).samples.at(0).time.utc_ns;
}

TEST(MicroStrainGnss, OnePacketIsOneFix) {
  for (const std::uint8_t set : {0x81, 0x91}) {
    const auto bytes = packet(gps_time() + fix_info(0) + place() + motion() + dilution(), set);
    const Harvest run = decode("microstrain", bytes);
    const auto found = of_kind<GpsSample>(run);
    ASSERT_EQ(found.size(), 1U);
    const auto& [decoded, s] = found[0];
    EXPECT_EQ(s.fix, GpsFix::fix_3d);
    EXPECT_EQ(s.satellites, 17);
    EXPECT_DOUBLE_EQ(s.latitude_rad, -36.5 * kRadPerDeg);
    EXPECT_DOUBLE_EQ(s.longitude_rad, 127.25 * kRadPerDeg);
    EXPECT_EQ(s.altitude_m, 44.5);
    EXPECT_EQ(s.altitude_msl_m, 18.25);
    EXPECT_EQ(s.position_sigma_N_m, (std::array<double, 3>{1.5, 1.5, 2.5}));
    EXPECT_EQ(s.velocity_N_m_s, (std::array<double, 3>{1.5, -0.5, 0.25}));
    EXPECT_EQ(s.velocity_sigma_N_m_s, (std::array<double, 3>{0.125, 0.125, 0.125}));
    EXPECT_DOUBLE_EQ(s.course_rad, 270.0 * kRadPerDeg);
    EXPECT_EQ(s.hdop, 0.75);
    ASSERT_TRUE(decoded.time.utc_ns.has_value());
    EXPECT_EQ(to_iso8601(*decoded.time.utc_ns, 3), "2026-09-19T10:30:15.250Z");
    EXPECT_FALSE(decoded.time.clock_ns.has_value());
    EXPECT_EQ(decoded.length, bytes.size());
  }
}

TEST(MicroStrainGnss, TheTypeIsThatOfTheFixInfo) {
  struct Case {
    std::uint8_t type;
    std::uint16_t corrections;
    GpsFix fix;
  };
  for (const Case& c : {Case{0, 0, GpsFix::fix_3d},
                        {0, 1, GpsFix::differential},
                        {0, 2, GpsFix::differential},
                        {1, 2, GpsFix::fix_2d},
                        {2, 0, GpsFix::time_only},
                        {3, 0, GpsFix::none},
                        {4, 0, GpsFix::none},
                        {5, 0, GpsFix::rtk_float},
                        {6, 0, GpsFix::rtk_fixed},
                        {7, 0, GpsFix::differential}}) {
    const GpsSample s = fix_of(place() + motion() + dilution() + fix_info(c.type, 4, c.corrections));
    EXPECT_EQ(s.fix, c.fix) << int{c.type};
    EXPECT_EQ(s.satellites, 4);
    const bool fixed = c.fix >= GpsFix::dead_reckoning;
    EXPECT_EQ(known(s.latitude_rad), fixed) << int{c.type};
    EXPECT_EQ(known(s.velocity_N_m_s[0]), fixed) << int{c.type};
    EXPECT_EQ(known(s.altitude_m), fixed) << int{c.type};
  }
  EXPECT_EQ(fix_of(place() + fix_info(0, 4, 2, 0x3)).fix, GpsFix::fix_3d);  // corrections not valid
  EXPECT_EQ(fix_of(place() + fix_info(0, 4, 0, 0x5)).satellites, -1);
  EXPECT_EQ(fix_of(place() + fix_info(99, 4, 0, 0x6)).fix, GpsFix::none);  // a type that does not count
}

TEST(MicroStrainGnss, FlagsSayWhatIsKnown) {
  const GpsSample no_place = fix_of(place({.latitude_deg = kNan, .flags = 0x1E}) + motion() + fix_info(0));
  EXPECT_EQ(no_place.fix, GpsFix::none);
  EXPECT_FALSE(known(no_place.altitude_m));
  EXPECT_EQ(no_place.satellites, 17);
  const GpsSample flat = fix_of(place({.height_m = kNan, .height_msl_m = 1e9, .vertical_m = -1, .flags = 9}));
  EXPECT_EQ(flat.fix, GpsFix::fix_2d);  // no fix info: the flags of the position decide
  EXPECT_FALSE(known(flat.altitude_m) || known(flat.altitude_msl_m) || known(flat.position_sigma_N_m[2]));
  EXPECT_EQ(flat.position_sigma_N_m[0], 1.5);
  EXPECT_EQ(fix_of(place()).fix, GpsFix::fix_3d);
  EXPECT_EQ(fix_of(place({.flags = 0})).fix, GpsFix::none);
  const GpsSample still = fix_of(place() + motion(0x0001, 1.5F, kNanF, kNanF) + dilution(kNanF, 0x7B));
  EXPECT_EQ(still.velocity_N_m_s[0], 1.5);
  EXPECT_FALSE(known(still.course_rad) || known(still.velocity_sigma_N_m_s[0]) || known(still.hdop));
  EXPECT_FALSE(known(fix_of(place() + motion(0x003E, kNanF)).velocity_N_m_s[1]));
  EXPECT_FALSE(known(fix_of(place({.horizontal_m = 0.0F})).position_sigma_N_m[0]));
}

TEST(MicroStrainGnss, TimeIsThatOfTheReceiver) {
  EXPECT_EQ(to_iso8601(utc_of(place() + utc()).value(), 3), "2026-09-19T10:30:15.250Z");
  EXPECT_EQ(utc_of(place() + utc(3, 9, 500) + gps_time()), utc_of(place() + gps_time()));
  EXPECT_EQ(utc_of(place() + gps_time(kNan, 2436, 0) + utc()), utc_of(place() + utc()));
  EXPECT_FALSE(utc_of(place()));
  EXPECT_FALSE(utc_of(place() + gps_time(1.0, 2436, 1)));  // its week is not known
  EXPECT_FALSE(utc_of(place() + utc(1)));                  // nor the leap seconds
  EXPECT_FALSE(utc_of(place() + utc(0, 13)));
  EXPECT_FALSE(utc_of(place() + utc(3, 9, 250, 60)));  // the leap second itself
}

TEST(MicroStrainGnss, TheSecondReceiverCountsWhereThereIsNoOther) {
  const auto of_set = [](std::uint8_t set, std::uint8_t satellites) {
    return packet(place() + fix_info(0, satellites), set);
  };
  const auto satellites_of = [](const ByteVector& bytes) {
    std::vector<int> out;
    for (const auto& [decoded, s] : of_kind<GpsSample>(decode("microstrain", bytes)))
      out.push_back(s.satellites);
    return out;
  };
  EXPECT_EQ(satellites_of(of_set(0x92, 1) + of_set(0x92, 2) + of_set(0x92, 3)), (std::vector<int>{2, 3}));
  EXPECT_EQ(satellites_of(of_set(0x92, 1) + of_set(0x91, 2) + of_set(0x92, 3) + of_set(0x91, 4)),
            (std::vector<int>{2, 4}));
  EXPECT_EQ(satellites_of(of_set(0x92, 1) + of_set(0x92, 2) + of_set(0x81, 3) + of_set(0x92, 4)),
            (std::vector<int>{2, 3}));
  const Harvest others = decode(
      "microstrain", of_set(0x82, 1) + of_set(0x90, 2) + of_set(0x93, 3) + of_set(0x94, 4) + of_set(0x95, 5));
  EXPECT_EQ(others.totals.samples, 0U);
  EXPECT_EQ(others.totals.frames_ignored, 5U);
}

TEST(MicroStrainGnss, PacketsWithoutAPositionAreIgnoredAndInertialOnesGoOn) {
  ByteVector inertial;
  for (const std::uint8_t descriptor : {0x04, 0x05}) {
    inertial = inertial + ByteVector{14, descriptor};
    for (const float v : {0.0F, 0.25F, -1.0F}) append_be<float>(inertial, v);
  }
  const Harvest run = decode("microstrain", packet(inertial, 0x80) + packet(place() + fix_info(3)) +
                                                packet(motion() + fix_info(0)) + packet({}) +
                                                packet(ByteVector{3, 0xD0, 1} + place()) +  // of an event
                                                packet({3, 0x0C, 1}) + packet(inertial, 0x80));
  EXPECT_EQ(of_kind<ImuSample>(run).size(), 2U);
  ASSERT_EQ(of_kind<GpsSample>(run).size(), 1U);
  EXPECT_EQ(of_kind<GpsSample>(run)[0].second.fix, GpsFix::none);
  EXPECT_EQ(run.totals.frames_ignored, 4U);
  EXPECT_EQ(run.totals.rejected + run.totals.skipped_bytes, 0U);
}

struct GnssFault {
  const char* name;
  ByteVector fields;
  RejectReason reason;
};

class MicroStrainGnssFaults : public ::testing::TestWithParam<GnssFault> {};

TEST_P(MicroStrainGnssFaults, AreRefusedOnceAndTheNextPacketIsFound) {
  const Harvest run = decode("microstrain", packet(GetParam().fields) + packet(place()));
  ASSERT_EQ(run.rejected.size(), 1U);
  EXPECT_EQ(run.rejected[0].reason, GetParam().reason);
  EXPECT_EQ(run.rejected[0].length, GetParam().fields.size() + 6);
  EXPECT_EQ(run.totals.samples, 1U);
  EXPECT_EQ(run.totals.skipped_bytes, 0U);
}

constexpr auto kRange = RejectReason::out_of_range;

INSTANTIATE_TEST_SUITE_P(
    All, MicroStrainGnssFaults,
    ::testing::Values(
        GnssFault{"latitude", place({.latitude_deg = 90.001}), kRange},
        GnssFault{"longitude", place({.longitude_deg = -180.5}), kRange},
        GnssFault{"latitude_no_number", place({.latitude_deg = kNan}), RejectReason::field},
        GnssFault{"height", place({.height_m = 2e5}), kRange},
        GnssFault{"height_no_number", place({.height_msl_m = kNan}), RejectReason::field},
        GnssFault{"negative_accuracy", place({.vertical_m = -1.0F}), kRange},
        GnssFault{"velocity_no_number", place() + motion(1, kNanF), RejectReason::field},
        GnssFault{"velocity", place() + motion(1, 2e4F), kRange},
        GnssFault{"heading", place() + motion(8, 0.0F, 361.0F), kRange},
        GnssFault{"negative_dilution", place() + dilution(-1.0F), kRange},
        GnssFault{"type_of_fix", place() + fix_info(8), RejectReason::field},
        GnssFault{"time_of_another_week", place() + gps_time(604'801.0), kRange},
        GnssFault{"month", place() + utc(3, 13), kRange},
        GnssFault{"millisecond", place() + utc(3, 9, 1'000), kRange},
        GnssFault{"position_cut", ByteVector{43, 0x03} + ByteVector(41, 0), RejectReason::structure},
        GnssFault{"velocity_cut", place() + ByteVector{3, 0x05, 0}, RejectReason::structure},
        GnssFault{"fix_info_cut", place() + ByteVector{7, 0x0B, 0, 0, 0, 0, 0}, RejectReason::structure},
        GnssFault{"dilution_cut", place() + ByteVector{3, 0x07, 0}, RejectReason::structure},
        GnssFault{"utc_cut", place() + ByteVector{3, 0x08, 0}, RejectReason::structure},
        GnssFault{"time_cut", place() + ByteVector{3, 0x09, 0}, RejectReason::structure},
        GnssFault{"field_beyond_the_end", place() + ByteVector{9, 0x0B}, RejectReason::structure}),
    [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace fathom::codec::microstrain_gnss_test
