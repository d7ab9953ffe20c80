// Reports of gpsd: a stream of a real one, and what it may not make us believe.

#include <cmath>
#include <fstream>
#include <iterator>
#include <string>

#include <gtest/gtest.h>

#include "base/units.hpp"
#include "support/codec/decode_run.hpp"
#include "support/paths.hpp"

namespace fathom::test {
namespace {

DecodeRun run_of(const std::string& text) {
  return decode_whole("gpsd", ByteVector(text.begin(), text.end()), {});
}

const GpsSample& fix_of(const codec::Decoded& decoded) {
  return std::get<GpsSample>(decoded.sample);
}

std::string report(const std::string& rest, const std::string& device = "/dev/a") {
  return R"({"class":"TPV","device":")" + device + R"(",)" + rest + "}\r\n";
}
constexpr const char* kGood =
    R"("mode":3,"time":"2026-05-01T10:00:00.000Z","lat":-33.5,"lon":151.25,"altHAE":33.5)";

// Forty seconds of a receiver that speaks NMEA 0183, as gpsd 3.22 told them.
TEST(Gpsd, AStreamOfARealOneIsReadWhole) {
  std::ifstream in(vectors_dir() + "/gpsd/simulated.gpsd");
  const DecodeRun run = run_of({std::istreambuf_iterator<char>(in), {}});
  EXPECT_TRUE(run.rejected.empty());
  ASSERT_EQ(run.samples.size(), 40U) << "one of each second, however often it is repeated";
  int fixes = 0;
  for (std::size_t i = 0; i < run.samples.size(); ++i) {
    const GpsSample& fix = fix_of(run.samples[i]);
    const auto second = static_cast<double>(i);
    EXPECT_EQ(*run.samples[i].time.utc_ns,
              *from_civil({2026, 5, 1, 10, 0, 0}) + static_cast<TimeNs>(i) * kNsPerSecond);
    if (i >= 10 && i < 13) {
      EXPECT_EQ(fix.fix, GpsFix::none);
      EXPECT_FALSE(known(fix.latitude_rad));
      continue;
    }
    ++fixes;
    EXPECT_NEAR(fix.latitude_rad / kRadPerDeg, -33.5 + 2e-5 * second, 1e-9);
    EXPECT_NEAR(fix.longitude_rad / kRadPerDeg, 151.25 + 1e-5 * second, 1e-9);
    EXPECT_NEAR(std::hypot(fix.velocity_N_m_s[0], fix.velocity_N_m_s[1]), 4.5 * 1852.0 / 3600.0, 1e-3);
    EXPECT_NEAR(std::atan2(fix.velocity_N_m_s[1], fix.velocity_N_m_s[0]) / kRadPerDeg, 23.45, 1e-3);
    EXPECT_FALSE(known(fix.velocity_sigma_N_m_s[0])) << "48 m/s are no figure of the velocity";
    if (i < 3) continue;  // until gpsd knows which sentence ends a second
    EXPECT_NEAR(fix.altitude_m, 33.5 + 0.1 * second, 1e-3);
    EXPECT_NEAR(fix.altitude_msl_m, 12.5 + 0.1 * second, 1e-3);
    if (i != 13) {  // after the gap gpsd told the fix before its GST
      EXPECT_NEAR(fix.position_sigma_N_m[0], 0.011, 1e-9) << "of the GST";
      EXPECT_NEAR(fix.position_sigma_N_m[1], 0.012, 1e-9);
    }
    EXPECT_NEAR(fix.hdop, 0.9, 1e-9);
    EXPECT_EQ(fix.satellites, 4);
    EXPECT_EQ(fix.fix, i > 30 ? GpsFix::rtk_fixed : GpsFix::fix_3d) << i;
  }
  EXPECT_EQ(fixes, 37);
}

TEST(Gpsd, OneReceiverCounts) {
  const DecodeRun run =
      run_of(report(kGood) +
             report(R"("mode":3,"time":"2026-05-01T10:00:00.500Z","lat":10.0,"lon":10.0)", "/dev/b") +
             report(R"("mode":3,"time":"2026-05-01T10:00:01.000Z","lat":-33.5,"lon":151.25)"));
  ASSERT_EQ(run.samples.size(), 2U);
  EXPECT_NEAR(fix_of(run.samples[1]).latitude_rad / kRadPerDeg, -33.5, 1e-12);
}

TEST(Gpsd, WithoutSigmasOfItsOwnThoseOfGpsdCount) {
  const DecodeRun run = run_of(
      report(std::string(kGood) + R"(,"epx":3.0,"epy":4.0,"epv":9.0,"track":90,"speed":2.0,"eps":0.3)"));
  ASSERT_EQ(run.samples.size(), 1U);
  const GpsSample& fix = fix_of(run.samples[0]);
  EXPECT_EQ(fix.position_sigma_N_m, (std::array<double, 3>{4.0, 3.0, 9.0})) << "north, east, down";
  EXPECT_NEAR(fix.velocity_N_m_s[1], 2.0, 1e-12);
  EXPECT_NEAR(fix.velocity_sigma_N_m_s[0], 0.3, 1e-12);
  EXPECT_FALSE(known(fix.velocity_N_m_s[2])) << "nothing was said of climbing";
  EXPECT_FALSE(known(fix.altitude_msl_m));
}

TEST(Gpsd, WhatCannotBeIsRefusedWithAReason) {
  const auto reason = [](const std::string& rest) {
    const DecodeRun run = run_of(report(rest));
    EXPECT_TRUE(run.samples.empty()) << rest;
    return run.rejected.empty() ? std::optional<codec::RejectReason>() : run.rejected.front().reason;
  };
  using codec::RejectReason;
  EXPECT_EQ(reason(R"("mode":3,"time":"2026-05-01T10:00:00Z","lat":91.0,"lon":0.0)"),
            RejectReason::out_of_range);
  EXPECT_EQ(reason(R"("mode":3,"time":"2026-05-01T10:00:00Z","lat":1.0)"), RejectReason::incomplete);
  EXPECT_EQ(reason(R"("mode":3,"time":"2026-05-01T10:00:00Z","lat":"1.0","lon":0.0)"), RejectReason::field);
  EXPECT_EQ(reason(R"("mode":3,"time":"yesterday","lat":1.0,"lon":0.0)"), RejectReason::field);
  EXPECT_EQ(reason(R"("mode":3,"time":"2026-05-01T10:00:00Z","lat":1.0,"lon":0.0,"speed":900.0,"track":0)"),
            RejectReason::out_of_range);
  EXPECT_EQ(reason(R"("mode":3,"lat":1.0,"lon":0.0)"), std::nullopt) << "a fix of no instant is of no use";
  EXPECT_EQ(run_of("{\"class\":3}\r\n").rejected.size(), 1U);
  EXPECT_EQ(run_of("{\"no\":\"class\"}\r\n").rejected.size(), 1U);
  EXPECT_EQ(run_of("{\"class\":\"VERSION\",\"release\":\"3.22\"}\r\n").rejected.size(), 0U);
}

}  // namespace
}  // namespace fathom::test
