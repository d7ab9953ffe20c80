// Recordings of Nortek DVLs against what others read from them, and against themselves: which way the axes
// and the beams look, what moves, and what a figure of merit is.
#include <algorithm>
#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include "base/units.hpp"
#include "capture.hpp"
#include "support/data.hpp"

namespace fathom::codec::capture {
namespace {

constexpr const char* kNortekAfloat = "nortek_dvl/smarc_dvl333/dvl_first6000.bin";
// Of beams 1 to 4, from forward towards right.
constexpr std::array<double, 4> kNortekAzimuth_deg{45.0, -45.0, -135.0, 135.0};

/// As six digits tell.
bool same_six_digits(double printed, double got) {
  return std::abs(printed - got) <= 6e-6 * std::abs(printed) + 1e-9;
}

TEST(NortekCaptures, AgreeWithAnotherDecoding) {
  const auto file = root() / kNortekAfloat;
  if (!std::filesystem::exists(file)) FATHOM_DATA_IS_MISSING(file << " is not there");
  const Harvest run = decode("nortek", load(file));
  const auto dvl = of_kind<DvlSample>(run);
  auto rows = lines(root() / "nortek_dvl/smarc_dvl333/dvl_first6000.decoded_by_us.csv");
  const auto header = split(rows.at(0), ',');
  rows.erase(rows.begin());
  ASSERT_EQ(dvl.size(), rows.size());
  EXPECT_EQ(run.totals.rejected, 0U);
  EXPECT_EQ(run.totals.skipped_bytes, 53U);  // the recording begins inside a record
  std::size_t compared = 0;
  std::size_t mismatches = 0;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const auto fields = split(rows[r], ',');
    ASSERT_EQ(fields.size(), header.size());
    const auto text_of = [&](const std::string& name) {
      return fields[static_cast<std::size_t>(std::find(header.begin(), header.end(), name) - header.begin())];
    };
    const auto number = [&](const std::string& name) { return std::stod(text_of(name)); };
    const auto& [decoded, s] = dvl[r];
    ASSERT_TRUE(decoded.time.clock_ns && decoded.time.age_ns);
    const double fom = std::sqrt(0.5 * (std::pow(number("fomX"), 2) + std::pow(number("fomY"), 2)));
    const double z1 = number("velZ1");
    const double z2 = number("velZ2");
    std::vector<std::pair<double, double>> pairs{{number("offset"), static_cast<double>(decoded.offset)},
                                                 {number("sound_speed"), s.sound_speed_m_s},
                                                 {number("velX"), s.velocity_D_m_s[0]},
                                                 {number("velY"), s.velocity_D_m_s[1]},
                                                 {fom, s.sigma_m_s},
                                                 {-number("dt2X"), to_seconds(*decoded.time.age_ns)}};
    for (std::size_t i = 0; i < 4; ++i) {
      pairs.emplace_back(number("velBeam" + std::to_string(i)), s.beam_velocity_m_s[i]);
      pairs.emplace_back(number("distBeam" + std::to_string(i)), s.beam_range_m[i]);
    }
    bool agrees = text_of("type") == "0x1b" && s.mode == DvlMode::bottom;
    for (const auto& [expected, got] : pairs) agrees = agrees && same_six_digits(expected, got);
    agrees = agrees && std::abs(0.5 * (z1 + z2) - s.velocity_D_m_s[2]) < 1e-6;
    agrees = agrees && std::abs(1.5164 * (z1 - z2) - s.error_velocity_m_s) < 2e-6;
    // The instant that the table prints to 0.1 ms, and dt1 after it.
    const TimeNs echo_ns = *decoded.time.clock_ns;
    const TimeNs trigger_ns = echo_ns - from_seconds(number("dt1X"));
    agrees = agrees && to_iso8601(trigger_ns + 500, 4) == text_of("time") + "Z";
    EXPECT_TRUE(agrees) << "record " << r;
    compared += pairs.size() + 4;
    mismatches += !agrees;
  }
  EXPECT_EQ(rows.size(), 6000U);
  report(file, run, compared, mismatches);
}

/// The instrument's own velocity lies on its beams as documented: what AID-BEAM-1 makes of it is what they
/// measured.
TEST(NortekCaptures, BeamVelocityIsTheInstrumentsAlongTheOutwardBeam) {
  const auto file = root() / kNortekAfloat;
  if (!std::filesystem::exists(file)) FATHOM_DATA_IS_MISSING(file << " is not there");
  const Harvest run = decode("nortek", load(file));
  constexpr double kAngle_rad = 24.9 * kRadPerDeg;  // of this one; nominally 25
  std::size_t moving = 0;
  double worst = 0.0;
  for (const auto& [decoded, s] : of_kind<DvlSample>(run)) {
    std::array<double, 3> back{};
    for (std::size_t i = 0; i < 4; ++i) {
      const double azimuth = kNortekAzimuth_deg[i] * kRadPerDeg;
      const double b = s.beam_velocity_m_s[i];
      back[0] += b * std::cos(azimuth) / (2.0 * std::sin(kAngle_rad));
      back[1] += b * std::sin(azimuth) / (2.0 * std::sin(kAngle_rad));
      back[2] += b / (4.0 * std::cos(kAngle_rad));
    }
    for (std::size_t i = 0; i < 3; ++i) worst = std::max(worst, std::abs(back[i] - s.velocity_D_m_s[i]));
    moving += std::hypot(s.velocity_D_m_s[0], s.velocity_D_m_s[1]) > 0.2;
  }
  EXPECT_GT(moving, 5000U);
  EXPECT_LT(worst, 1e-4);
}

/// Over a bottom that slopes, the distance to it changes as the slope times the velocity of the instrument.
/// Were the velocity that of the bottom past the instrument, it would change the other way.
TEST(NortekCaptures, VelocityIsTheInstrumentsOverTheGround) {
  const auto file = root() / kNortekAfloat;
  if (!std::filesystem::exists(file)) FATHOM_DATA_IS_MISSING(file << " is not there");
  const Harvest run = decode("nortek", load(file));
  const auto dvl = of_kind<DvlSample>(run);
  const double reach =
      std::tan(24.9 * kRadPerDeg) * std::sqrt(0.5);  // of a beam along X, each metre of height
  constexpr std::size_t kPings = 40;                 // one a second
  double rates_expected = 0.0;
  double both = 0.0;
  double rates = 0.0;
  for (std::size_t from = 0; from + kPings <= dvl.size(); from += kPings) {
    double expected = 0.0;  // m/s
    double moment = 0.0;
    double weight = 0.0;
    for (std::size_t i = 0; i < kPings; ++i) {
      const DvlSample& s = dvl[from + i].second;
      const auto& d = s.beam_range_m;
      const double gradient_x = (d[0] + d[1] - d[2] - d[3]) / (4.0 * s.altitude_m * reach);
      const double gradient_y = (d[0] + d[3] - d[1] - d[2]) / (4.0 * s.altitude_m * reach);
      expected += (gradient_x * s.velocity_D_m_s[0] + gradient_y * s.velocity_D_m_s[1]) / kPings;
      const double t = static_cast<double>(i) - 0.5 * (kPings - 1);
      moment += t * s.altitude_m;
      weight += t * t;
    }
    const double rate = moment / weight;
    rates_expected += expected * expected;
    both += expected * rate;
    rates += rate * rate;
  }
  EXPECT_GT(both / std::sqrt(rates_expected * rates), 0.95);
  EXPECT_NEAR(both / rates_expected, 1.0, 0.1);
}

/// Z1 and Z2 differ by their noise, which as error velocity is that of a horizontal component: its figure of
/// merit is its standard deviation.
TEST(NortekCaptures, TheFigureOfMeritIsTheStandardDeviationOfAPing) {
  const auto file = root() / kNortekAfloat;
  if (!std::filesystem::exists(file)) FATHOM_DATA_IS_MISSING(file << " is not there");
  const Harvest run = decode("nortek", load(file));
  std::vector<double> ratios;
  for (const auto& [decoded, s] : of_kind<DvlSample>(run)) {
    ASSERT_TRUE(known(s.sigma_m_s));
    ratios.push_back(std::abs(s.error_velocity_m_s) / s.sigma_m_s);
  }
  const auto middle = ratios.begin() + static_cast<std::ptrdiff_t>(ratios.size() / 2);
  std::nth_element(ratios.begin(), middle, ratios.end());
  EXPECT_NEAR(*middle / 0.6745, 1.0, 0.15);
}

TEST(NortekCaptures, InAirNothingIsKnown) {
  const auto file = root() / "nortek_dvl/whoi_ds/pass.bin";
  if (!std::filesystem::exists(file)) FATHOM_DATA_IS_MISSING(file << " is not there");
  const Harvest run = decode("nortek", load(file));
  const auto dvl = of_kind<DvlSample>(run);
  ASSERT_EQ(dvl.size(), 1U);
  for (const double v : dvl[0].second.velocity_D_m_s) EXPECT_FALSE(known(v));
  EXPECT_FALSE(known(dvl[0].second.altitude_m));
  EXPECT_EQ(run.totals.rejected, 0U);
  report(file, run, 1, 0);
}

/// A profiler of the same family: bursts, its own bottom track (0x17), echo sounder and text, none of them a
/// DVL's.
TEST(NortekCaptures, AProfilersRecordsAreIgnored) {
  const auto file = root() / "nortek_dvl/ad2cp_signature/VelEchoBT01.ad2cp";
  if (!std::filesystem::exists(file)) FATHOM_DATA_IS_MISSING(file << " is not there");
  const Harvest run = decode("nortek", load(file));
  EXPECT_EQ(run.totals.samples, 0U);
  EXPECT_EQ(run.totals.frames_ignored, 160U + 160U + 159U + 159U + 1U);
  ASSERT_EQ(run.rejected.size(), 1U);  // the last one is cut
  EXPECT_EQ(run.rejected[0].reason, RejectReason::truncated);
  EXPECT_EQ(run.rejected[0].offset, 998'801U);
  EXPECT_EQ(run.totals.skipped_bytes, 0U);
  report(file, run, 0, 0);
}

}  // namespace
}  // namespace fathom::codec::capture
