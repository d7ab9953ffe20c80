#include "codec/dvl/pd0.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "base/bytes/little_endian.hpp"
#include "base/units.hpp"
#include "capture.hpp"
#include "codec/dvl/pd0_layout.hpp"

namespace fathom::codec::pd0_test {
namespace {

using capture::ByteVector;
using capture::decode;
using capture::Harvest;
using capture::of_kind;

constexpr std::int16_t kBad = pd0::kBadVelocity;

template <class T>
void store(ByteVector& bytes, std::size_t at, T value) {
  std::memcpy(bytes.data() + at, &value, sizeof value);
}

ByteVector part(std::uint16_t identifier, std::size_t length) {
  ByteVector bytes(length, 0);
  store(bytes, 0, identifier);
  return bytes;
}

/// An ensemble of parts, with header, offsets and checksum.
struct Ensemble {
  std::uint16_t configuration = 0x4248;  // 30 degrees, convex, down
  std::uint8_t coordinates = 0x0F;       // instrument, tilts
  std::uint16_t heading_cdeg = 0;
  std::int16_t pitch_cdeg = 0;
  std::int16_t roll_cdeg = 0;
  std::array<std::int16_t, 4> velocity_mm_s{100, -1000, 50, 3};
  std::array<std::uint32_t, 4> range_cm{1000, 1010, 990, 1000};
  std::array<std::int16_t, 4> water_mm_s{kBad, kBad, kBad, kBad};
  std::vector<ByteVector> more;

