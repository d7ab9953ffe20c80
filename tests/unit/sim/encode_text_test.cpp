// What the simulated instruments send, the codecs read back: within the protocol's resolution.

#include <cmath>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include "base/units.hpp"
#include "geo/so3.hpp"
#include "sim/encode/air_data.hpp"
#include "sim/encode/depth.hpp"
#include "sim/encode/nmea.hpp"
#include "sim/encode/ubx.hpp"
#include "support/codec/decode_run.hpp"

namespace fathom::sim::encode {
namespace {

using test::bytes_of;
using test::decode_whole;
using test::DecodeRun;

constexpr double kEarthRadius_m = 6.4e6;

template <class Sample>
Sample only(const DecodeRun& run) {
  EXPECT_TRUE(run.rejected.empty());
  EXPECT_EQ(run.totals.skipped_bytes, 0U);
  const auto found = run.all<Sample>();
  EXPECT_EQ(found.size(), 1U);
  return found.empty() ? Sample{} : found[0];
}

TimeNs instant() {
  return *from_civil({.year = 2026,
                      .month = 12,
                      .day = 31,
                      .hour = 23,
                      .minute = 59,
                      .second = 59,
                      .nanosecond = 500 * kNsPerMillisecond});
}

GpsSample fix(double latitude_deg, double longitude_deg, GpsFix kind = GpsFix::rtk_fixed) {
  GpsSample sample;
  sample.fix = kind;
  sample.satellites = 14;
  sample.hdop = 0.75;
  sample.latitude_rad = latitude_deg * kRadPerDeg;
  sample.longitude_rad = longitude_deg * kRadPerDeg;
  sample.altitude_m = 18.523;
  sample.altitude_msl_m = -7.125;
  sample.position_sigma_N_m = {1.25, 1.5, 2.5};
  sample.velocity_N_m_s = {-1.234, 0.567, 0.089};
  sample.velocity_sigma_N_m_s = {0.05, 0.05, 0.08};
  return sample;
}

TEST(EncodeNmeaGps, RoundTripInEveryQuarterOfTheEarth) {
  for (const double latitude_deg : {36.4, -36.4, 0.0, 89.999'999'99, -0.000'000'1, 59.999'999'999'9}) {
    for (const double longitude_deg : {127.4, -127.4, 179.999'999'99, 0.0}) {
      const GpsSample sent = fix(latitude_deg, longitude_deg);
      const DecodeRun run = decode_whole("nmea0183", bytes_of(nmea_gps(sent, instant())));
      const auto got = only<GpsSample>(run);
      EXPECT_EQ(got.fix, sent.fix);
      EXPECT_EQ(got.satellites, 14);
      EXPECT_DOUBLE_EQ(got.hdop, 0.75);
      EXPECT_NEAR((got.latitude_rad - sent.latitude_rad) * kEarthRadius_m, 0.0, 2e-4);
      EXPECT_NEAR((got.longitude_rad - sent.longitude_rad) * kEarthRadius_m, 0.0, 2e-4);
      EXPECT_NEAR(got.altitude_m, sent.altitude_m, 1e-3);
      EXPECT_NEAR(got.altitude_msl_m, sent.altitude_msl_m, 1e-3);
      for (std::size_t axis = 0; axis < 2; ++axis) {
        EXPECT_NEAR(got.velocity_N_m_s[axis], sent.velocity_N_m_s[axis], 1e-4);
      }
      for (std::size_t axis = 0; axis < 3; ++axis) {
        EXPECT_NEAR(got.position_sigma_N_m[axis], sent.position_sigma_N_m[axis], 1e-3);
      }
      EXPECT_EQ(run.samples[0].time.utc_ns, instant());
    }
  }
}

TEST(EncodeNmeaGps, EveryKindOfFixSurvives) {
  for (const GpsFix kind : {GpsFix::none, GpsFix::dead_reckoning, GpsFix::fix_2d, GpsFix::fix_3d,
                            GpsFix::differential, GpsFix::rtk_float, GpsFix::rtk_fixed}) {
    const DecodeRun run = decode_whole("nmea0183", bytes_of(nmea_gps(fix(36.4, 127.4, kind), instant())));
    const auto got = only<GpsSample>(run);
    EXPECT_EQ(got.fix, kind);
    EXPECT_EQ(known(got.latitude_rad), kind != GpsFix::none);
    EXPECT_EQ(known(got.altitude_m), kind != GpsFix::none && kind != GpsFix::fix_2d);
    EXPECT_EQ(run.samples[0].time.utc_ns, instant());
  }
}

TEST(EncodeNmeaGps, NothingLeavesWhereTheReceiverHasNoFix) {
  const std::string text = nmea_gps(fix(36.4, 127.4, GpsFix::none), instant());
  EXPECT_EQ(text.find("3624"), std::string::npos);
  EXPECT_NE(text.find(",V,"), std::string::npos);
}

TEST(EncodeNmeaGps, AnAltitudeAboveTheEllipsoidOnlyStillArrives) {
  GpsSample sent = fix(36.4, 127.4);
  sent.altitude_msl_m = kUnknown;
  EXPECT_NEAR(only<GpsSample>(decode_whole("nmea0183", bytes_of(nmea_gps(sent, instant())))).altitude_m,
              sent.altitude_m, 1e-3);
  sent.altitude_m = kUnknown;
  const auto got = only<GpsSample>(decode_whole("nmea0183", bytes_of(nmea_gps(sent, instant()))));
  EXPECT_FALSE(known(got.altitude_m));
}

TEST(EncodeNmeaGps, RoundsTheTimeIntoTheNextYear) {
  const TimeNs almost = instant() + 499'700'000;
  const DecodeRun run = decode_whole("nmea0183", bytes_of(nmea_gps(fix(36.4, 127.4), almost)));
  EXPECT_EQ(run.samples.at(0).time.utc_ns, instant() + kNsPerSecond / 2);
}

TEST(EncodeNmeaHeading, TrueMagneticAndUnknown) {
  for (double heading_deg = 0.0; heading_deg < 360.0; heading_deg += 7.3) {
    HeadingSample sent;
    sent.heading_rad = heading_deg * kRadPerDeg;
    EXPECT_NEAR(only<HeadingSample>(decode_whole("heading", bytes_of(nmea_heading(sent)))).heading_rad,
                sent.heading_rad, 1e-3 * kRadPerDeg);
    sent.north = North::magnetic;
    sent.deviation_rad = 3.0 * kRadPerDeg;
    sent.variation_rad = -8.5 * kRadPerDeg;
    const auto got = only<HeadingSample>(decode_whole("heading", bytes_of(nmea_heading(sent))));
    EXPECT_EQ(got.north, North::magnetic);
    EXPECT_NEAR(std::remainder(got.heading_rad - sent.heading_rad, 2.0 * std::numbers::pi), 0.0,
                2e-3 * kRadPerDeg);
    EXPECT_NEAR(got.deviation_rad, sent.deviation_rad, 1e-3 * kRadPerDeg);
    EXPECT_NEAR(got.variation_rad, sent.variation_rad, 1e-3 * kRadPerDeg);
  }
  EXPECT_FALSE(known(only<HeadingSample>(decode_whole("heading", bytes_of(nmea_heading({})))).heading_rad));
  HeadingSample full_turn;
  full_turn.heading_rad = 359.999'9 * kRadPerDeg;
  EXPECT_EQ(only<HeadingSample>(decode_whole("heading", bytes_of(nmea_heading(full_turn)))).heading_rad, 0.0);
}

TEST(EncodeNmeaAttitude, TrueWithItsSigmaMagneticAndUnknown) {
  const auto read = [](const HeadingSample& sent) {
    return decode_whole("nmea_attitude", bytes_of(nmea_attitude(sent, instant())));
  };
  HeadingSample sent;
  sent.sigma_rad = 0.25 * kRadPerDeg;
  for (double heading_deg = 0.0; heading_deg < 360.0; heading_deg += 7.3) {
    sent.heading_rad = heading_deg * kRadPerDeg;
    sent.north = North::true_north;
    const DecodeRun run = read(sent);
    EXPECT_EQ(run.samples.at(0).time.time_of_day_ns, 86'399 * kNsPerSecond + 500 * kNsPerMillisecond);
    auto got = only<HeadingSample>(run);
    EXPECT_EQ(got.north, North::true_north);
    EXPECT_NEAR(got.heading_rad, sent.heading_rad, 1e-3 * kRadPerDeg);
    EXPECT_NEAR(got.sigma_rad, sent.sigma_rad, 1e-3 * kRadPerDeg);
    sent.north = North::magnetic;
    got = only<HeadingSample>(read(sent));
    EXPECT_EQ(got.north, North::magnetic);
    EXPECT_NEAR(got.heading_rad, sent.heading_rad, 1e-3 * kRadPerDeg);
  }
  sent.heading_rad = kUnknown;
  for (const North north : {North::true_north, North::magnetic}) {
    sent.north = north;
    const auto got = only<HeadingSample>(read(sent));
    EXPECT_EQ(got.north, north);
    EXPECT_FALSE(known(got.heading_rad));
    EXPECT_FALSE(known(got.sigma_rad));
  }
}

TEST(EncodeNmeaActuator, RpmAndFins) {
  PropulsionSample shaft;
  shaft.rpm = -1234.56;
  EXPECT_NEAR(only<PropulsionSample>(decode_whole("rpm", bytes_of(nmea_rpm(shaft)))).rpm, shaft.rpm, 1e-2);
  EXPECT_FALSE(known(only<PropulsionSample>(decode_whole("rpm", bytes_of(nmea_rpm({})))).rpm));
  FinsSample fins;
  fins.rudder_rad = 0.15;
  fins.stern_rad = -0.21;
  const auto got = only<FinsSample>(decode_whole("actuator", bytes_of(nmea_fins(fins))));
  EXPECT_NEAR(got.rudder_rad, fins.rudder_rad, 1e-3 * kRadPerDeg);
  EXPECT_NEAR(got.stern_rad, fins.stern_rad, 1e-3 * kRadPerDeg);
  fins.stern_rad = kUnknown;
  EXPECT_FALSE(known(only<FinsSample>(decode_whole("actuator", bytes_of(nmea_fins(fins)))).stern_rad));
}

TEST(EncodePsimssb, EveryFrameAndNoReply) {
  UsblSample sent;
  sent.transponder = "M17";
  sent.relative_m = {46.649, -1.632, 24.829};
  sent.sigma_m = 1.4;
  sent.travel_time_s = 0.033681;
  for (const UsblFrame frame : {UsblFrame::ned, UsblFrame::vessel_frd}) {
    sent.frame = frame;
    const DecodeRun run = decode_whole("psimssb", bytes_of(psimssb(sent, instant())));
    const auto got = only<UsblSample>(run);
    EXPECT_EQ(got.frame, frame);
    EXPECT_EQ(got.transponder, sent.transponder);
    for (std::size_t axis = 0; axis < 3; ++axis)
      EXPECT_NEAR(got.relative_m[axis], sent.relative_m[axis], 1e-3);
    EXPECT_NEAR(got.sigma_m, sent.sigma_m, 1e-3);
    EXPECT_NEAR(got.travel_time_s, sent.travel_time_s, 1e-6);
    EXPECT_EQ(run.samples[0].time.time_of_day_ns, 86'399 * kNsPerSecond + 500 * kNsPerMillisecond);
  }
  // A ship that is known goes ahead; the vessel's axes are sent levelled.
  sent.frame = UsblFrame::vessel_frd;
  sent.station_latitude_rad = 36.4 * kRadPerDeg;
  sent.station_longitude_rad = 127.4 * kRadPerDeg;
  sent.station_rpy_rad = {0.1, -0.05, 2.0};
  const auto ship = only<UsblSample>(decode_whole("psimssb", bytes_of(psimssb(sent, instant()))));
  EXPECT_NEAR((ship.station_latitude_rad - sent.station_latitude_rad) * kEarthRadius_m, 0.0, 1e-3);
  EXPECT_NEAR(ship.station_rpy_rad[2], 2.0, 1e-5);
  const auto along_north = [](const UsblSample& s) {
    return Eigen::Vector3d(geo::to_matrix(geo::from_rpy(geo::vec(s.station_rpy_rad))) *
                           geo::vec(s.relative_m));
  };
  EXPECT_LT((along_north(ship) - along_north(sent)).norm(), 2e-3);
  sent.frame = UsblFrame::geodetic;
  sent.latitude_rad = 36.4 * kRadPerDeg;
  sent.longitude_rad = -127.4 * kRadPerDeg;
  sent.depth_m = 35.5;
  const auto got = only<UsblSample>(decode_whole("psimssb", bytes_of(psimssb(sent, instant()))));
  EXPECT_EQ(got.frame, UsblFrame::geodetic);
  EXPECT_NEAR((got.latitude_rad - sent.latitude_rad) * kEarthRadius_m, 0.0, 1e-3);
  EXPECT_NEAR((got.longitude_rad - sent.longitude_rad) * kEarthRadius_m, 0.0, 1e-3);
  EXPECT_NEAR(got.depth_m, sent.depth_m, 1e-3);
  const auto silent = only<UsblSample>(decode_whole("psimssb", bytes_of(psimssb({}, instant()))));
  EXPECT_FALSE(known(silent.latitude_rad));
  EXPECT_FALSE(known(silent.relative_m[0]));
}

TEST(EncodeUbx, NavPvtRoundTrip) {
  for (const GpsFix kind : {GpsFix::fix_2d, GpsFix::fix_3d, GpsFix::differential, GpsFix::rtk_float,
                            GpsFix::rtk_fixed, GpsFix::dead_reckoning}) {
    const GpsSample sent = fix(-36.412'345'678, 127.498'765'432, kind);
    const DecodeRun run = decode_whole("ubx", ubx_nav_pvt(sent, instant() + 12'345));
    const auto got = only<GpsSample>(run);
    EXPECT_EQ(got.fix, kind);
    EXPECT_NEAR(got.latitude_rad, sent.latitude_rad, 0.6e-7 * kRadPerDeg);
    EXPECT_NEAR(got.longitude_rad, sent.longitude_rad, 0.6e-7 * kRadPerDeg);
    EXPECT_NEAR(got.altitude_m, sent.altitude_m, 1e-3);
    EXPECT_NEAR(got.altitude_msl_m, sent.altitude_msl_m, 1e-3);
    EXPECT_NEAR(got.position_sigma_N_m[0], std::hypot(1.25, 1.5) / std::numbers::sqrt2, 1e-3);
    EXPECT_NEAR(got.position_sigma_N_m[2], 2.5, 1e-3);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(got.velocity_N_m_s[axis], sent.velocity_N_m_s[axis], 1e-3);
      EXPECT_NEAR(got.velocity_sigma_N_m_s[axis], 0.08, 1e-3);
    }
    EXPECT_EQ(run.samples[0].time.utc_ns, instant() + 12'345);
  }
}

TEST(EncodeUbx, NoFixHasNoPositionButATime) {
  const DecodeRun run = decode_whole("ubx", ubx_nav_pvt(fix(36.4, 127.4, GpsFix::none), instant()));
  const auto got = only<GpsSample>(run);
  EXPECT_EQ(got.fix, GpsFix::none);
  EXPECT_FALSE(known(got.latitude_rad));
  EXPECT_EQ(run.samples[0].time.utc_ns, instant());
}

TEST(EncodeUbx, UnknownsDoNotBecomeGoodNumbers) {
  GpsSample sent = fix(36.4, 127.4, GpsFix::fix_3d);
  sent.position_sigma_N_m.fill(kUnknown);
  sent.velocity_sigma_N_m_s.fill(kUnknown);
  const auto got = only<GpsSample>(decode_whole("ubx", ubx_nav_pvt(sent, instant())));
  EXPECT_GT(got.position_sigma_N_m[0], 1e6);
  EXPECT_GT(got.velocity_sigma_N_m_s[0], 1e6);
}

TEST(EncodeDepth, ParoscientificToATenthOfAMillimetre) {
  codec::CodecOptions options;
  options.latitude_rad = 36.4 * kRadPerDeg;
  for (const double depth_m : {0.0, 0.5, 12.345, 250.0, 6000.0}) {
    DepthSample sent;
    sent.depth_m = depth_m;
    EXPECT_NEAR(
        only<DepthSample>(decode_whole("paroscientific", bytes_of(paroscientific(sent, options)), options))
            .depth_m,
        depth_m, 1e-4);
    sent.temperature_degC = 11.25;
    const auto got =
        only<DepthSample>(decode_whole("paroscientific", bytes_of(paroscientific(sent, options)), options));
    EXPECT_NEAR(got.depth_m, depth_m, 1e-4);
    EXPECT_NEAR(got.temperature_degC, 11.25, 1e-3);
  }
  EXPECT_TRUE(paroscientific({}, options).empty());
}

TEST(EncodeDepth, MetresAndTheAsciiLine) {
  codec::CodecOptions options;
  options.value_is_depth = true;
  options.ascii_prefix = "D=";
  options.ascii_scale = 0.3048;
  options.ascii_offset = 1.5;
  DepthSample sent;
  sent.depth_m = 33.25;
  EXPECT_NEAR(
      only<DepthSample>(decode_whole("paroscientific", bytes_of(paroscientific(sent, options)), options))
          .depth_m,
      33.25, 1e-5);
  EXPECT_NEAR(
      only<DepthSample>(decode_whole("ascii_depth", bytes_of(ascii_depth(sent, options)), options)).depth_m,
      33.25, 1e-5);
  EXPECT_TRUE(ascii_depth({}, options).empty());
}

AirspeedSample air_at(double altitude_m, double indicated_m_s, double true_m_s) {
  AirspeedSample sample;
  sample.airspeed_m_s = indicated_m_s;
  sample.true_airspeed_m_s = true_m_s;
  sample.baro_altitude_m = altitude_m;
  return sample;
}

TEST(EncodeAirData, BothSpeedsAndTheHeightSurviveInEitherProtocol) {
  for (const auto& sent : {air_at(30.0, 12.0, 12.4), air_at(900.0, 48.0, 51.5), air_at(4000.0, 70.0, 88.0)}) {
    for (const char* protocol : {"ascii_air_data", "nmea_air_data"}) {
      const std::string text = std::string(protocol) == "nmea_air_data" ? encode::nmea_air_data(sent, {})
                                                                        : encode::ascii_air_data(sent, {});
      const auto got = decode_whole(protocol, bytes_of(text), {}).all<AirspeedSample>();
      ASSERT_EQ(got.size(), 1U) << text;
      EXPECT_NEAR(got[0].airspeed_m_s, sent.airspeed_m_s, 5e-4) << text;
      EXPECT_NEAR(got[0].true_airspeed_m_s, sent.true_airspeed_m_s, 2e-3) << text;
      EXPECT_NEAR(got[0].baro_altitude_m, sent.baro_altitude_m, 0.02) << text;
    }
  }
}

TEST(EncodeAirData, WhatIsUnknownIsBlankAndRefusedAsIncomplete) {
  for (const auto& sent : {air_at(kUnknown, 48.0, 51.5), air_at(900.0, kUnknown, 51.5)}) {
    const auto run = decode_whole("ascii_air_data", bytes_of(encode::ascii_air_data(sent, {})), {});
    ASSERT_EQ(run.rejected.size(), 1U);
    EXPECT_EQ(run.rejected[0].reason, codec::RejectReason::incomplete);
  }
}

}  // namespace
}  // namespace fathom::sim::encode
