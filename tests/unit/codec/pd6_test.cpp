// PD6: what the makers' documents print, what firmware of others sends, and recordings decoded by hand.
#include "codec/dvl/pd6.hpp"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "base/units.hpp"
#include "capture.hpp"
#include "support/data.hpp"

namespace fathom::codec {
namespace {

using capture::ByteVector;
using capture::Cut;
using capture::decode;
using capture::Harvest;
using capture::of_kind;
using Frd = std::array<double, 3>;

Harvest pd6_run(const std::string& stream, double alignment_deg = 0.0) {
  CodecOptions options;
  options.dvl_heading_alignment_rad = alignment_deg * kRadPerDeg;
  return decode("pd6", ByteVector(stream.begin(), stream.end()), {}, options);
}

std::vector<DvlSample> pd6_samples(const std::string& stream, double alignment_deg = 0.0) {
  std::vector<DvlSample> found;
  for (const auto& [decoded, sample] : of_kind<DvlSample>(pd6_run(stream, alignment_deg)))
    found.push_back(sample);
  return found;
}

void expect_frd(const Frd& got, const Frd& expected, double tolerance) {
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(got[i], expected[i], tolerance) << "axis " << i;
}

std::string crlf_lines(std::initializer_list<const char*> lines) {
  std::string text;
  for (const char* line : lines) text += std::string(line) + "\r\n";
  return text;
}

/// The example of the Pathfinder DVL Guide, April 2018, "special output data formats", page 222: a Pathfinder
/// whose beam 3 looks 135 degrees to port of forward, which has the bottom.
std::string pathfinder_ping(const char* instrument = ":BI, +24, -6, -20, -4,A") {
  return crlf_lines({":SA, -2.31, +1.92, 75.20", ":TS,04081111563644,35.0,+21.0, 0.0,1524.0, 0",
                     ":RA, 0.00, 71.31, 71.32, 71.32, 71.31", ":WI,-32768,-32768,-32768,-32768,V",
                     ":WS,-32768,-32768,-32768,V", ":WE,-32768,-32768,-32768,V",
                     ":WD, +0.00, +0.00, +0.00, 20.00, 0.00", instrument, ":BS, -13, +21, -20,A",
                     ":BE, +17, +18, -20,A", ":BD, -0.02, -0.03, +0.02, 7.13, 0.21"});
}

/// The example of Water Linked's documentation, "DVL PD formats".
const std::string kWaterLinkedPing =
    crlf_lines({":SA, +0.00, +0.00,  0.00", ":TS,22020812061800, 0.0, +0.0,   0.0,1475.0,  0",
                ":WI,    +0,    +0,    +0,    +0,V", ":WS,    +0,    +0,    +0,V",
                ":WE,    +0,    +0,    +0,V", ":WD,       +0.00,       +0.00,       +0.00,   0.00,  0.00",
                ":BI,  +123,  -420, +2000,    +0,A", ":BS,  -420,  +123, +2000,A",
                ":BE,    +0,    +0,    +0,V", ":BD,       +0.00,       +0.00,       +0.00,   5.32,  0.00"});

std::string without_line(std::string text, const std::string& address) {
  const auto at = text.find(":" + address);
  return text.erase(at, text.find('\n', at) + 1 - at);
}

TEST(Pd6, ReadsThePing) {
  const Harvest run = pd6_run(pathfinder_ping());
  const auto dvl = of_kind<DvlSample>(run);
  ASSERT_EQ(dvl.size(), 1U);
  const DvlSample& s = dvl[0].second;
  EXPECT_EQ(s.mode, DvlMode::bottom);
  EXPECT_EQ(s.recorded_frame, DvlFrame::instrument);
  EXPECT_EQ(s.velocity_D_m_s, (Frd{-0.006, 0.024, 0.020}));
  EXPECT_EQ(s.error_velocity_m_s, -0.004);
  EXPECT_EQ(s.altitude_m, 7.13);
  EXPECT_EQ(s.sound_speed_m_s, 1524.0);
  EXPECT_NEAR(s.pitch_rad, -2.31 * kRadPerDeg, 1e-15);
  EXPECT_NEAR(s.roll_rad, 1.92 * kRadPerDeg, 1e-15);
  EXPECT_NEAR(s.heading_rad, 75.20 * kRadPerDeg, 1e-15);
  EXPECT_EQ(dvl[0].first.time.clock_ns, from_civil({2004, 8, 11, 11, 56, 36, 440'000'000}));
  EXPECT_EQ(dvl[0].first.offset, 0U);
  EXPECT_EQ(dvl[0].first.length, pathfinder_ping().size() - 2) << "from the first line to the last";
  EXPECT_EQ(run.totals.frames_ignored, 5U) << ":SA :TS :RA :WD :BD";
  EXPECT_EQ(run.totals.skipped_bytes, 0U);
}

// The maker's own numbers in the other frames, each rounded to 1 mm/s.
TEST(Pd6, FramesOfOnePingAgree) {
  const Frd ship{0.021, -0.013, 0.020};
  expect_frd(pd6_samples(pathfinder_ping(), -135.0).at(0).velocity_D_m_s, ship, 1e-3);
  const DvlSample s = pd6_samples(without_line(pathfinder_ping(), "BI")).at(0);
  EXPECT_EQ(s.recorded_frame, DvlFrame::ship);
  EXPECT_EQ(s.velocity_D_m_s, ship);
  EXPECT_FALSE(known(s.error_velocity_m_s));
  const DvlSample e = pd6_samples(without_line(without_line(pathfinder_ping(), "BI"), "BS")).at(0);
  EXPECT_EQ(e.recorded_frame, DvlFrame::earth);
  // The example's own ship velocity is not levelled: 2.3 degrees of 20 mm/s.
  expect_frd(e.velocity_D_m_s, ship, 2.0e-3);
}

TEST(Pd6, EarthWithoutAttitudeMeansNothing) {
  const std::string earth = crlf_lines({":BE, +17, +18, -20,A", ":BD, -0.02, -0.03, +0.02, 7.13, 0.21"});
  const Harvest run = pd6_run(earth + ":SA, -2.31, +1.92, 75.20\r\n" + earth + earth);
  EXPECT_EQ(run.totals.samples, 1U);
  ASSERT_EQ(run.rejected.size(), 2U);
  for (const Rejected& rejected : run.rejected) EXPECT_EQ(rejected.reason, RejectReason::incomplete);
}

TEST(Pd6, HeadingAlignmentTurnsInstrumentAxesOnly) {
  // Beam 3 looks to starboard: what goes along it goes right.
  const auto turned = pd6_samples(":BI,+0,+1000,+0,+0,A\r\n:BD,+0.00,+0.00,+0.00,1.00,0.00\r\n", 90.0);
  expect_frd(turned.at(0).velocity_D_m_s, {0.0, 1.0, 0.0}, 1e-15);
  const auto ship = pd6_samples(":BS,+0,+1000,+0,A\r\n:BD,+0.00,+0.00,+0.00,1.00,0.00\r\n", 90.0);
  expect_frd(ship.at(0).velocity_D_m_s, {1.0, 0.0, 0.0}, 1e-15);
}

TEST(Pd6, WaterLinkedSendsForwardRightDown) {
  const auto run = pd6_run(kWaterLinkedPing);
  const auto dvl = of_kind<DvlSample>(run);
  ASSERT_EQ(dvl.size(), 1U);
  EXPECT_EQ(dvl[0].second.velocity_D_m_s, (Frd{0.123, -0.420, 2.0}));
  EXPECT_EQ(dvl[0].second.error_velocity_m_s, 0.0);
  EXPECT_EQ(dvl[0].second.altitude_m, 5.32);
  EXPECT_EQ(dvl[0].second.sound_speed_m_s, 1475.0);
  EXPECT_FALSE(known(dvl[0].second.heading_rad)) << "it has none";
  EXPECT_EQ(dvl[0].first.time.clock_ns, from_civil({2022, 2, 8, 12, 6, 18, 0}));
  // Known by then, also from a ping that lost the line which tells, and from the ship's axes.
  for (const char* lost : {"BE", "BI", "BS"}) {
    const auto later = pd6_samples(kWaterLinkedPing + without_line(kWaterLinkedPing, lost));
    ASSERT_EQ(later.size(), 2U);
    EXPECT_EQ(later[1].velocity_D_m_s, (Frd{0.123, -0.420, 2.0})) << lost;
  }
  // Teledyne's follow a replaced instrument.
  EXPECT_EQ(pd6_samples(kWaterLinkedPing + pathfinder_ping()).at(1).velocity_D_m_s,
            (Frd{-0.006, 0.024, 0.020}));
}

TEST(Pd6, StatusDecidesWhateverTheNumbers) {
  for (const char* bad :
       {":BI, +24, -6, -20, -4,V", ":BI, +24, -6, -20, -4,I", ":BI,-32768,-32768,-32768,-32768,V"}) {
    const auto samples = pd6_samples(pathfinder_ping(bad));
    ASSERT_EQ(samples.size(), 1U) << bad;
    for (const double v : samples[0].velocity_D_m_s) EXPECT_FALSE(known(v)) << bad;
    EXPECT_FALSE(known(samples[0].error_velocity_m_s)) << bad;
    EXPECT_EQ(samples[0].altitude_m, 7.13);
  }
}

TEST(Pd6, GoodWithoutErrorVelocityIsAThreeBeamSolution) {
  const auto samples = pd6_samples(pathfinder_ping(":BI,    +0,    +0,    +0,-32768,A"));
  EXPECT_EQ(samples.at(0).velocity_D_m_s, (Frd{0.0, 0.0, 0.0}));
  EXPECT_FALSE(std::signbit(samples[0].velocity_D_m_s[0])) << "no negative zero";
  EXPECT_FALSE(std::signbit(samples[0].velocity_D_m_s[2]));
  EXPECT_FALSE(known(samples[0].error_velocity_m_s));
}

TEST(Pd6, WaterIsASecondSample) {
  std::string text = pathfinder_ping();
  const std::string bad = ":WI,-32768,-32768,-32768,-32768,V";
  text.replace(text.find(bad), bad.size(), ":WI,  +150,  +900,   -20,    +3,A");
  const auto samples = pd6_samples(text);
  ASSERT_EQ(samples.size(), 2U);
  EXPECT_EQ(samples[0].mode, DvlMode::bottom);
  EXPECT_EQ(samples[1].mode, DvlMode::water);
  EXPECT_EQ(samples[1].velocity_D_m_s, (Frd{0.9, 0.15, 0.02}));
  EXPECT_EQ(samples[1].error_velocity_m_s, 0.003);
  EXPECT_FALSE(known(samples[1].altitude_m));
}

TEST(Pd6, WaterAloneThatIsLostIsAlive) {
  const std::string ping =
      crlf_lines({":SA,+0.00,+0.00,0.00", ":TS,23030218083269,35.0,+21.0,0.2,1524.2,0",
                  ":WI,-32768,-32768,-32768,-32768,V", ":WD,+0.00,+0.00,+0.00,20.00,0.00"});
  const auto samples = pd6_samples(ping + ping);
  ASSERT_EQ(samples.size(), 2U);
  EXPECT_EQ(samples[1].mode, DvlMode::water);
  EXPECT_FALSE(known(samples[1].velocity_D_m_s[0]));
}

/// How many samples are out when the first so many bytes have come.
std::size_t samples_out_after(const std::string& stream) {
  struct Counter final : Sink {
    void on_sample(const Decoded&) override { ++count; }
    void on_rejected(const Rejected&) override {}
    std::size_t count = 0;
  } counter;
  const auto codec = make_pd6({});
  codec->feed({reinterpret_cast<const std::uint8_t*>(stream.data()), stream.size()}, counter);
  return counter.count;
}

TEST(Pd6, IsDeliveredWithTheLastLine) {
  const std::string ping = pathfinder_ping();
  EXPECT_EQ(samples_out_after(ping.substr(0, ping.size() - 2)), 0U) << "the line may go on";
  EXPECT_EQ(samples_out_after(ping.substr(0, ping.size() - 1)), 1U);
  // Damage to one line does not hold back the ping, nor the ping after one that lost its last line.
  EXPECT_EQ(samples_out_after(ping + ping + without_line(ping, "WS")), 3U);
  EXPECT_EQ(samples_out_after(ping + ping + without_line(ping, "BD")), 2U);
  EXPECT_EQ(samples_out_after(ping + ping + without_line(ping, "BD") + ping), 4U);
}

TEST(Pd6, ThePingEndsWhereTheLastOnesDid) {
  const std::string short_ping = without_line(pathfinder_ping(), "BD");
  EXPECT_EQ(samples_out_after(short_ping + short_ping), 1U) << "not known yet";
  EXPECT_EQ(samples_out_after(short_ping + short_ping + short_ping), 3U);
  // A device with the bottom before the water: what comes late is not lost.
  const std::string other = crlf_lines({":TS,23030218083269,35.0,+21.0,0.2,1524.2,0", ":BI,+1,+2,+3,+0,A",
                                        ":BD,+0.00,+0.00,+0.00,9.00,0.00", ":WI,+4,+5,+6,+0,A",
                                        ":WD,+0.00,+0.00,+0.00,20.00,0.00"});
  EXPECT_EQ(pd6_samples(other).size(), 2U);
  EXPECT_EQ(samples_out_after(other + other + other), 6U);
}

TEST(Pd6, ListeningMayBeginInsideAPing) {
  const std::string ping = pathfinder_ping();
  const auto samples = pd6_samples(ping.substr(ping.find("BI")) + ping + ping);
  ASSERT_EQ(samples.size(), 3U);
  EXPECT_EQ(samples[0].recorded_frame, DvlFrame::ship);
  EXPECT_FALSE(known(samples[0].sound_speed_m_s));
  EXPECT_EQ(samples[1].altitude_m, 7.13);
}

// Lines as firmware and tests of others have them.
TEST(Pd6, LinesWithoutLineEndBetweenThem) {
  const Harvest run = pd6_run(
      ":TS,00010100000186,35.0,+25.0,   0.0,1500.0,003:BI,   -30,   +37,    +0,    +0,A\r\n"
      ":BD,       +0.00,       -0.00,       -0.00,  +5.84,  0.09:SA, +4.76,0.89, .34\r\n");
  const auto dvl = of_kind<DvlSample>(run);
  ASSERT_EQ(dvl.size(), 1U);
  EXPECT_EQ(dvl[0].second.velocity_D_m_s, (Frd{0.037, -0.030, 0.0}));
  EXPECT_EQ(dvl[0].second.altitude_m, 5.84);
  EXPECT_EQ(dvl[0].second.sound_speed_m_s, 1500.0);
  EXPECT_EQ(dvl[0].first.time.clock_ns, from_civil({2000, 1, 1, 0, 0, 1, 860'000'000}));
  ASSERT_EQ(run.rejected.size(), 1U) << "of the heading a piece is left";
  EXPECT_EQ(run.rejected[0].reason, RejectReason::field);
  EXPECT_EQ(run.totals.skipped_bytes, 0U);
}

TEST(Pd6, NavQuestMarksTheLostWithI) {
  const auto samples = pd6_samples(
      crlf_lines({":WI, +0, +0, +0, +0,I", ":BI, +0, -2345, -439, +0,A", ":BS, +0, -2345, -439, A",
                  ":BE, -1532, 1945, -42, A", ":BD, +0.00, +0.00, +0.00, 0.40, 0.00"}));
  ASSERT_EQ(samples.size(), 1U);
  EXPECT_EQ(samples[0].velocity_D_m_s, (Frd{-2.345, 0.0, 0.439}));
  EXPECT_EQ(samples[0].altitude_m, 0.40);
}

struct Pd6Fault {
  const char* name;
  std::string line;
  RejectReason reason;
};

class Pd6Faults : public ::testing::TestWithParam<Pd6Fault> {};

TEST_P(Pd6Faults, AreRefusedAloneAndThePingGoesOn) {
  const Harvest run = pd6_run(GetParam().line + "\r\n" + pathfinder_ping());
  ASSERT_EQ(run.rejected.size(), 1U);
  EXPECT_EQ(run.rejected[0].reason, GetParam().reason);
  EXPECT_EQ(run.rejected[0].offset, 0U);
  ASSERT_EQ(run.totals.samples, 1U);
  EXPECT_EQ(of_kind<DvlSample>(run)[0].second.velocity_D_m_s, (Frd{-0.006, 0.024, 0.020}));
}

INSTANTIATE_TEST_SUITE_P(
    All, Pd6Faults,
    ::testing::Values(
        Pd6Fault{"cut", ":BI,   -30,   +3", RejectReason::structure},
        Pd6Fault{"without_status", ":BI,-30,+37,+0,+0", RejectReason::structure},
        Pd6Fault{"field_too_many", ":BS,-30,+37,+0,+0,A", RejectReason::structure},
        Pd6Fault{"no_fields", ":BS,", RejectReason::structure},
        Pd6Fault{"empty_field", ":BS,-30,,+0,A", RejectReason::field},
        Pd6Fault{"letter", ":BS,-3o,+37,+0,A", RejectReason::field},
        Pd6Fault{"two_signs", ":BS,+-3,+37,+0,A", RejectReason::field},
        Pd6Fault{"blank_inside", ":BS,-3 0,+37,+0,A", RejectReason::field},
        Pd6Fault{"part_of_a_millimetre", ":BS,-3.0,+37,+0,A", RejectReason::field},
        Pd6Fault{"unknown_status", ":BS,-30,+37,+0,B", RejectReason::field},
        Pd6Fault{"no_status", ":BS,-30,+37,+0,", RejectReason::field},
        Pd6Fault{"too_fast", ":BS,+32768,+37,+0,A", RejectReason::out_of_range},
        Pd6Fault{"short_time", ":TS,2303021808326,35.0,+21.0,0.2,1524.2,0", RejectReason::field},
        Pd6Fault{"test_result", ":TS,23030218083269,35.0,+21.0,0.2,1524.2,x", RejectReason::field},
        Pd6Fault{"no_test_result", ":TS,23030218083269,35.0,+21.0,0.2,1524.2,", RejectReason::field},
        Pd6Fault{"range_below_zero", ":BD,+0.00,+0.00,+0.00,-7.00,0.00", RejectReason::out_of_range},
        Pd6Fault{"half_a_range", ":BD,+0.00,+0.00,+0.00,7.,0.00", RejectReason::field},
        Pd6Fault{"upright", ":SA,+91.00,+0.00,0.00", RejectReason::out_of_range},
        Pd6Fault{"binary", ":BI,-30\x01,+37,+0,+0,A", RejectReason::structure},
        Pd6Fault{"too_long", ":BI," + std::string(200, ' ') + "1", RejectReason::length}),
    [](const auto& info) { return std::string(info.param.name); });

TEST(Pd6, AnImpossibleDateIsNoTime) {
  const auto run = pd6_run(":TS,00000000000000,35.0,+25.0,0.0,1500.0,0\r\n:BI,+1,+2,+3,+0,A\r\n");
  ASSERT_EQ(run.totals.samples, 1U);
  EXPECT_FALSE(run.samples[0].time.clock_ns.has_value());
}

TEST(Pd6, OtherTextIsSkipped) {
  const Harvest run = pd6_run("DVL: ready 12:30:00, :x, :AB;\r\n>" + pathfinder_ping());
  EXPECT_EQ(run.totals.samples, 1U);
  EXPECT_EQ(run.totals.rejected, 0U);
  EXPECT_EQ(pd6_run("CZ\r0000000000000").totals.samples, 0U);
}

TEST(Pd6, TheEndCutsALine) {
  const Harvest run = pd6_run(":BI,+1,+2,+3,+0,A");
  ASSERT_EQ(run.rejected.size(), 1U);
  EXPECT_EQ(run.rejected[0].reason, RejectReason::truncated);
}

/// Hand decoded: `BI` in mm/s as sent, null where bad.
TEST(Pd6Captures, AgreeWithWhatWasReadByHand) {
  const auto folder = capture::root() / "pd6";
  if (!std::filesystem::exists(folder)) FATHOM_DATA_IS_MISSING(folder << " is not there");
  std::ifstream in(folder / "expected.json");
  const auto expected = nlohmann::json::parse(in);
  std::size_t files = 0;
  for (const auto& [name, pings] : expected.items()) {
    if (!std::filesystem::exists(folder / name)) continue;
    SCOPED_TRACE(name);
    ++files;
    const Harvest run = decode("pd6", capture::load(folder / name));
    const auto dvl = of_kind<DvlSample>(run);
    ASSERT_EQ(dvl.size(), pings.size());
    EXPECT_EQ(run.totals.rejected, 0U);
    for (std::size_t i = 0; i < dvl.size(); ++i) {
      const auto& [decoded, s] = dvl[i];
      const auto& ping = pings[i];
      ASSERT_TRUE(decoded.time.clock_ns.has_value());
      EXPECT_EQ(to_iso8601(*decoded.time.clock_ns, 2), ping["TS"].get<std::string>() + "Z");
      EXPECT_EQ(known(s.velocity_D_m_s[0]), ping["bottom_lock"].get<bool>());
      const double range_m = ping["range_m"].get<double>();
      EXPECT_EQ(known(s.altitude_m), range_m > 0.0);
      if (range_m > 0.0) {
        EXPECT_EQ(s.altitude_m, range_m);
      }
      if (ping.contains("c")) {
        EXPECT_EQ(s.sound_speed_m_s, ping["c"].get<double>());
      }
      if (ping["BI"].is_null()) continue;
      const auto sent = ping["BI"].get<Frd>();
      const bool water_linked = name.starts_with("waterlinked");
      const Frd frd = water_linked ? sent : Frd{sent[1], sent[0], -sent[2]};
      for (std::size_t axis = 0; axis < 3; ++axis) EXPECT_DOUBLE_EQ(s.velocity_D_m_s[axis] * 1e3, frd[axis]);
      EXPECT_EQ(known(s.error_velocity_m_s), !ping["BI_err"].is_null());
    }
    capture::report(folder / name, run, dvl.size(), 0);
  }
  EXPECT_GE(files, 2U);
}

}  // namespace
}  // namespace fathom::codec