  [[nodiscard]] std::vector<ByteVector> parts() const {
    auto fixed = part(pd0::id::kFixedLeader, 59);
    store(fixed, 4, configuration);
    fixed[8] = 4;
    fixed[25] = coordinates;
    auto leader = part(pd0::id::kVariableLeader, 65);
    const std::array<std::uint8_t, 7> clock{26, 1, 31, 12, 30, 15, 25};
    std::copy(clock.begin(), clock.end(), leader.begin() + 4);
    leader[57] = 20;
    std::copy(clock.begin(), clock.end(), leader.begin() + 58);
    store<std::uint16_t>(leader, 14, 1485);
    store(leader, 18, heading_cdeg);
    store(leader, 20, pitch_cdeg);
    store(leader, 22, roll_cdeg);
    auto track = part(pd0::id::kBottomTrack, 81);
    for (std::size_t i = 0; i < 4; ++i) {
      store(track, 16 + 2 * i, static_cast<std::uint16_t>(range_cm[i] & 0xFFFFU));
      track[77 + i] = static_cast<std::uint8_t>(range_cm[i] >> 16);
      store(track, 24 + 2 * i, velocity_mm_s[i]);
      store(track, 50 + 2 * i, water_mm_s[i]);
    }
    std::vector<ByteVector> all{fixed, leader, track};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
};

void add_checksum(ByteVector& bytes) {
  std::uint16_t sum = 0;
  for (const std::uint8_t byte : bytes) sum = static_cast<std::uint16_t>(sum + byte);
  append_le<std::uint16_t>(bytes, sum);
}

ByteVector join(const std::vector<ByteVector>& parts) {
  ByteVector bytes{0x7F, 0x7F, 0, 0, 0, static_cast<std::uint8_t>(parts.size())};
  std::size_t offset = 6 + 2 * parts.size();
  for (const auto& p : parts) {
    append_le<std::uint16_t>(bytes, static_cast<std::uint16_t>(offset));
    offset += p.size();
  }
  for (const auto& p : parts) bytes.insert(bytes.end(), p.begin(), p.end());
  store(bytes, 2, static_cast<std::uint16_t>(bytes.size()));
  add_checksum(bytes);
  return bytes;
}

ByteVector operator+(ByteVector a, const ByteVector& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

DvlSample read(const Ensemble& ensemble, const CodecOptions& options = {}) {
  const Harvest run = decode("pd0", join(ensemble.parts()), {}, options);
  EXPECT_TRUE(run.rejected.empty());
  const auto dvl = of_kind<DvlSample>(run);
  EXPECT_EQ(dvl.size(), 1U);
  return dvl.empty() ? DvlSample{} : dvl[0].second;
}

void expect_velocity(const DvlSample& s, double forward, double right, double down) {
  EXPECT_NEAR(s.velocity_D_m_s[0], forward, 1e-12);
  EXPECT_NEAR(s.velocity_D_m_s[1], right, 1e-12);
  EXPECT_NEAR(s.velocity_D_m_s[2], down, 1e-12);
}

TEST(Pd0, InstrumentAxesOfADownwardDvl) {
  const DvlSample s = read({});
  expect_velocity(s, 1.0, -0.1, 0.05);  // the bottom goes aft when the vehicle goes ahead
  EXPECT_DOUBLE_EQ(s.error_velocity_m_s, 0.003);
  EXPECT_DOUBLE_EQ(s.altitude_m, 10.0);
  EXPECT_DOUBLE_EQ(s.beam_range_m[1], 10.1);
  EXPECT_EQ(s.sound_speed_m_s, 1485.0);
  EXPECT_NEAR(s.beam_angle_rad, 30.0 * kRadPerDeg, 1e-12);
  EXPECT_EQ(s.recorded_frame, DvlFrame::instrument);
}

TEST(Pd0, UpwardDvlHasXAndZTheOtherWay) {
  Ensemble e;
  e.configuration |= 0x80U;
  expect_velocity(read(e), 1.0, 0.1, -0.05);
  e.coordinates = 0x17;  // ship axes are the ship's whichever way the instrument looks
  expect_velocity(read(e), 1.0, -0.1, 0.05);
}

TEST(Pd0, HeadingAlignmentTurnsInstrumentAxesOnly) {
  CodecOptions options;
  options.dvl_heading_alignment_rad = 90.0 * kRadPerDeg;  // beam 3 looks to starboard
  Ensemble e;
  expect_velocity(read(e, options), 0.1, 1.0, 0.05);
  e.coordinates = 0x17;
  expect_velocity(read(e, options), 1.0, -0.1, 0.05);
}

TEST(Pd0, EarthAxesAreTurnedBackByTheLeadersAttitude) {
  Ensemble e;
  e.coordinates = 0x1F;
  e.heading_cdeg = 9'000;              // east
  e.velocity_mm_s = {-1000, 0, 0, 0};  // the bottom goes west
  expect_velocity(read(e), 1.0, 0.0, 0.0);
  e.pitch_cdeg = 3'000;  // bow up: going level east is then forward and down in the vehicle's axes
  expect_velocity(read(e), std::cos(30.0 * kRadPerDeg), 0.0, std::sin(30.0 * kRadPerDeg));
  e.coordinates = 0x1B;  // tilts not used by the instrument: not taken back either
  expect_velocity(read(e), 1.0, 0.0, 0.0);
  e.coordinates = 0x1F;
  e.pitch_cdeg = 0;
  e.heading_cdeg = 0;
  e.roll_cdeg = 9'000;  // starboard side down; going east is then up along the mast's side
  expect_velocity(read(e), 0.0, 0.0, -1.0);
}

TEST(Pd0, BeamAxes) {
  Ensemble e;
  e.coordinates = 0x07;
  // v = (forward 1, right 0.5, down 0.2) on beams 30 degrees off: 0.5 s and 0.866 c.
  const double c = std::cos(30.0 * kRadPerDeg) * 0.2;
  const std::array<double, 4> along{-0.25 + c, 0.25 + c, 0.5 + c, -0.5 + c};
  for (std::size_t i = 0; i < 4; ++i)
    e.velocity_mm_s[i] = static_cast<std::int16_t>(std::lround(along[i] * 1e3));
  DvlSample s = read(e);
  EXPECT_NEAR(s.velocity_D_m_s[0], 1.0, 1e-3);
  EXPECT_NEAR(s.velocity_D_m_s[1], 0.5, 1e-3);
  EXPECT_NEAR(s.velocity_D_m_s[2], 0.2, 1e-3);
  EXPECT_NEAR(s.beam_velocity_m_s[2], along[2], 5e-4);
  EXPECT_NEAR(s.error_velocity_m_s, 0.0, 2e-3);
  // A concave head crosses its beams.
  Ensemble concave = e;
  concave.configuration &= static_cast<std::uint16_t>(~0x08U);
  EXPECT_NEAR(read(concave).velocity_D_m_s[0], -1.0, 1e-3);
  // Two opposite beams: what they measure, and nothing else.
  e.velocity_mm_s[0] = e.velocity_mm_s[1] = kBad;
  s = read(e);
  EXPECT_NEAR(s.velocity_D_m_s[0], 1.0, 1e-3);
  EXPECT_FALSE(known(s.velocity_D_m_s[1]));
  EXPECT_NEAR(s.velocity_D_m_s[2], 0.2, 1e-3);
  // Two neighbours measure no axis.
  e.velocity_mm_s = {100, kBad, 100, kBad};
  s = read(e);
  EXPECT_FALSE(known(s.velocity_D_m_s[0]) || known(s.velocity_D_m_s[1]) || known(s.velocity_D_m_s[2]));
}

TEST(Pd0, ComponentsAreValidOneByOne) {
  Ensemble e;
  e.velocity_mm_s = {kBad, -1000, kBad, kBad};
  const DvlSample s = read(e);
  EXPECT_EQ(s.velocity_D_m_s[0], 1.0);
  EXPECT_FALSE(known(s.velocity_D_m_s[1]));
  EXPECT_FALSE(known(s.velocity_D_m_s[2]));
}

TEST(Pd0, WaterLayerIsASecondSample) {
  Ensemble e;
  e.velocity_mm_s = {kBad, kBad, kBad, kBad};
  e.range_cm = {0, 0, 0, 0};
  e.water_mm_s = {10, -700, 20, 1};
  const Harvest run = decode("pd0", join(e.parts()));
  const auto dvl = of_kind<DvlSample>(run);
  ASSERT_EQ(dvl.size(), 2U);
  EXPECT_EQ(dvl[0].second.mode, DvlMode::bottom);
  EXPECT_FALSE(known(dvl[0].second.velocity_D_m_s[0]));
  EXPECT_FALSE(known(dvl[0].second.altitude_m));
  EXPECT_EQ(dvl[1].second.mode, DvlMode::water);
  EXPECT_DOUBLE_EQ(dvl[1].second.velocity_D_m_s[0], 0.7);
}

TEST(Pd0, WaterLayerOfZerosWithoutAGoodPingIsNone) {
  Ensemble e;
  e.water_mm_s = {0, 0, 0, 0};
  EXPECT_EQ(decode("pd0", join(e.parts())).totals.samples, 1U);
}

TEST(Pd0, LongRangesUseTheHighByte) {
  Ensemble e;
  e.range_cm = {70'000, 70'000, 70'000, 0};
  const DvlSample s = read(e);
  EXPECT_DOUBLE_EQ(s.beam_range_m[0], 700.0);
  EXPECT_DOUBLE_EQ(s.altitude_m, 700.0);
  EXPECT_FALSE(known(s.beam_range_m[3]));
}

TEST(Pd0, HighResolutionRefinesWhatItAgreesWith) {
  Ensemble e;
  auto fine = part(pd0::id::kHighResolution, 70);
  const std::array<std::int32_t, 4> velocity{-10'034, 100'021, 99'999, pd0::kBadHighResolution};
  for (std::size_t i = 0; i < 4; ++i) store(fine, 2 + 4 * i, velocity[i]);
  e.more = {fine};
  const DvlSample s = read(e);
  EXPECT_DOUBLE_EQ(s.velocity_D_m_s[1], -0.10034);
  EXPECT_DOUBLE_EQ(s.velocity_D_m_s[0], 1.00021);
  EXPECT_DOUBLE_EQ(s.velocity_D_m_s[2], 0.05);  // a metre per second away from 0x0600: not the same thing
  EXPECT_DOUBLE_EQ(s.error_velocity_m_s, 0.003);
}

TEST(Pd0, SigmaFromNavigationParametersGrowsWithThreeBeams) {
  Ensemble e;
  auto navigation = part(pd0::id::kNavigation, 85);
  for (std::size_t i = 0; i < 4; ++i) store<std::uint16_t>(navigation, 18 + 2 * i, 4);
  e.more = {navigation};
  EXPECT_NEAR(read(e).sigma_m_s, 0.004, 1e-12);
  e.velocity_mm_s[3] = kBad;
  EXPECT_NEAR(read(e).sigma_m_s, 0.004 * std::sqrt(3.0), 1e-12);
}

TEST(Pd0, ClockWithAndWithoutCentury) {
  const Ensemble e;
  auto parts = e.parts();
  const auto stamp = [&] {
    const Harvest run = decode("pd0", join(parts));
    return run.samples.at(0).time.clock_ns ? to_iso8601(*run.samples[0].time.clock_ns) : "none";
  };
  EXPECT_EQ(stamp(), "2026-01-31T12:30:15.250Z");
  parts[1].resize(57);
  EXPECT_EQ(stamp(), "2026-01-31T12:30:15.250Z");
  parts[1][4] = 99;
  EXPECT_EQ(stamp(), "1999-01-31T12:30:15.250Z");
  parts[1][5] = 13;
  EXPECT_EQ(stamp(), "none");
}

TEST(Pd0, UnknownTypesAreSkippedAndEnsemblesWithoutBottomTrackIgnored) {
  Ensemble e;
  e.more = {part(0x7004, 40), part(0x2022, 17)};
  EXPECT_EQ(decode("pd0", join(e.parts())).totals.samples, 1U);
  auto parts = e.parts();
  parts.erase(parts.begin() + 2);
  const Harvest run = decode("pd0", join(parts));
  EXPECT_EQ(run.totals.samples, 0U);
  EXPECT_EQ(run.totals.frames_ignored, 1U);
}

struct Pd0Fault {
  const char* name;
  ByteVector bytes;
  RejectReason reason;
};

/// The ensemble after `change`, its checksum made good again.
template <class Change>
ByteVector resummed(Change change) {
  auto bytes = join(Ensemble{}.parts());
  bytes.resize(bytes.size() - 2);
  change(bytes);
  add_checksum(bytes);
  return bytes;
}

ByteVector damaged() {
  auto bytes = join(Ensemble{}.parts());
  bytes[100] ^= 0x10U;
  return bytes;
}

ByteVector without(std::size_t which) {
  auto parts = Ensemble{}.parts();
  parts.erase(parts.begin() + static_cast<std::ptrdiff_t>(which));
  return join(parts);
}

ByteVector cut_track() {
  auto parts = Ensemble{}.parts();
  parts[2].resize(30);
  return join(parts);
}

class Pd0Faults : public ::testing::TestWithParam<Pd0Fault> {};

TEST_P(Pd0Faults, AreRefusedOnceAndTheNextEnsembleIsFound) {
  const Harvest run = decode("pd0", GetParam().bytes + join(Ensemble{}.parts()));
  ASSERT_EQ(run.rejected.size(), 1U);
  EXPECT_EQ(run.rejected[0].reason, GetParam().reason);
  EXPECT_EQ(run.rejected[0].offset, 0U);
  EXPECT_EQ(run.totals.samples, 1U);
}

INSTANTIATE_TEST_SUITE_P(
    All, Pd0Faults,
    ::testing::Values(
        Pd0Fault{"checksum", damaged(), RejectReason::checksum},
        Pd0Fault{"length_too_short", ByteVector{0x7F, 0x7F, 3, 0, 0, 1}, RejectReason::length},
        Pd0Fault{"length_too_long", ByteVector{0x7F, 0x7F, 0xFF, 0xFF, 0, 1}, RejectReason::length},
        Pd0Fault{"offset_into_the_header", resummed([](ByteVector& b) { store<std::uint16_t>(b, 6, 2); }),
                 RejectReason::structure},
        Pd0Fault{"offset_backwards", resummed([](ByteVector& b) { store<std::uint16_t>(b, 10, 20); }),
                 RejectReason::structure},
        Pd0Fault{"offset_past_the_end", resummed([](ByteVector& b) { store<std::uint16_t>(b, 10, 5000); }),
                 RejectReason::structure},
        Pd0Fault{"no_types", resummed([](ByteVector& b) { b[5] = 0; }), RejectReason::structure},
        Pd0Fault{"more_types_than_bytes", resummed([](ByteVector& b) { b[5] = 255; }),
                 RejectReason::structure},
        Pd0Fault{"no_fixed_leader", without(0), RejectReason::structure},
        Pd0Fault{"no_variable_leader", without(1), RejectReason::structure},
        Pd0Fault{"bottom_track_too_short", cut_track(), RejectReason::structure}),
    [](const auto& info) { return std::string(info.param.name); });

TEST(Pd0, WavePacketsBetweenEnsemblesAreIgnored) {
  ByteVector wave(78, 0x55);
  wave[0] = 0x7F;
  wave[1] = 0x79;
  store<std::uint16_t>(wave, 2, 78);
  add_checksum(wave);
  const auto good = join(Ensemble{}.parts());
  const Harvest run = decode("pd0", wave + good + wave + good);
  EXPECT_EQ(run.totals.samples, 2U);
  EXPECT_EQ(run.totals.frames_ignored, 2U);
  EXPECT_EQ(run.totals.skipped_bytes, 0U);
}

TEST(Pd0, EnsembleInsideARefusedOneIsFound) {
  // A lost byte in the first makes its length reach into the second.
  auto first = join(Ensemble{}.parts());
  first.erase(first.begin() + 60);
  const Harvest run = decode("pd0", first + join(Ensemble{}.parts()));
  EXPECT_EQ(run.totals.samples, 1U);
  EXPECT_EQ(run.totals.rejected, 1U);
  EXPECT_EQ(run.samples.at(0).offset, first.size());
}

}  // namespace
}  // namespace fathom::codec::pd0_test
