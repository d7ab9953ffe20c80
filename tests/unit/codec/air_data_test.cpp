// The standard atmosphere, pitot tubes, and the codecs of air data.

#include "codec/air/air_data.hpp"

#include <cmath>
#include <fstream>
#include <iterator>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "codec/air/air_report.hpp"
#include "nmea_text.hpp"
#include "support/paths.hpp"

namespace fathom::codec {
namespace {

using test::decode_text;
using test::DecodeRun;
using test::sentence;
using Q = AirQuantity;
using U = AirUnit;

constexpr double kKnot = 1852.0 / 3600.0;
constexpr double kFoot = 0.3048;

TEST(Atmosphere, TableOfTheStandardAtmosphere) {
  // U.S. Standard Atmosphere 1976, table I, geopotential altitude; pressure to its printed digits.
  struct Row {
    double altitude_m, temperature_K, pressure_Pa;
  };
  for (const Row& row :
       {Row{-1000.0, 294.65, 113'929.0}, Row{0.0, 288.15, 101'325.0}, Row{1000.0, 281.65, 89'875.0},
        Row{5000.0, 255.65, 54'020.0}, Row{11'000.0, 216.65, 22'632.0}, Row{15'000.0, 216.65, 12'044.6},
        Row{20'000.0, 216.65, 5'474.89}}) {
    EXPECT_NEAR(standard_temperature_K(row.altitude_m), row.temperature_K, 1e-9);
    EXPECT_NEAR(standard_pressure_Pa(row.altitude_m), row.pressure_Pa, 1e-5 * row.pressure_Pa);
    EXPECT_NEAR(pressure_altitude_m(standard_pressure_Pa(row.altitude_m)), row.altitude_m, 1e-6);
  }
  EXPECT_NEAR(speed_of_sound_m_s(288.15), 340.294, 1e-3);
}

TEST(Pitot, SlowAirFollowsBernoulliFastAirIsCompressed) {
  // 0.5 rho V^2 at 10 m/s; at 250 kn the table of NASA RP-1046 has an impact pressure of 213.3 lb/ft^2.
  EXPECT_NEAR(impact_pressure_Pa(10.0), 0.5 * 1.225 * 100.0, 0.02);
  EXPECT_NEAR(impact_pressure_Pa(250.0 * kKnot), 10'493.0, 10.0);
  for (const double speed : {-20.0, 0.0, 0.5, 40.0, 150.0})
    EXPECT_NEAR(indicated_airspeed_m_s(impact_pressure_Pa(speed)), speed, 1e-9);
  const double p = standard_pressure_Pa(3000.0);
  EXPECT_NEAR(mach_number(impact_pressure_at_Pa(100.0, p, 270.0), p) * speed_of_sound_m_s(270.0), 100.0,
              1e-9);
}

/// A report of 97.42 kn, 2952.8 ft and 9.15 degC, as true airspeed: 52.3 m/s in air of 1.1257 kg/m^3.
std::string line(std::string_view body) {
  const std::string whole = sentence(body);
  return whole.substr(1);
}

TEST(AsciiAirData, TrueAirspeedIsIndicatedOverTheRootOfTheDensity) {
  const auto run = decode_text("ascii_air_data", line("97.42,2952.8,9.15"));
  const auto air = run.all<AirspeedSample>();
  ASSERT_EQ(air.size(), 1U);
  const double density = standard_pressure_Pa(900.0) / (287.053 * (9.15 + 273.15));
  EXPECT_NEAR(air[0].airspeed_m_s, 97.42 * kKnot, 1e-9);
  EXPECT_NEAR(air[0].true_airspeed_m_s, 97.42 * kKnot * std::sqrt(1.225 / density), 0.03);
  EXPECT_NEAR(air[0].baro_altitude_m, 2952.8 * kFoot, 1e-9);
}

TEST(AsciiAirData, ColumnsUnitsPrefixAndSeparatorAreConfiguration) {
  CodecOptions options;
  options.air_data.prefix = "$ADC";
  options.air_data.separator = ' ';
  options.air_data.count = 5;
  options.air_data.columns = {AirColumn{Q::ignored, U::none}, AirColumn{Q::total_pressure, U::hPa},
                              AirColumn{Q::static_pressure, U::inHg},
                              AirColumn{Q::total_temperature, U::degF}, AirColumn{Q::ignored, U::none}};
  const double static_Pa = 26.9 * 3386.389;
  const double impact_Pa = 92'600.0 - static_Pa;
  const auto run = decode_text(
      "ascii_air_data", sentence("ADC 17   926.00 26.900 50.0 ok") + "$OTH 1 2 3*00\r\n" + sentence("OTH 1"),
      options);
  const auto air = run.all<AirspeedSample>();
  ASSERT_EQ(air.size(), 1U);
  const double mach = mach_number(impact_Pa, static_Pa);
  const double air_K = 283.15 / (1.0 + 0.2 * mach * mach);
  EXPECT_NEAR(air[0].true_airspeed_m_s, mach * speed_of_sound_m_s(air_K), 1e-6);
  EXPECT_NEAR(air[0].airspeed_m_s, indicated_airspeed_m_s(impact_Pa), 1e-6);
  ASSERT_EQ(run.rejected.size(), 1U);
  EXPECT_EQ(run.rejected[0].reason, RejectReason::checksum);
  EXPECT_EQ(run.totals.frames_ignored, 1U);
}

TEST(AsciiAirData, AnIndicatedAirspeedWillDoWhereThatIsSaid) {
  CodecOptions options;
  options.air_data.wanted = AirspeedWanted::indicated;
  const auto air = decode_text("ascii_air_data", line("97.42,2952.8,"), options).all<AirspeedSample>();
  ASSERT_EQ(air.size(), 1U);
  EXPECT_NEAR(air[0].airspeed_m_s, 97.42 * kKnot, 1e-9);
  EXPECT_FALSE(known(air[0].true_airspeed_m_s));
  const DecodeRun refused = decode_text("ascii_air_data", line("97.42,2952.8,"));
  ASSERT_EQ(refused.rejected.size(), 1U);
  EXPECT_EQ(refused.rejected[0].reason, RejectReason::incomplete);
}

TEST(AsciiAirData, WithoutAChecksumOnlyWhereThatIsAllowed) {
  CodecOptions options;
  options.require_checksum = false;
  EXPECT_EQ(decode_text("ascii_air_data", "97.42,2952.8,9.15\r\n", options).samples.size(), 1U);
  EXPECT_EQ(decode_text("ascii_air_data", "97.42,2952.8,9.15*00\r\n", options).samples.size(), 0U);
  const DecodeRun refused = decode_text("ascii_air_data", "97.42,2952.8,9.15\r\n");
  ASSERT_EQ(refused.rejected.size(), 1U);
  EXPECT_EQ(refused.rejected[0].reason, RejectReason::no_checksum);
}

TEST(AsciiAirData, SupersonicFlowIsNotReadWithSubsonicFormulas) {
  CodecOptions options;
  options.air_data.count = 3;
  options.air_data.columns = {AirColumn{Q::impact_pressure, U::kPa}, AirColumn{Q::static_pressure, U::kPa},
                              AirColumn{Q::static_temperature, U::K}};
  const DecodeRun run = decode_text("ascii_air_data", line("20.0,22.0,216.65"), options);
  ASSERT_EQ(run.rejected.size(), 1U);
  EXPECT_EQ(run.rejected[0].reason, RejectReason::out_of_range);
}

TEST(NmeaAirData, WhatWasHeardLongAgoIsForgotten) {
  std::string text = sentence("POV,P,951.8,T,14.1");
  const std::string speed = sentence("POV,Q,812.4");
  for (int i = 0; i < AirMemory::kPatience; ++i) text += speed;
  EXPECT_EQ(decode_text("nmea_air_data", text).samples.size(),
            static_cast<std::size_t>(AirMemory::kPatience));
  const DecodeRun run = decode_text("nmea_air_data", text + speed);
  ASSERT_EQ(run.rejected.size(), 1U);
  EXPECT_EQ(run.rejected[0].reason, RejectReason::incomplete);
}

TEST(NmeaAirData, AnInstrumentThatLosesItsBestQuantityIsFollowedByTheNext) {
  std::string text = sentence("POV,P,951.8,T,14.1,S,130.0");
  for (int i = 0; i < AirMemory::kPatience + 1; ++i) text += sentence("POV,P,951.8,T,14.1,Q,812.4");
  const auto air = decode_text("nmea_air_data", text).all<AirspeedSample>();
  ASSERT_EQ(air.size(), 2U);
  EXPECT_NEAR(air[0].true_airspeed_m_s, 130.0 / 3.6, 1e-9);
  EXPECT_NEAR(air[1].airspeed_m_s, indicated_airspeed_m_s(812.4), 1e-9);
}

TEST(NmeaAirData, TheNamesOfTransducersAreConfiguration) {
  CodecOptions options;
  options.air_data.transducer[static_cast<std::size_t>(Q::true_airspeed)] = "AIRSPEED#1";
  const std::string text = sentence("IIXDR,S,50.0,M,Airspeed#1") + sentence("IIXDR,S,60.0,M,TAS");
  const auto air = decode_text("nmea_air_data", text, options).all<AirspeedSample>();
  ASSERT_EQ(air.size(), 1U);
  EXPECT_NEAR(air[0].true_airspeed_m_s, 50.0, 1e-12);
}

double value(const nlohmann::json& json) {
  return json.is_null() ? kUnknown : json.get<double>();
}

void expect_near_or_unknown(double is, double should, double tolerance, const std::string& what) {
  if (!known(should)) {
    EXPECT_FALSE(known(is)) << what;
  } else {
    EXPECT_NEAR(is, should, tolerance) << what;
  }
}

TEST(AirDataVectors, EveryStreamGivesItsSamplesAndItsRefusals) {
  const std::string folder = test::vectors_dir() + "/air_data/";
  const auto expected = nlohmann::json::parse(std::ifstream(folder + "expected.json"));
  ASSERT_EQ(expected.at("streams").size(), 4U);
  for (const auto& stream : expected.at("streams")) {
    const auto file = stream.at("file").get<std::string>();
    std::ifstream in(folder + file, std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    ASSERT_FALSE(text.empty()) << file;
    const DecodeRun run = decode_text(stream.at("protocol").get<std::string>(), text);
    const auto air = run.all<AirspeedSample>();
    ASSERT_EQ(air.size(), stream.at("samples").size()) << file;
    for (std::size_t i = 0; i < air.size(); ++i) {
      const auto& one = stream.at("samples").at(i);
      const std::string what = file + " " + std::to_string(i);
      expect_near_or_unknown(air[i].airspeed_m_s, value(one.at("airspeed_m_s")), 1e-6, what);
      expect_near_or_unknown(air[i].true_airspeed_m_s, value(one.at("true_airspeed_m_s")), 1e-6, what);
      expect_near_or_unknown(air[i].baro_altitude_m, value(one.at("baro_alt_m")), 1e-5, what);
    }
    std::vector<std::string> reasons;
    for (const Rejected& one : run.rejected) reasons.emplace_back(to_string(one.reason));
    EXPECT_EQ(reasons, stream.at("rejected").get<std::vector<std::string>>()) << file;
    EXPECT_EQ(run.totals.skipped_bytes, 0U) << file;
  }
}

}  // namespace
}  // namespace fathom::codec
