// The sentences that a vehicle says while it runs: what stands in them, and that others and we can read them.

#include "exchange/nmea/sentences.hpp"

#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/units.hpp"
#include "codec/registry.hpp"

namespace fathom::exchange::nmea {
namespace {

using ::testing::StartsWith;

void expect_sound(const std::string& line) {
  EXPECT_LE(line.size(), 82U) << line;
  ASSERT_TRUE(line.starts_with("$") && line.ends_with("\r\n")) << line;
  const std::size_t star = line.find('*');
  ASSERT_EQ(star + 5, line.size()) << line;
  unsigned sum = 0;
  for (const char c : line.substr(1, star - 1)) sum ^= static_cast<unsigned char>(c);
  EXPECT_EQ(sum, std::stoul(line.substr(star + 1, 2), nullptr, 16)) << line;
  EXPECT_EQ(line.find("nan"), std::string::npos) << line;
  EXPECT_EQ(line.find("inf"), std::string::npos) << line;
}

Point somewhere() {
  Point p;
  p.utc_ns = *from_civil({2026, 2, 3, 4, 5, 6, 700'000'000});
  p.latitude_deg = 60.0 + 1.0 / 6.0;
  p.longitude_deg = -5.25;
  p.altitude_m = 3.21;
  p.velocity_N_m_s = {0.0, 1.0, 0.5};
  p.sigma_N_m = {0.5, 0.6, 0.7};
  p.quality = Quality::fix_3d;
  return p;
}

TEST(Sentences, SayWhatStandsInThem) {
  const Point p = somewhere();
  EXPECT_THAT(gga("IN", p), StartsWith("$INGGA,040506.700,6010.00000,N,00515.00000,W,1,,,3.21,M,0.00,M,,*"));
  EXPECT_THAT(rmc("GP", p, Validity::valid),
              StartsWith("$GPRMC,040506.700,A,6010.00000,N,00515.00000,W,1.944,90.00,030226,,,A*"));
  EXPECT_THAT(hdt("IN", -0.001), StartsWith("$INHDT,0.00,T*"));
  EXPECT_THAT(hdt("IN", -90.0), StartsWith("$INHDT,270.00,T*"));
  EXPECT_THAT(zda("IN", p.utc_ns), StartsWith("$INZDA,040506.700,03,02,2026,00,00*"));
  EXPECT_THAT(dpt("IN", 12.345, 30.0), StartsWith("$INDPT,12.35,30.00,*"));
  EXPECT_THAT(vbw("IN", 1852.0 / 3600.0, -1852.0 / 7200.0), StartsWith("$INVBW,,,V,1.000,-0.500,A,,V,,V*"));
  EXPECT_THAT(rot("IN", -12.5), StartsWith("$INROT,-12.50,A*"));
  Uncertainty u;
  u.utc_ns = p.utc_ns;
  u.mode = 'D';
  u.aligned = true;
  u.radius_95_m = 12.345;
  u.down_sigma_m = 0.5;
  u.velocity_sigma_m_s = 0.02;
  u.heading_sigma_deg = 0.25;
  u.tilt_sigma_deg = 0.05;
  u.depth_m = 30.0;
  u.gps_outage_s = 601.4;
  u.resets = 1003;
  EXPECT_THAT(pfthm(u), StartsWith("$PFTHM,040506.700,D,A,12.35,0.50,0.020,0.250,0.050,30.00,601,3*"));
}

TEST(Sentences, WhatIsUnknownIsEmptyAndDeclaredInvalid) {
  Point p;
  p.utc_ns = somewhere().utc_ns;
  p.quality = Quality::none;
  EXPECT_THAT(gga("IN", p), StartsWith("$INGGA,040506.700,,,,,0,,,,M,,M,,*"));
  EXPECT_THAT(rmc("IN", p, Validity::not_valid), StartsWith("$INRMC,040506.700,V,,,,,,,030226,,,N*"));
  EXPECT_THAT(vtg("IN", p), StartsWith("$INVTG,,T,,M,,N,,K,N*"));
  EXPECT_THAT(hdt("IN", kUnknown), StartsWith("$INHDT,,T*"));
  EXPECT_THAT(rot("IN", kUnknown), StartsWith("$INROT,,V*"));
  EXPECT_THAT(vbw("IN", kUnknown, 1.0), StartsWith("$INVBW,,,V,,1.944,V,,V,,V*"));
  EXPECT_THAT(pfthm({}), StartsWith("$PFTHM,000000.000,N,V,,,,,,,,0*"));
}

// However large or odd the values are.
TEST(Sentences, NoneIsTooLongOrBroken) {
  std::mt19937_64 random(7);
  const std::vector<double> odd{kUnknown,
                                std::numeric_limits<double>::infinity(),
                                -std::numeric_limits<double>::infinity(),
                                0.0,
                                -0.0,
                                1e300,
                                -1e300,
                                999.995,
                                -999.995,
                                99998.99,
                                -99998.99,
                                359.99999,
                                -180.0,
                                1e-300};
  const auto any = [&] {
    return random() % 2 == 0 ? odd[random() % odd.size()]
                             : std::uniform_real_distribution<double>(-2e5, 2e5)(random);
  };
  for (int i = 0; i < 5000; ++i) {
    Point p = somewhere();
    p.utc_ns = static_cast<TimeNs>(random() % 4'000'000'000ULL) * kNsPerSecond + 999'999'999;
    p.altitude_m = any();
    p.altitude_msl_m = any();
    p.velocity_N_m_s = {any(), any(), any()};
    p.sigma_N_m = {any(), any(), any()};
    p.satellites = static_cast<int>(random() % 1000);
    const Uncertainty u{p.utc_ns, 'A', true, any(), any(), any(), any(), any(), any(), any(), 4'294'967'295U};
    for (const std::string& line :
         {gga("IN", p), rmc("IN", p, Validity::valid), vtg("IN", p), gst("IN", p), hdt("IN", any()),
          zda("IN", p.utc_ns), dpt("IN", any(), any()), vbw("IN", any(), any()), rot("IN", any()), pfthm(u)})
      expect_sound(line);
  }
}

/// Samples that our own reader makes of a text.
std::vector<AnySample> read(const std::string& text) {
  struct Kept final : codec::Sink {
    void on_sample(const codec::Decoded& decoded) override { samples.push_back(decoded.sample); }
    void on_rejected(const codec::Rejected& /*rejected*/) override { ++rejected; }
    std::vector<AnySample> samples;
    int rejected = 0;
  } kept;
  const auto reader = codec::find_protocol("nmea0183")->make({});
  reader->feed({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}, kept);
  reader->finish(kept);
  EXPECT_EQ(kept.rejected, 0) << text;
  return kept.samples;
}

TEST(Sentences, OurOwnReaderFindsThePositionAgain) {
  const Point p = somewhere();
  const auto samples =
      read(gga("GP", p) + rmc("GP", p, Validity::valid) + vtg("GP", p) + hdt("IN", 123.45) +
           dpt("IN", 12.5, 0.0) + zda("GP", p.utc_ns) + pfthm({}) + rot("IN", 1.0) + vbw("IN", 1.0, 0.0));
  bool fix = false;
  bool heading = false;
  for (const AnySample& sample : samples) {
    if (const auto* gps = std::get_if<GpsSample>(&sample)) {
      fix = true;
      EXPECT_NEAR(gps->latitude_rad, p.latitude_deg * kRadPerDeg, 2e-9);
      EXPECT_NEAR(gps->longitude_rad, p.longitude_deg * kRadPerDeg, 2e-9);
    } else if (const auto* compass = std::get_if<HeadingSample>(&sample)) {
      heading = true;
      EXPECT_NEAR(compass->heading_rad, 123.45 * 0.017453292519943295, 1e-9);
    }
  }
  EXPECT_TRUE(fix);
  EXPECT_TRUE(heading);
}

}  // namespace
}  // namespace fathom::exchange::nmea
