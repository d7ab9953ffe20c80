// Pressure to depth, Paroscientific, and the ASCII line.

#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "base/units.hpp"
#include "codec/depth/pressure.hpp"
#include "nmea_text.hpp"

namespace fathom::codec {
namespace {

using test::decode_text;
using test::DecodeRun;

constexpr double kDecibar = 1e4;

TEST(Pressure, CheckValueOfTheUnescoReport) {
  EXPECT_NEAR(depth_from_pressure(10'000.0 * kDecibar, 30.0 * kRadPerDeg), 9712.653, 5e-4);
}

TEST(Pressure, TableOfTheUnescoReport) {
  // Depth in metres by pressure in decibar and latitude, to the table's printed 0.01 m.
  struct Row {
    double dbar, at_0, at_30, at_60, at_90;
  };
  for (const Row& row :
       {Row{500.0, 496.65, 496.00, 494.69, 494.03}, Row{1000.0, 992.12, 990.81, 988.19, 986.88},
        Row{5000.0, 4915.04, 4908.56, 4895.60, 4889.13}, Row{10000.0, 9725.47, 9712.65, 9687.04, 9674.23}}) {
    const double pascal = row.dbar * kDecibar;
    EXPECT_NEAR(depth_from_pressure(pascal, 0.0), row.at_0, 0.02) << row.dbar;
    EXPECT_NEAR(depth_from_pressure(pascal, 30.0 * kRadPerDeg), row.at_30, 0.02) << row.dbar;
    EXPECT_NEAR(depth_from_pressure(pascal, -60.0 * kRadPerDeg), row.at_60, 0.02) << row.dbar;
    EXPECT_NEAR(depth_from_pressure(pascal, 90.0 * kRadPerDeg), row.at_90, 0.02) << row.dbar;
  }
}

TEST(Pressure, TheInverseIsOne) {
  for (const double latitude_deg : {0.0, 36.4, -77.0, 90.0}) {
    for (const double depth_m : {-5.0, 0.0, 0.01, 50.0, 1000.0, 11'900.0}) {
      const double pascal = pressure_from_depth(depth_m, latitude_deg * kRadPerDeg);
      EXPECT_NEAR(depth_from_pressure(pascal, latitude_deg * kRadPerDeg), depth_m, 1e-6);
    }
  }
}

RejectReason refused(std::string_view protocol, std::string_view text, const CodecOptions& options = {}) {
  const DecodeRun run = decode_text(protocol, text, options);
  EXPECT_EQ(run.rejected.size(), 1U) << text;
  EXPECT_TRUE(run.samples.empty()) << text;
  return run.rejected.empty() ? RejectReason::truncated : run.rejected[0].reason;
}

TEST(Paroscientific, PsiToPascalToDepth) {
  const DecodeRun run = decode_text("paroscientific", "*00012991.11891\r\n*0001P4=16.7509,23.01532\r\n");
  const auto depth = run.all<DepthSample>();
  ASSERT_EQ(depth.size(), 2U);
  EXPECT_NEAR(depth[0].pressure_Pa, 2991.11891 * 6894.757, 1.0);
  EXPECT_NEAR(depth[0].depth_m, depth_from_pressure(2991.11891 * 6894.757 - 101'325.0, 0.0), 1e-9);
  EXPECT_TRUE(std::isnan(depth[0].temperature_degC));
  EXPECT_DOUBLE_EQ(depth[1].temperature_degC, 23.01532);
  EXPECT_EQ(run.totals.skipped_bytes, 0U);
}

TEST(Paroscientific, UnitAtmosphereAndLatitudeAreConfiguration) {
  CodecOptions bar;
  bar.pressure_unit_Pa = 1e5;
  bar.atmosphere_Pa = 100'000.0;
  bar.latitude_rad = 60.0 * kRadPerDeg;
  const auto depth = decode_text("pressure", "*000151.0\r\n", bar).all<DepthSample>();
  ASSERT_EQ(depth.size(), 1U);
  EXPECT_NEAR(depth[0].depth_m, 494.69, 0.02);
  CodecOptions metres;
  metres.value_is_depth = true;
  const auto direct = decode_text("pressure", "*000112.345\r\n", metres).all<DepthSample>();
  ASSERT_EQ(direct.size(), 1U);
  EXPECT_DOUBLE_EQ(direct[0].depth_m, 12.345);
  EXPECT_TRUE(std::isnan(direct[0].pressure_Pa));
}

TEST(Paroscientific, GarbledAndGluedLinesAreRefusedWhole) {
  EXPECT_EQ(refused("pressure", "*000114.61*000114.6189\r\n"), RejectReason::structure);
  EXPECT_EQ(refused("pressure", "9*000114.6189\r\n"), RejectReason::structure);
  EXPECT_EQ(refused("pressure", "14.6189\r\n"), RejectReason::structure);
  EXPECT_EQ(refused("pressure", "*00x114.6189\r\n"), RejectReason::structure);
  EXPECT_EQ(refused("pressure", "*0001\r\n"), RejectReason::structure);
  EXPECT_EQ(refused("pressure", "*000114.6.189\r\n"), RejectReason::field);
  EXPECT_EQ(refused("pressure", "*0001nan\r\n"), RejectReason::field);
  EXPECT_EQ(refused("pressure", "*0001P4=16.7509,2x\r\n"), RejectReason::field);
  EXPECT_EQ(refused("pressure", "*000199999999\r\n"), RejectReason::out_of_range);
  EXPECT_EQ(refused("pressure", "*0001-1.0\r\n"), RejectReason::out_of_range);
  EXPECT_EQ(refused("pressure", "*000114.618"), RejectReason::truncated);
}

TEST(Paroscientific, ARefusedLineDoesNotTakeTheNextOne) {
  const DecodeRun run = decode_text("pressure", "*000114.61*000114.6189\r\n*000114.6190\r\n");
  EXPECT_EQ(run.samples.size(), 1U);
  EXPECT_EQ(run.rejected.size(), 1U);
}

TEST(Paroscientific, CommandsAndOtherAnswersCarryNoSample) {
  const DecodeRun run = decode_text("pressure", "*0100P4\r\n*0001SN=123456\r\n*0001UN=1\r\n");
  EXPECT_TRUE(run.samples.empty());
  EXPECT_TRUE(run.rejected.empty());
  EXPECT_EQ(run.totals.frames_ignored, 3U);
}

TEST(Paroscientific, ABabblingLineIsRefusedInPieces) {
  const DecodeRun run = decode_text("pressure", std::string(1000, 'U') + "\r\n*000114.6190\r\n");
  EXPECT_EQ(run.samples.size(), 1U);
  EXPECT_EQ(run.rejected.size(), 8U);
  for (const Rejected& event : run.rejected) EXPECT_LE(event.length, 128U);
}

CodecOptions ascii(std::string_view prefix) {
  CodecOptions options;
  options.ascii_prefix = prefix;
  options.value_is_depth = true;
  return options;
}

TEST(AsciiDepth, PrefixNumberAndWhatMayFollow) {
  for (const char* line :
       {"D=12.5\r\n", "D=+12.5 m\r\n", "D= 12.5,3\n", "D=12.5m\r\n", "D=12.5;x\r", "D=12.5*7F\n"}) {
    const auto depth = decode_text("ascii_depth", line, ascii("D=")).all<DepthSample>();
    ASSERT_EQ(depth.size(), 1U) << line;
    EXPECT_DOUBLE_EQ(depth[0].depth_m, 12.5) << line;
  }
  EXPECT_EQ(decode_text("ascii_depth", "T=12.5\r\n", ascii("D=")).totals.frames_ignored, 1U);
}

TEST(AsciiDepth, RefusesWhatIsNoNumber) {
  for (const char* line :
       {"D=\r\n", "D=12.5x3\r\n", "D=1.2.3\r\n", "D=nan\r\n", "D=inf\r\n", "D=1e3\r\n", "D=--1\r\n"}) {
    EXPECT_EQ(refused("ascii_depth", line, ascii("D=")), RejectReason::field) << line;
  }
  EXPECT_EQ(refused("ascii_depth", "D=99999\r\n", ascii("D=")), RejectReason::out_of_range);
}

TEST(AsciiDepth, ScaleAndOffsetToPascal) {
  CodecOptions gauge_dbar;
  gauge_dbar.ascii_scale = 1e4;
  gauge_dbar.ascii_offset = 101'325.0;
  gauge_dbar.latitude_rad = 30.0 * kRadPerDeg;
  const auto depth = decode_text("ascii_depth", "1000.0\r\n", gauge_dbar).all<DepthSample>();
  ASSERT_EQ(depth.size(), 1U);
  EXPECT_NEAR(depth[0].depth_m, 990.81, 0.02);
  EXPECT_NEAR(depth[0].pressure_Pa, 1e7 + 101'325.0, 1e-6);
}

TEST(AsciiDepth, AChecksumThatIsThereMustBeRight) {
  EXPECT_EQ(
      decode_text("ascii_depth", "$PRVAT,00.115,M,0010.073,dBar*39\r\n", ascii("$PRVAT,")).samples.size(),
      1U);
  EXPECT_EQ(refused("ascii_depth", "$PRVAT,00.116,M,0010.073,dBar*39\r\n", ascii("$PRVAT,")),
            RejectReason::checksum);
}

}  // namespace
}  // namespace fathom::codec
