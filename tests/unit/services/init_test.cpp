// Which instrument speaks on a port, and what of it goes into the file of the vehicle.
#include <algorithm>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cli/command.hpp"
#include "cli/init/listening.hpp"
#include "cli/init/proposal.hpp"
#include "cli/init/recognizer.hpp"
#include "geo/so3.hpp"
#include "sim/encode/nmea.hpp"
#include "support/codec/seed_streams.hpp"

namespace fathom::cli {
namespace {

using ::testing::HasSubstr;

/// A stream once a second, `times` times.
std::optional<Recognition> recognised(const test::ByteVector& stream, int times = 5) {
  Recognizer recognizer;
  for (int i = 0; i < times; ++i) recognizer.feed(stream, i * kNsPerSecond);
  return recognizer.best();
}

Heard heard(SourceKind kind, double rate_hz, const std::string& protocol, const std::string& path) {
  Heard out;
  out.port.path = path;
  out.bytes = 1000;
  out.recognition = Recognition{protocol, 1.0, {{kind, 100, rate_hz}}, {}, {}, {}};
  return out;
}

TEST(Recognizer, KnowsEachInstrumentFromItsBytes) {
  // All that there are, but those that any line with a number may be: whoever adds one adds it here.
  for (const codec::Protocol& protocol : codec::protocols()) {
    const std::string name(protocol.name);
    if (name.starts_with("ascii_")) continue;
    SCOPED_TRACE(name);
    const auto found = recognised(test::seed_stream(name));
    ASSERT_TRUE(found);
    EXPECT_EQ(found->protocol, name);
    EXPECT_GT(found->share, 0.25);
    EXPECT_FALSE(found->kinds.empty());
  }
}

TEST(Recognizer, KnowsItThroughTransmissionErrors) {
  for (const char* name : {"ubx", "sbf", "pd0", "vectornav"}) {
    SCOPED_TRACE(name);
    Recognizer recognizer;
    for (int i = 0; i < 20; ++i) {
      const auto stream = test::seed_stream(name);
      recognizer.feed(i % 4 == 0 ? test::mutated(stream, 1, static_cast<std::uint64_t>(i)) : stream,
                      i * kNsPerSecond);
    }
    const auto found = recognizer.best();
    ASSERT_TRUE(found);
    EXPECT_EQ(found->protocol, name);
  }
}

TEST(Recognizer, NoiseIsNoInstrument) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed)
    EXPECT_FALSE(recognised(test::noise(20'000, seed), 2)) << seed;
  EXPECT_FALSE(recognised({}));
}

TEST(Recognizer, CutsOfTheStreamDoNotMatter) {
  const auto stream = test::seed_stream("ubx");
  Recognizer recognizer;
  for (int i = 0; i < 3; ++i) {
    for (const std::uint8_t byte : stream) recognizer.feed({&byte, 1}, i * kNsPerSecond);
  }
  const auto by_byte = recognizer.best();
  const auto whole = recognised(stream, 3);
  ASSERT_TRUE(by_byte && whole);
  EXPECT_EQ(by_byte->protocol, whole->protocol);
  EXPECT_DOUBLE_EQ(by_byte->share, whole->share);
  EXPECT_EQ(by_byte->kinds.front().samples, whole->kinds.front().samples);
}

TEST(Recognizer, WhatHadGatheredBeforeItWasHeardTellsNoRate) {
  const auto stream = test::seed_stream("pd0");
  const std::uint64_t once = recognised(stream, 1)->kinds.front().samples;
  Recognizer recognizer;
  for (int i = 0; i < 8; ++i)
    recognizer.feed(stream, i * kNsPerMillisecond);  // a second's worth and more, at once
  for (int i = 1; i <= 10; ++i) recognizer.feed(stream, i * kNsPerSecond);
  const auto found = recognizer.best();
  ASSERT_TRUE(found);
  EXPECT_EQ(found->kinds.front().samples, 18 * once);
  EXPECT_NEAR(found->kinds.front().rate_hz, static_cast<double>(once), 0.01);
}

TEST(Recognizer, OfSeveralSentencesOnOneLineThePositionIsNotPassedOver) {
  using sim::encode::nmea_sentence;
  const auto protocol_of = [](const std::string& text) {
    const auto found = recognised({text.begin(), text.end()});
    return found ? found->protocol : "";
  };
  const std::string pashr = nmea_sentence("PASHR,163029.000,158.09,T,-0.3,0.3,0.0,0.029,0.029,0.059,1,1");
  const std::string hdt = nmea_sentence("HEHDT,158.09,T");
  EXPECT_EQ(protocol_of(hdt), "nmea0183");
  EXPECT_EQ(protocol_of(pashr), "nmea_attitude");
  for (const char* body : {"PSAT,HPR,102143.00,356.881,-0.387,-0.4,N", "PTNTHPR,85.9,N,-0.9,N,0.8,N",
                           "OHPR,237.7,-14.3,175.5,30.1", "C320.5P0.2R-18.3T19.0", "PRDID,-1.25,+0.50,12.0"})
    EXPECT_EQ(protocol_of(nmea_sentence(body)), "nmea_attitude") << body;
  EXPECT_EQ(protocol_of(pashr + hdt + pashr + pashr), "nmea0183");
  const std::string fix =
      nmea_sentence("GPGGA,163029.00,4000.0000000,N,00130.0000000,E,1,10,1.0,3.0,M,0.0,M,,");
  EXPECT_EQ(protocol_of(pashr + pashr + fix + pashr), "nmea0183");
}

TEST(Proposal, RatesAreThoseThatPeopleSet) {
  EXPECT_EQ(tidy_rate_hz(99.2, 600), 100.0);
  EXPECT_EQ(tidy_rate_hz(10.03, 600), 10.0);
  EXPECT_EQ(tidy_rate_hz(4.97, 600), 5.0);
  EXPECT_EQ(tidy_rate_hz(0.1985, 600), 0.2);
  EXPECT_EQ(tidy_rate_hz(8.0, 600), 8.0);
  EXPECT_EQ(tidy_rate_hz(7.7, 600), 7.7);
  EXPECT_EQ(tidy_rate_hz(2.153, 13), 2.0) << "a sample more or less";
  EXPECT_EQ(tidy_rate_hz(0.0, 600), 0.0);
}

TEST(Proposal, GravitySaysRollAndPitch) {
  // The mounting turns the unit's axes into the vehicle's, in which gravity's reaction is up.
  for (const std::array<double, 3>& up :
       {std::array<double, 3>{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}}) {
    const auto rpy_deg = upright_rpy_deg({9.8 * up[0], 9.8 * up[1], 9.8 * up[2]});
    ASSERT_TRUE(rpy_deg);
    const Eigen::Matrix3d C_BS = geo::to_matrix(geo::from_rpy(
        Eigen::Vector3d((*rpy_deg)[0], (*rpy_deg)[1], (*rpy_deg)[2]) * std::numbers::pi / 180.0));
    const Eigen::Vector3d f_B = C_BS * Eigen::Vector3d(up[0], up[1], up[2]);
    EXPECT_NEAR(f_B.z(), -1.0, 1e-9) << up[0] << up[1] << up[2];
  }
  EXPECT_FALSE(upright_rpy_deg({6.9, 0.0, -6.9})) << "no axis is up";
  EXPECT_FALSE(upright_rpy_deg({0.0, 0.0, -1.0})) << "in g, not in m/s^2";
  EXPECT_FALSE(upright_rpy_deg({0.0, 0.0, 0.0}));
}

TEST(Proposal, AnAtmosphereSaysTheUnit) {
  const auto as_psi_m = [](double number) { return (number * 6'894.757 - 101'325.0) / 10'055.0; };
  EXPECT_EQ(unit_in_air(as_psi_m(14.7)), "psi");
  EXPECT_EQ(unit_in_air(as_psi_m(1.01)), "bar");
  EXPECT_EQ(unit_in_air(as_psi_m(10.2)), "dbar");
  EXPECT_EQ(unit_in_air(as_psi_m(101.0)), "kPa");
  EXPECT_EQ(unit_in_air(as_psi_m(1009.0)), "mbar");
  EXPECT_FALSE(unit_in_air(as_psi_m(45.0))) << "under water";
}

TEST(Proposal, EachPortIsAnInstrumentWithAName) {
  auto receiver = heard(SourceKind::gps, 4.98, "nmea0183", "/dev/a");
  receiver.recognition->kinds.push_back({SourceKind::heading, 500, 20.0});
  auto silent = heard(SourceKind::dvl, 0.0, "pd0", "/dev/c");
  silent.recognition.reset();
  const auto made = propose({receiver, heard(SourceKind::gps, 1.0, "ubx", "/dev/b"), silent});
  ASSERT_EQ(made.size(), 3U);
  EXPECT_EQ(made[0].instrument["name"], "gps");
  EXPECT_EQ(made[0].instrument["kind"], "gps") << "a receiver with a heading is a receiver first";
  EXPECT_EQ(made[0].instrument["rate_hz"], 5.0);
  EXPECT_EQ(made[0].instrument["port"]["path"], "/dev/a");
  EXPECT_EQ(made[0].instrument["port"]["shared"], true) << "the heading comes over the same line";
  EXPECT_EQ(made[1].instrument["name"], "heading");
  EXPECT_EQ(made[1].instrument["rate_hz"], 20.0);
  EXPECT_EQ(made[1].instrument["port"], made[0].instrument["port"]);
  EXPECT_EQ(made[2].instrument["name"], "gps2");
  EXPECT_FALSE(made[2].instrument["port"].contains("shared"));
  EXPECT_TRUE(made[2].has_place);
  EXPECT_FALSE(made[2].has_mounting);
}

TEST(Proposal, OfAnAutopilotOneBridgeIsTaken) {
  auto autopilot = heard(SourceKind::imu, 50.0, "mavlink", "/dev/a");
  autopilot.recognition->kinds.push_back({SourceKind::gps, 100, 5.0});
  const auto made = propose({autopilot});
  ASSERT_EQ(made.size(), 1U);
  EXPECT_EQ(made[0].instrument["kind"], "imu");
  EXPECT_FALSE(made[0].instrument["port"].contains("shared"));
  EXPECT_THAT(made[0].notes, ::testing::Contains(HasSubstr("gps as well")));
}

TEST(Proposal, AsksForTheUnitOfAPressureOnlyWhereItsProtocolDoesNotSayIt) {
  const auto made = propose({heard(SourceKind::depth, 8.0, "paroscientific", "/dev/a"),
                             heard(SourceKind::depth, 4.0, "nmea0183", "/dev/b")});
  ASSERT_EQ(made.size(), 2U);
  EXPECT_TRUE(made[0].instrument.contains("bridge"));
  EXPECT_FALSE(made[1].instrument.contains("bridge"));
}

TEST(Proposal, OfAKvhUnitItIsSaidHowItIsTakenToBeSet) {
  const auto made = propose({heard(SourceKind::imu, 999.4, "kvh", "/dev/a")});
  ASSERT_EQ(made.size(), 1U);
  EXPECT_EQ(made[0].instrument["rate_hz"], 1'000.0);
  EXPECT_EQ(made[0].instrument["bridge"]["kvh"]["rotation"], "delta");
  EXPECT_THAT(made[0].notes, ::testing::Contains(HasSubstr("=ROTFMT")));
  EXPECT_THAT(made[0].notes, ::testing::Contains(HasSubstr("kvh_1725, kvh_1750, kvh_1775")));
}

TEST(Proposal, NamesTheModelsThatSpeakSo) {
  const auto made = propose({heard(SourceKind::imu, 100.0, "vectornav", "/dev/a"),
                             heard(SourceKind::usbl, 1.0, "psimssb", "/dev/b"),
                             heard(SourceKind::heading, 10.0, "nmea0183", "/dev/c"),
                             heard(SourceKind::heading, 10.0, "nmea_attitude", "/dev/d")});
  ASSERT_EQ(made.size(), 4U);
  EXPECT_FALSE(made[0].instrument.contains("model")) << "several speak so, with figures of their own";
  EXPECT_THAT(made[0].notes, ::testing::Contains(HasSubstr("vectornav_vn100, vectornav_vn200")));
  EXPECT_EQ(made[1].instrument["model"], "kongsberg_hipap");
  EXPECT_FALSE(made[2].instrument.contains("model"));
  EXPECT_FALSE(made[3].instrument.contains("model")) << "its protocol is no maker's own";
  EXPECT_THAT(made[3].notes, ::testing::Contains(HasSubstr("oceanserver_os5000")));
  EXPECT_THAT(made[3].notes, ::testing::Contains(HasSubstr("which north")));
}

TEST(Ports, AreReadAsPeopleWriteThem) {
  EXPECT_EQ(serial_port("/dev/ttyUSB0").port.path, "/dev/ttyUSB0");
  EXPECT_FALSE(serial_port("/dev/ttyUSB0").baud_known);
  EXPECT_EQ(serial_port("/dev/ttyUSB0@9600").port.baud, 9600);
  EXPECT_EQ(tcp_port("192.168.1.20:16171").port.port, 16171);
  EXPECT_EQ(udp_port("10110").port.address, "0.0.0.0");
  for (const char* bad : {"/dev/x@", "/dev/x@fast", "/dev/x@50"})
    EXPECT_THROW((void)serial_port(bad), Failure) << bad;
  for (const char* bad : {"", "host:1", "10.0.0.1", "10.0.0.1:", "10.0.0.1:0", "10.0.0.1:70000"})
    EXPECT_THROW((void)tcp_port(bad), Failure) << bad;
  for (const char* bad : {"", "x", "0", "65536", "1x"}) EXPECT_THROW((void)udp_port(bad), Failure) << bad;
}

}  // namespace
}  // namespace fathom::cli
