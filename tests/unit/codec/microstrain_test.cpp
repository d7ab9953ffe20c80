#include "codec/imu/microstrain.hpp"

#include <functional>
#include <limits>
#include <span>

#include <gtest/gtest.h>

#include "base/bytes/big_endian.hpp"
#include "capture.hpp"
#include "codec/fletcher.hpp"

namespace fathom::codec::microstrain_test {
namespace {

using capture::ByteVector;
using capture::decode;
using capture::Harvest;
using capture::of_kind;
using microstrain::Field;

constexpr double kG = 9.80665;

ByteVector operator+(ByteVector a, const ByteVector& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

ByteVector bytes_of_hex(std::string_view hex) {
  ByteVector bytes;
  for (std::size_t i = 0; i + 1 < hex.size(); i += 2) {
    bytes.push_back(static_cast<std::uint8_t>(std::stoi(std::string(hex.substr(i, 2)), nullptr, 16)));
  }
  return bytes;
}

ByteVector field(std::uint8_t descriptor, const ByteVector& data) {
  return ByteVector{static_cast<std::uint8_t>(data.size() + 2), descriptor} + data;
}

ByteVector floats(std::uint8_t descriptor, const std::array<float, 3>& values) {
  ByteVector data;
  for (const float v : values) append_be<float>(data, v);
  return field(descriptor, data);
}

template <class T>
ByteVector number(std::uint8_t descriptor, T value) {
  ByteVector data;
  append_be<T>(data, value);
  return field(descriptor, data);
}

ByteVector packet(const ByteVector& fields, std::uint8_t set = microstrain::kSensorData) {
  ByteVector bytes = ByteVector{0x75, 0x65, set, static_cast<std::uint8_t>(fields.size())} + fields;
  const auto sum = fletcher8(bytes);
  return bytes + ByteVector{sum[0], sum[1]};
}

ByteVector clock_ms(std::uint64_t ms) {
  return number<std::uint64_t>(Field::reference_time, ms * 1'000'000);
}
ByteVector delta_ms(std::uint64_t ms) {
  return number<std::uint64_t>(Field::reference_time_delta, ms * 1'000'000);
}

ByteVector gps(std::uint8_t descriptor, double time_of_week_s, std::uint16_t week, std::uint16_t flags) {
  ByteVector data;
  append_be<double>(data, time_of_week_s);
  append_be<std::uint16_t>(data, week);
  append_be<std::uint16_t>(data, flags);
  return field(descriptor, data);
}

const ByteVector kForce = floats(Field::scaled_accel, {0.5F, -0.25F, -1.0F});
const ByteVector kRate = floats(Field::scaled_gyro, {0.125F, -0.5F, 0.25F});
const ByteVector kIncrements = floats(Field::delta_theta, {0.001F, -0.002F, 0.003F}) +
                               floats(Field::delta_velocity, {0.0F, 0.001F, -0.01F});
const ByteVector kGood = packet(kForce + kRate);

std::vector<ImuSample> imu_of(const Harvest& run) {
  std::vector<ImuSample> out;
  for (const auto& [decoded, sample] : of_kind<ImuSample>(run)) out.push_back(sample);
  return out;
}

TEST(MicroStrain, ChecksumOfTheMakersPing) {
  // 7565 0102 0201 E0C6 of the maker's manuals: command set 0x01, ping.
  EXPECT_EQ(packet({0x02, 0x01}, 0x01), (ByteVector{0x75, 0x65, 0x01, 0x02, 0x02, 0x01, 0xE0, 0xC6}));
}

struct RecordedPacket {
  const char* hex;
  std::int64_t clock_ns;
  std::array<double, 3> accel_g;
  std::array<double, 3> gyro_rad_s;
};

// Packets 1, 6 and 7 of test/data/mip_data.bin in LORD-MicroStrain/mip_sdk, as that kit's own decoder reads
// them.
TEST(MicroStrain, ReadsWhatTheMakersKitReads) {
  const std::vector<RecordedPacket> recorded{{"756580300AD500000041D8BAE0400AD600000000007A12000E043C8EAF72BB"
                                              "DA6818BF7C52E80E05BB469CCF39A34C8BBB8BE12FD771",
                                              282'809'000'000,
                                              {0.0174176432, -0.00666524097, -0.985640049},
                                              {-0.00303058675, 0.000311468117, -0.00426878734}},
                                             {"7565804C0AD500000041DA2916400AD600000000007A12000E043C896897BB"
                                              "D28544BF7C30F90E05BB4AA21F3A86A43ABB8F0313"
                                              "0E063D7AFFD63E919FE83E79FFD60E0CBCCC20783CB6C513BF95119D7AC2",
                                              282'833'000'000,
                                              {0.0167735051, -0.00642457791, -0.985122263},
                                              {-0.00309193856, 0.0010272332, -0.00436438015}},
                                             {"756580300AD500000041DAA328400AD600000000007A12000E043C8FA7BABB"
                                              "DC65DABF7C1C640E05BB56BB793A70DED8BB8E5C7AA119",
                                              282'841'000'000,
                                              {0.0175360329, -0.00672600884, -0.984808207},
                                              {-0.0032765551, 0.000918847974, -0.00434452016}}};
  for (const RecordedPacket& one : recorded) {
    const Harvest run = decode("microstrain", bytes_of_hex(one.hex));
    const auto imu = imu_of(run);
    ASSERT_EQ(imu.size(), 1U);
    EXPECT_EQ(run.samples[0].time.clock_ns, one.clock_ns);
    EXPECT_FALSE(run.samples[0].time.utc_ns.has_value());
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_NEAR(imu[0].specific_force_B_m_s2[i] / kG, one.accel_g[i], 1e-9);
      EXPECT_NEAR(imu[0].angular_rate_B_rad_s[i], one.gyro_rad_s[i], 1e-11);
    }
    EXPECT_FALSE(known(imu[0].delta_time_s));
  }
}

// The packet of the kit's packet_example.cpp, recorded after a pause: its increments over 5.608 s are its
// rate and force, within what the unit moved.
TEST(MicroStrain, ReadsAPacketWithIncrementsOfALongPause) {
  const Harvest run =
      decode("microstrain",
             bytes_of_hex(
                 "7565804C0AD5000000055EE67CC00AD6000000014E434A000E043D9EE88D387FDB00BF7AAF03"
                 "0E05BB0C1E30BB572E68BBAA24AE0E07BC8AAC80BC72C50EBCC4E2C10E083EEE3D9FBD66DADDC0AFDEF59196"));
  const auto imu = imu_of(run);
  ASSERT_EQ(imu.size(), 1U);
  EXPECT_EQ(run.samples[0].time.clock_ns, 23'067'000'000);
  const std::array<double, 3> accel_g{0.077592, 0.000061, -0.979233};
  const std::array<double, 3> gyro_rad_s{-0.002138, -0.003283, -0.005192};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(imu[0].specific_force_B_m_s2[i] / kG, accel_g[i], 6e-7);
    EXPECT_NEAR(imu[0].angular_rate_B_rad_s[i], gyro_rad_s[i], 6e-7);
  }
  EXPECT_FALSE(known(imu[0].delta_time_s));  // longer than a second, and nothing before it
}

TEST(MicroStrain, TheReferenceTimeDeltaIsTheIntervalOfTheIncrements) {
  const auto one = [](std::uint64_t ms, std::uint64_t passed_ms) {
    return packet(clock_ms(ms) + delta_ms(passed_ms) + kForce + kRate + kIncrements);
  };
  // Between the third and the fourth one was lost. The fifth comes after a pause.
  const auto imu = imu_of(
      decode("microstrain", one(100, 10) + one(110, 10) + one(120, 10) + one(140, 10) + one(540, 400)));
  ASSERT_EQ(imu.size(), 5U);
  EXPECT_FALSE(known(imu[0].delta_time_s));
  EXPECT_FALSE(known(imu[0].delta_angle_B_rad[0]));
  for (std::size_t k = 1; k < 5; ++k) {
    EXPECT_NEAR(imu[k].delta_time_s, k < 4 ? 0.01 : 0.4, 1e-12) << k;
    EXPECT_NEAR(imu[k].delta_angle_B_rad[1], -0.002, 1e-9);
    EXPECT_NEAR(imu[k].delta_velocity_B_m_s[2], -0.01 * kG, 1e-7);
    EXPECT_EQ(imu[k].angular_rate_B_rad_s, (std::array<double, 3>{0.125, -0.5, 0.25}));
  }
}

TEST(MicroStrain, ADeltaThatOtherPacketsHaveAsWellIsNotTheInterval) {
  ByteVector stream;
  for (std::uint64_t ms = 100; ms < 200; ms += 5) {  // increments in each second packet
    stream = stream + packet(clock_ms(ms) + delta_ms(5) + kForce + kRate +
                             (ms % 10 == 0 ? kIncrements : ByteVector{}));
  }
  const auto imu = imu_of(decode("microstrain", stream));
  ASSERT_EQ(imu.size(), 20U);
  EXPECT_FALSE(known(imu[2].delta_time_s));
  for (std::size_t k = 4; k < 20; k += 2) EXPECT_NEAR(imu[k].delta_time_s, 0.01, 1e-12) << k;
}

TEST(MicroStrain, WithoutADeltaASteadyClockIsTheInterval) {
  const auto with_clock = [](std::uint64_t ms) {
    return packet(clock_ms(ms) + kForce + kRate + kIncrements);
  };
  const auto with_gps = [](std::uint64_t ms) {
    return packet(gps(Field::gps_timestamp, 1e-3 * static_cast<double>(ms), 0, 0x0000) + kForce + kRate +
                  kIncrements);
  };
  const auto with_delta = [last = std::uint64_t{0}](std::uint64_t ms) mutable {
    const double passed_s = 1e-3 * static_cast<double>(ms - last);
    last = ms;
    return packet(number<double>(Field::delta_time, passed_s) + kForce + kRate + kIncrements);
  };
  const std::vector<std::function<ByteVector(std::uint64_t)>> kinds{with_clock, with_gps, with_delta};
  for (std::size_t kind = 0; kind < kinds.size(); ++kind) {
    SCOPED_TRACE(kind);
    // One is lost before 150; the clock steps by half a second after 160; from then on it is twice as quick.
    ByteVector stream;
    for (const std::uint64_t ms : {100, 110, 120, 130, 150, 160, 670, 675, 680, 685}) {
      stream = stream + kinds[kind](ms);
    }
    const auto imu = imu_of(decode("microstrain", stream));
    ASSERT_EQ(imu.size(), 10U);
    const std::vector<double> expected_s{0, 0, 0.01, 0.01, 0, 0.01, 0, 0, 0.005, 0.005};
    for (std::size_t k = 0; k < expected_s.size(); ++k) {
      if (expected_s[k] > 0.0) {
        EXPECT_NEAR(imu[k].delta_time_s, expected_s[k], 1e-9) << k;
        EXPECT_TRUE(known(imu[k].delta_angle_B_rad[0])) << k;
      } else {
        EXPECT_FALSE(known(imu[k].delta_time_s)) << k;
        EXPECT_FALSE(known(imu[k].delta_angle_B_rad[0])) << k;
      }
    }
  }
}

TEST(MicroStrain, IncrementsAloneGiveRates) {
  const Harvest run = decode("microstrain", packet(clock_ms(100) + delta_ms(10) + kIncrements) +
                                                packet(clock_ms(110) + delta_ms(10) + kIncrements));
  EXPECT_EQ(run.totals.frames_ignored, 1U);
  const auto imu = imu_of(run);
  ASSERT_EQ(imu.size(), 1U);
  EXPECT_NEAR(imu[0].angular_rate_B_rad_s[2], 0.3, 1e-7);
  EXPECT_NEAR(imu[0].specific_force_B_m_s2[2], -kG, 1e-6);
}

TEST(MicroStrain, UtcOnlyWhenItsFlagsSayThatItIsValid) {
  struct Case {
    std::uint8_t descriptor;
    std::uint16_t flags;
    bool valid;
  };
  const std::vector<Case> cases{
      {Field::shared_gps_timestamp, 0x0003, true},  {Field::shared_gps_timestamp, 0x0001, false},
      {Field::shared_gps_timestamp, 0x0002, false}, {Field::shared_gps_timestamp, 0x0000, false},
      {Field::gps_timestamp, 0x001F, true},         {Field::gps_timestamp, 0x001D, true},
      {Field::gps_timestamp, 0x0005, true},   // of a unit that has no more flags
      {Field::gps_timestamp, 0x000D, false},  // the week is not valid
      {Field::gps_timestamp, 0x0015, false},  // nor is the time of week
      {Field::gps_timestamp, 0x001E, false},  // no pulse per second
      {Field::gps_timestamp, 0x0001, false},        {Field::gps_timestamp, 0x0000, false}};
  for (const Case& c : cases) {
    // Week 2238 began on 27 November 2022, 18 s before UTC did.
    const Harvest run =
        decode("microstrain", packet(gps(c.descriptor, 3600.125, 2238, c.flags) + kForce + kRate));
    ASSERT_EQ(run.samples.size(), 1U);
    const DeviceTime& time = run.samples[0].time;
    ASSERT_EQ(time.utc_ns.has_value(), c.valid) << int{c.descriptor} << ' ' << c.flags;
    if (c.valid) {
      EXPECT_EQ(to_iso8601(*time.utc_ns, 3), "2022-11-27T00:59:42.125Z");
    }
    // Its differences are those of a clock in any case.
    EXPECT_EQ(time.clock_ns, 2238 * 604'800'000'000'000LL + 3'600'125'000'000LL);
  }
}

TEST(MicroStrain, TheReferenceTimeIsTheOnlyClockOfAUnitThatHasIt) {
  const auto time = gps(Field::shared_gps_timestamp, 10.0, 2238, 0x0003);
  const Harvest run =
      decode("microstrain", packet(time + clock_ms(5) + kForce + kRate) + packet(time + kForce + kRate));
  ASSERT_EQ(run.samples.size(), 2U);
  EXPECT_EQ(run.samples[0].time.clock_ns, 5'000'000);
  EXPECT_TRUE(run.samples[0].time.utc_ns.has_value());
  EXPECT_FALSE(run.samples[1].time.clock_ns.has_value());
  EXPECT_TRUE(run.samples[1].time.utc_ns.has_value());
}

TEST(MicroStrain, AGpsTimeThatCannotBeIsNoClockWhereItIsNotSaidToBeValid) {
  for (const auto& [time_of_week_s, week] : std::vector<std::pair<double, std::uint16_t>>{
           {std::numeric_limits<double>::quiet_NaN(), 0}, {-1.0, 0}, {1e10, 0}, {0.0, 65'535}}) {
    const Harvest run =
        decode("microstrain", packet(gps(Field::gps_timestamp, time_of_week_s, week, 0) + kForce + kRate));
    ASSERT_EQ(run.samples.size(), 1U);
    EXPECT_FALSE(run.samples[0].time.clock_ns.has_value());
  }
}

TEST(MicroStrain, AnAxisThatWasOverItsRangeIsUnknown) {
  // Accelerometer y and gyro z; the magnetometer does not matter.
  const auto overrange = number<std::uint16_t>(Field::overrange_status, 0x0742);
  const auto all = delta_ms(10) + kForce + kRate + kIncrements;
  const auto imu = imu_of(decode("microstrain", packet(all) + packet(all + overrange)));
  ASSERT_EQ(imu.size(), 2U);
  EXPECT_TRUE(known(imu[0].specific_force_B_m_s2[1]));
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(known(imu[1].specific_force_B_m_s2[i]), i != 1);
    EXPECT_EQ(known(imu[1].delta_velocity_B_m_s[i]), i != 1);
    EXPECT_EQ(known(imu[1].angular_rate_B_rad_s[i]), i != 2);
    EXPECT_EQ(known(imu[1].delta_angle_B_rad[i]), i != 2);
  }
}

TEST(MicroStrain, OtherPacketsAreIgnored) {
  const auto event = field(Field::event_source, {1});
  const auto scheduled = field(Field::event_source, {0});
  const Harvest run =
      decode("microstrain", packet(kForce) + packet(kRate) + packet({}) + packet(event + kForce + kRate) +
                                packet({0x00, 0xFF}, 0x82) + packet({0x04, 0xF1, 0x06, 0x00}, 0x01) +
                                packet(scheduled + kForce + kRate));
  EXPECT_EQ(run.totals.samples, 1U);
  EXPECT_EQ(run.totals.frames_ignored, 6U);
  EXPECT_EQ(run.totals.rejected, 0U);
}

TEST(MicroStrain, FieldsThatNobodyReadsDoNotMatter) {
  const auto filler = field(0x09, ByteVector(36, 0xFF)) + field(0xFE, {}) + field(0x40, ByteVector(10, 0));
  EXPECT_EQ(decode("microstrain", packet(filler + kForce + filler + kRate)).totals.samples, 1U);
}

struct MicroStrainFault {
  const char* name;
  ByteVector bytes;
  RejectReason reason;
};

class MicroStrainFaults : public ::testing::TestWithParam<MicroStrainFault> {};

TEST_P(MicroStrainFaults, AreRefusedOnceAndTheNextPacketIsFound) {
  const Harvest run = decode("microstrain", GetParam().bytes + kGood);
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
constexpr double kInfinity = std::numeric_limits<double>::infinity();

INSTANTIATE_TEST_SUITE_P(
    All, MicroStrainFaults,
    ::testing::Values(
        MicroStrainFault{"checksum", damaged(), RejectReason::checksum},
        MicroStrainFault{"field_beyond_the_end", packet({0x0E, 0x04, 0, 0}), RejectReason::structure},
        MicroStrainFault{"field_of_one_byte", packet(kForce + kRate + ByteVector{0x01}),
                         RejectReason::structure},
        MicroStrainFault{"field_without_length", packet(kForce + ByteVector{0x00, 0x05} + kRate),
                         RejectReason::structure},
        MicroStrainFault{"two_numbers", packet(field(Field::scaled_gyro, ByteVector(8, 0)) + kForce),
                         RejectReason::structure},
        MicroStrainFault{"short_clock",
                         packet(field(Field::reference_time, ByteVector(4, 0)) + kForce + kRate),
                         RejectReason::structure},
        MicroStrainFault{"not_a_number", packet(floats(Field::scaled_gyro, {0, kNan, 0}) + kForce),
                         RejectReason::field},
        MicroStrainFault{"impossible_rate", packet(floats(Field::scaled_gyro, {0, 0, 60}) + kForce),
                         RejectReason::out_of_range},
        MicroStrainFault{"impossible_force", packet(floats(Field::scaled_accel, {0, 110, 0}) + kRate),
                         RejectReason::out_of_range},
        MicroStrainFault{"impossible_turn", packet(floats(Field::delta_theta, {60, 0, 0}) + kForce + kRate),
                         RejectReason::out_of_range},
        MicroStrainFault{"clock_of_centuries",
                         packet(number<std::uint64_t>(Field::reference_time, 1ULL << 62) + kForce + kRate),
                         RejectReason::out_of_range},
        MicroStrainFault{"delta_of_infinity",
                         packet(number<double>(Field::delta_time, kInfinity) + kForce + kRate),
                         RejectReason::field},
        MicroStrainFault{"valid_time_of_another_week",
                         packet(gps(Field::shared_gps_timestamp, 604'801.0, 2238, 3) + kForce + kRate),
                         RejectReason::out_of_range},
        MicroStrainFault{"valid_time_that_is_no_number",
                         packet(gps(Field::shared_gps_timestamp, kInfinity, 2238, 3) + kForce + kRate),
                         RejectReason::field},
        MicroStrainFault{"valid_week_of_centuries",
                         packet(gps(Field::shared_gps_timestamp, 1.0, 65'535, 3) + kForce + kRate),
                         RejectReason::out_of_range}),
    [](const auto& info) { return std::string(info.param.name); });

TEST(MicroStrain, CutPacketAtTheEndIsTruncated) {
  auto bytes = kGood;
  bytes.resize(bytes.size() - 3);
  const Harvest run = decode("microstrain", bytes);
  ASSERT_EQ(run.rejected.size(), 1U);
  EXPECT_EQ(run.rejected[0].reason, RejectReason::truncated);
}

}  // namespace
}  // namespace fathom::codec::microstrain_test
