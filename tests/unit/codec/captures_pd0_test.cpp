// Teledyne recordings against the bottom tracks that other decoders read from them.
#include <cmath>
#include <map>
#include <regex>

#include <gtest/gtest.h>

#include "base/units.hpp"
#include "capture.hpp"
#include "codec/dvl/pd0_geometry.hpp"
#include "support/data.hpp"

namespace fathom::codec::capture {
namespace {

/// One ensemble as expected, in the recorded axes; unknown where another decoder says "bad".
struct Expected {
  std::array<double, 4> velocity_m_s{kUnknown, kUnknown, kUnknown, kUnknown};
  std::array<double, 4> range_m{kUnknown, kUnknown, kUnknown, kUnknown};
  double heading_deg = kUnknown;
  double pitch_deg = kUnknown;
  double roll_deg = kUnknown;
  double sound_speed_m_s = kUnknown;
  double unix_time_s = kUnknown;
  std::array<double, 4> water_m_s{kUnknown, kUnknown, kUnknown, kUnknown};
  bool knows_water = false;
};

double millimetres(const std::string& text) {
  const double value = std::stod(text);
  return value == -32768.0 ? kUnknown : value / 1000.0;
}

double positive(double value) {
  return value > 0.0 ? value : kUnknown;
}

std::vector<Expected> read_csv(const std::filesystem::path& file) {
  const auto rows = lines(file);
  const bool centidegrees = rows.at(0).starts_with("heading_cdeg");
  std::vector<Expected> all;
  for (std::size_t r = 1; r < rows.size(); ++r) {
    if (rows[r].empty()) continue;
    const auto f = split(rows[r], ',');
    Expected e;
    if (centidegrees) {
      e.heading_deg = std::stod(f[0]) / 100.0;
      e.pitch_deg = std::stod(f[1]) / 100.0;
      e.roll_deg = std::stod(f[2]) / 100.0;
      for (std::size_t i = 0; i < 4; ++i) e.velocity_m_s[i] = millimetres(f[3 + i]);
      for (std::size_t i = 0; i < 4; ++i) e.range_m[i] = positive(std::stod(f[7 + i]) / 100.0);
    } else {
      e.unix_time_s = std::stod(f[1]);
      e.heading_deg = std::stod(f[2]);
      e.pitch_deg = std::stod(f[3]);
      e.roll_deg = std::stod(f[4]);
      for (std::size_t i = 0; i < 4; ++i)
        e.velocity_m_s[i] = f[5 + i].empty() ? kUnknown : std::stod(f[5 + i]);
      for (std::size_t i = 0; i < 4; ++i) e.range_m[i] = positive(std::stod(f[9 + i]));
    }
    all.push_back(e);
  }
  return all;
}

/// The particles of an ooi yml: `key: number` pairs in file order, one ensemble per bt_beam1_range.
std::vector<Expected> read_yml(const std::filesystem::path& file) {
  std::string all;
  for (const auto& line : lines(file)) all += line + "\n";
  std::map<std::string, std::vector<double>> numbers;
  static const std::regex pair(R"(([a-z_0-9]+):\s*(-?\d+(?:\.\d+)?)\b)");
  for (std::sregex_iterator it(all.begin(), all.end(), pair), end; it != end; ++it) {
    numbers[(*it)[1]].push_back(std::stod((*it)[2]));
  }
  const std::size_t count = numbers["bt_beam1_range"].size();
  // In ship axes their labels are exchanged: what they call forward is component 1.
  const bool ship = numbers.contains("bt_forward_velocity");
  const auto axis = [&](const char* earth, const char* in_ship, const char* middle) {
    return std::string("bt_") + (ship ? in_ship : earth) + middle + "velocity";
  };
  const std::array<std::array<const char*, 2>, 4> names{{{"eastward_", "forward_"},
                                                         {"northward_", "starboard_"},
                                                         {"upward_", "vertical_"},
                                                         {"error_", "error_"}}};
  std::vector<Expected> found(count);
  for (std::size_t n = 0; n < count; ++n) {
    Expected& e = found[n];
    e.knows_water = true;
    for (std::size_t i = 0; i < 4; ++i) {
      const double v = numbers.at(axis(names[i][0], names[i][1], "")).at(n);
      const double w = numbers.at(axis(names[i][0], names[i][1], "ref_layer_")).at(n);
      if (v != -32768.0) e.velocity_m_s[i] = v / 1000.0;
      if (w != -32768.0) e.water_m_s[i] = w / 1000.0;
      e.range_m[i] = positive(numbers.at("bt_beam" + std::to_string(i + 1) + "_range").at(n) / 100.0);
    }
    e.heading_deg = numbers.at("heading").at(n) / 100.0;
    e.pitch_deg = numbers.at("pitch").at(n) / 100.0;
    e.roll_deg = numbers.at("roll").at(n) / 100.0;
    // Repeated only when something changed.
    const auto& sound_speed = numbers.at("speed_of_sound");
    if (sound_speed.size() == count) e.sound_speed_m_s = sound_speed[n];
  }
  return found;
}

/// Axes as recorded, from the sample's forward-right-down: the way back.
std::array<double, 3> as_recorded(const DvlSample& s) {
  const auto [forward, right, down] = s.velocity_D_m_s;
  const std::array<double, 3> ship{-right, -forward, down};
  if (s.recorded_frame != DvlFrame::earth) return ship;
  const auto R = pd0::earth_from_ship(s.heading_rad, s.pitch_rad, s.roll_rad);
  return {R[0] * ship[0] + R[1] * ship[1] + R[2] * ship[2], R[3] * ship[0] + R[4] * ship[1] + R[5] * ship[2],
          R[6] * ship[0] + R[7] * ship[1] + R[8] * ship[2]};
}

bool same(double a, double b, double tolerance) {
  return known(a) ? std::abs(a - b) <= tolerance : !known(b);
}

std::size_t differences(const DvlSample& s, double clock_s, const Expected& e) {
  std::size_t n = 0;
  const auto v = as_recorded(s);
  for (std::size_t i = 0; i < 3; ++i) n += !same(e.velocity_m_s[i], v[i], 1e-9);
  n += !same(e.velocity_m_s[3], s.error_velocity_m_s, 1e-9);
  for (std::size_t i = 0; i < 4; ++i) n += !same(e.range_m[i], s.beam_range_m[i], 1e-9);
  n += !same(e.heading_deg, s.heading_rad * kDegPerRad, 1e-9);
  n += !same(e.pitch_deg, s.pitch_rad * kDegPerRad, 1e-9);
  n += !same(e.roll_deg, s.roll_rad * kDegPerRad, 1e-9);
  if (known(e.sound_speed_m_s)) n += !same(e.sound_speed_m_s, s.sound_speed_m_s, 1e-9);
  if (known(e.unix_time_s)) n += !same(e.unix_time_s, clock_s, 1e-3);
  return n;
}

struct Pair {
  const char* recording;
  const char* expected;
};

class Pd0Captures : public ::testing::TestWithParam<Pair> {};

TEST_P(Pd0Captures, AgreeWithOtherDecoders) {
  const auto file = root() / "pd0" / GetParam().recording;
  const auto reference = root() / "pd0" / GetParam().expected;
  if (!std::filesystem::exists(file)) FATHOM_DATA_IS_MISSING(file << " is not there");
  const auto expected = reference.extension() == ".yml" ? read_yml(reference) : read_csv(reference);
  const Harvest run = decode("pd0", load(file));
  std::size_t compared = 0;
  std::size_t mismatches = 0;
  std::vector<Decoded> bottoms;
  std::map<std::uint64_t, DvlSample> water;  // by offset of the ensemble
  for (const auto& [decoded, sample] : of_kind<DvlSample>(run)) {
    if (sample.mode == DvlMode::bottom) {
      bottoms.push_back(decoded);
    } else {
      water[decoded.offset] = sample;
    }
  }
  ASSERT_FALSE(expected.empty());
  ASSERT_GE(bottoms.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const auto& sample = std::get<DvlSample>(bottoms[i].sample);
    ASSERT_TRUE(bottoms[i].time.clock_ns.has_value());
    const std::size_t n = differences(sample, to_seconds(*bottoms[i].time.clock_ns), expected[i]);
    EXPECT_EQ(n, 0U) << "ensemble " << i;
    ++compared;
    mismatches += n;
    if (!expected[i].knows_water) continue;
    const auto found = water.find(bottoms[i].offset);
    ASSERT_EQ(found != water.end(), known(expected[i].water_m_s[0])) << "ensemble " << i;
    if (found == water.end()) continue;
    const auto v = as_recorded(found->second);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(v[axis], expected[i].water_m_s[axis], 1e-9) << "ensemble " << i;
    }
  }
  report(file, run, compared, mismatches);
}

INSTANTIATE_TEST_SUITE_P(
    All, Pd0Captures,
    ::testing::Values(Pair{"mhkit/RDI_withBT.000", "mhkit/RDI_withBT.expected_bt.csv"},
                      Pair{"mhkit/winriver02.PD0", "mhkit/winriver02.expected_bt.csv"},
                      Pair{"ooi_explorer_dvl/ND161646.PD0", "ooi_explorer_dvl/ND161646.expected_bt.csv"},
                      Pair{"ooi_explorer_dvl/ND161646.PD0", "ooi_explorer_dvl/ND161646.yml"},
                      Pair{"ooi_explorer_dvl/ND072022.PD0", "ooi_explorer_dvl/ND072022_recov.yml"},
                      Pair{"ooi_explorer_dvl/ND072023.PD0", "ooi_explorer_dvl/ND072023_recov.yml"},
                      Pair{"ooi_explorer_dvl/NE051351.PD0", "ooi_explorer_dvl/NE051351.yml"},
                      Pair{"ooi_remus/adcp_auv_51.pd0", "ooi_remus/adcp_auv_51.expected_bt.csv"},
                      Pair{"ooi_remus/adcp_auv_51.pd0", "ooi_remus/adcp_auv_51.yml"},
                      Pair{"ooi_remus/adcp_auv_3.pd0", "ooi_remus/adcp_auv_3.yml"}));

struct Count {
  const char* recording;
  std::uint64_t samples;
  std::uint64_t ignored;
};

class Pd0Counts : public ::testing::TestWithParam<Count> {};

/// The ensembles without bottom track as well: none is lost, none invented; the last is cut in some files.
TEST_P(Pd0Counts, EveryEnsembleIsFound) {
  const auto file = root() / "pd0" / GetParam().recording;
  if (!std::filesystem::exists(file)) FATHOM_DATA_IS_MISSING(file << " is not there");
  const Harvest run = decode("pd0", load(file));
  report(file, run, 0, 0);
  EXPECT_EQ(run.totals.samples, GetParam().samples);
  EXPECT_EQ(run.totals.frames_ignored, GetParam().ignored);
  for (const Rejected& rejected : run.rejected) EXPECT_EQ(rejected.reason, RejectReason::truncated);
  EXPECT_LE(run.totals.rejected, 1U);
}

INSTANTIATE_TEST_SUITE_P(
    All, Pd0Counts,
    ::testing::Values(Count{"mhkit/RDI_withBT.000", 1721, 0}, Count{"mhkit/RDI_test01.000", 0, 22},
                      Count{"mhkit/RDI_7f79_2.000", 0, 2 + 1230}, Count{"mhkit/sentinelv_b5.pd0", 0, 50},
                      Count{"mhkit/winriver02.PD0", 75, 0}, Count{"ooi_workhorse/ADCP_CCE1T_20.000", 0, 20},
                      Count{"ooi_workhorse/ADCP_data_20130702.000", 0, 1},
                      Count{"ooi_explorer_dvl/ND161646.PD0", 76, 0}, Count{"whoi_ds/pass.bin", 4, 0}));

TEST(Pd0Captures, LostBottomIsAliveWithoutVelocity) {
  const auto file = root() / "pd0/mhkit/RDI_withBT.000";
  if (!std::filesystem::exists(file)) FATHOM_DATA_IS_MISSING(file << " is not there");
  const Harvest run = decode("pd0", load(file));
  std::size_t lost = 0;
  std::size_t three_beams = 0;
  for (const auto& [decoded, s] : of_kind<DvlSample>(run)) {
    const bool velocity = known(s.velocity_D_m_s[0]);
    lost += !velocity;
    three_beams += velocity && !known(s.error_velocity_m_s);
  }
  EXPECT_EQ(lost, 820U);
  EXPECT_EQ(three_beams, 3U);
}

/// A vehicle that swims ahead: forward is positive, to port and starboard it hardly moves.
TEST(Pd0Captures, AheadIsPositive) {
  const auto file = root() / "pd0/ooi_remus/adcp_auv_51.pd0";
  if (!std::filesystem::exists(file)) FATHOM_DATA_IS_MISSING(file << " is not there");
  double fastest = 0.0;
  const Harvest run = decode("pd0", load(file));
  for (const auto& [decoded, s] : of_kind<DvlSample>(run)) {
    EXPECT_EQ(s.recorded_frame, DvlFrame::ship);
    EXPECT_GT(s.velocity_D_m_s[0], 0.0);
    fastest = std::max(fastest, s.velocity_D_m_s[0]);
  }
  EXPECT_GT(fastest, 1.5);
}

}  // namespace
}  // namespace fathom::codec::capture
