#include <cmath>
#include <cstdio>
#include <random>
#include <sstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "exchange/track.hpp"

namespace fathom::exchange {
namespace {

using ::testing::HasSubstr;

std::vector<std::string> sentences(const Track& track) {
  std::ostringstream out;
  write_nmea(out, track);
  std::vector<std::string> lines;
  std::istringstream in(out.str());
  for (std::string line; std::getline(in, line);) lines.push_back(line + "\n");
  return lines;
}

void expect_sound(const std::string& line) {
  EXPECT_LE(line.size(), 82U) << line;
  ASSERT_TRUE(line.starts_with("$IN") && line.ends_with("\r\n")) << line;
  const std::size_t star = line.find('*');
  ASSERT_EQ(star + 5, line.size()) << line;
  unsigned sum = 0;
  for (const char c : line.substr(1, star - 1)) sum ^= static_cast<unsigned char>(c);
  EXPECT_EQ(sum, std::stoul(line.substr(star + 1, 2), nullptr, 16)) << line;
}

TEST(Nmea, APointIsWrittenAsItStands) {
  Point p;
  p.utc_ns = *from_civil({2026, 1, 31, 12, 0, 5, 250'000'000});
  p.latitude_deg = -47.5;
  p.longitude_deg = 8.25;
  p.altitude_m = -12.5;
  p.velocity_N_m_s = {0.0, -1.0, 0.0};
  p.heading_deg = 271.5;
  p.sigma_N_m = {1.0, 2.0, 3.0};
  const auto lines = sentences({"nav", {p}});
  ASSERT_EQ(lines.size(), 5U);
  EXPECT_THAT(lines[0], HasSubstr("$INGGA,120005.250,4730.00000,S,00815.00000,E,6,,,-12.50,M,0.00,M,,*"));
  EXPECT_THAT(lines[1], HasSubstr("$INRMC,120005.250,A,4730.00000,S,00815.00000,E,1.944,270.00,310126,,,E*"));
  EXPECT_THAT(lines[2], HasSubstr("$INVTG,270.00,T,,M,1.944,N,3.600,K,E*"));
  EXPECT_THAT(lines[3], HasSubstr("$INGST,120005.250,,,,,1.000,2.000,3.000*"));
  EXPECT_THAT(lines[4], HasSubstr("$INHDT,271.50,T*"));
  for (const auto& line : lines) expect_sound(line);
}

TEST(Nmea, MinutesNeverReadSixtyAndNothingIsTooLong) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> wide(-1e9, 1e9);
  for (int i = 0; i < 3000; ++i) {
    Point p;
    p.utc_ns = static_cast<TimeNs>(random() % 4'000'000'000ULL) * kNsPerSecond + 999'999'999;
    p.latitude_deg = i % 3 == 0 ? 59.99999999999 : std::fmod(wide(random), 90.0);
    p.longitude_deg = i % 3 == 1 ? -179.9999999999 : std::fmod(wide(random), 180.0);
    p.altitude_m = i % 5 == 0 ? kUnknown : std::fmod(wide(random), 99999.0);
    p.altitude_msl_m = i % 7 == 0 ? p.altitude_m + 999.0 : kUnknown;
    for (double& v : p.velocity_N_m_s) v = i % 11 == 0 ? kUnknown : std::fmod(wide(random), 1e4);
    p.heading_deg = i % 2 == 0 ? kUnknown : 359.99999;
    p.sigma_N_m = {std::fmod(std::abs(wide(random)), 1e6), 1e9, 1e-9};
    p.satellites = i % 4 == 0 ? -1 : static_cast<int>(random() % 200);
    for (const auto& line : sentences({"nav", {p}})) {
      expect_sound(line);
      EXPECT_EQ(line.find("nan"), std::string::npos);
      if (line.starts_with("$INGGA")) {
        double latitude = 0.0;
        ASSERT_EQ(std::sscanf(line.c_str(), "$INGGA,%*[0-9.],%lf,", &latitude), 1) << line;
        const double minutes = std::fmod(latitude, 100.0);
        EXPECT_LT(minutes, 60.0) << line;
        EXPECT_NEAR(std::floor(latitude / 100.0) + minutes / 60.0, std::abs(p.latitude_deg), 1e-7);
      }
    }
  }
}

TEST(GeoJson, ALineIsCutAtTheAntimeridian) {
  Track track{"nav", {}};
  for (int i = 0; i < 4; ++i) {
    Point p;
    p.utc_ns = i * kNsPerSecond;
    p.latitude_deg = i;
    p.longitude_deg = wrapped_longitude_deg(178.5 + i);
    p.altitude_m = 10.0 * i;
    track.points.push_back(p);
  }
  std::ostringstream out;
  write_geojson(out, {track});
  EXPECT_THAT(out.str(), HasSubstr("[179.500000000,1.000000000,10.000],[180.000000000,1.500000000,15.000]]"));
  EXPECT_THAT(out.str(),
              HasSubstr("[[-180.000000000,1.500000000,15.000],[-179.500000000,2.000000000,20.000]"));
}

TEST(Tracks, AGapPartsThem) {
  Track track{"nav", {}};
  for (const int second : {0, 1, 2, 20, 21}) {
    track.points.emplace_back();
    track.points.back().utc_ns = second * kNsPerSecond;
  }
  const auto parts = stretches(track);
  ASSERT_EQ(parts.size(), 2U);
  EXPECT_EQ(parts[0].end, 3U);
  EXPECT_EQ(parts[1].begin, 3U);
  EXPECT_EQ(parts[1].end, 5U);
  EXPECT_EQ(wrapped_longitude_deg(180.0), -180.0);
  EXPECT_EQ(wrapped_longitude_deg(-190.0), 170.0);
}

}  // namespace
}  // namespace fathom::exchange
