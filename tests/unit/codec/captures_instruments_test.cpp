// Water Linked, VectorNav, Xsens, Paroscientific and Kongsberg recordings against what others read from them.
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <map>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "base/units.hpp"
#include "capture.hpp"
#include "support/data.hpp"

namespace fathom::codec::capture {
namespace {

using Json = nlohmann::json;

/// Relative to the printed digits of a single-precision number.
bool near_float(double expected, double got) {
  return std::abs(expected - got) <= 1e-6 * std::abs(expected) + 1e-12;
}

TEST(WaterLinkedCaptures, AgreeWithTheRecordedTable) {
  const auto file = root() / "waterlinked_json/20211217.ndjson";
  const auto table = root() / "waterlinked_json/20211217-152655dvl_data_time.csv";
  if (!std::filesystem::exists(file)) FATHOM_DATA_IS_MISSING(file << " is not there");
  const Harvest run = decode("waterlinked", load(file));
  const auto dvl = of_kind<DvlSample>(run);
  auto rows = lines(table);
  const auto header = split(rows.at(0), ',');
  const auto column = [&](const std::string& name) {
    return static_cast<std::size_t>(std::find(header.begin(), header.end(), name) - header.begin());
  };
  rows.erase(rows.begin());
  ASSERT_EQ(dvl.size(), rows.size());
  EXPECT_EQ(run.totals.rejected, 0U);
  std::size_t mismatches = 0;
  std::size_t lost = 0;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const auto f = split(rows[r], ',');
    const DvlSample& s = dvl[r].second;
    const bool valid = f[column("velocity_valid")] == "True";
    lost += !valid;
    std::vector<std::pair<double, double>> pairs;
    const std::array<const char*, 3> axes{"vx", "vy", "vz"};
    for (std::size_t i = 0; i < 3; ++i) {
      pairs.emplace_back(valid ? std::stod(f[column(axes[i])]) : kUnknown, s.velocity_D_m_s[i]);
    }
    const double altitude = std::stod(f[column("altitude")]);
    pairs.emplace_back(altitude >= 0.0 ? altitude : kUnknown, s.altitude_m);
    for (std::size_t i = 0; i < 4; ++i) {
      const std::string prefix = "transducers_" + std::to_string(i) + "_";
      const bool beam = valid && f[column(prefix + "beam_valid")] == "True";
      pairs.emplace_back(beam ? std::stod(f[column(prefix + "velocity")]) : kUnknown, s.beam_velocity_m_s[i]);
      pairs.emplace_back(beam ? std::stod(f[column(prefix + "distance")]) : kUnknown, s.beam_range_m[i]);
    }
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const auto [expected, got] = pairs[i];
      const bool agrees = known(expected) ? expected == got : !known(got);
      EXPECT_TRUE(agrees) << "report " << r << ", value " << i << ": " << expected << " and " << got;
      mismatches += !agrees;
    }
  }
  EXPECT_EQ(lost, 34U);
  report(file, run, rows.size(), mismatches);
}

/// The instrument's own velocity lies on its beams as documented: outward, at 22.5 degrees, positive when the
/// vehicle moves along them.
TEST(WaterLinkedCaptures, BeamVelocityIsTheVehiclesAlongTheOutwardBeam) {
  const auto file = root() / "waterlinked_json/20211217.ndjson";
  if (!std::filesystem::exists(file)) FATHOM_DATA_IS_MISSING(file << " is not there");
  const Harvest run = decode("waterlinked", load(file));
  std::size_t moving = 0;
  double signal = 0.0;
  double residual = 0.0;
  for (const auto& [decoded, s] : of_kind<DvlSample>(run)) {
    if (!known(s.velocity_D_m_s[0])) continue;
    const std::array<double, 4> azimuth_deg{135.0, -135.0, -45.0, 45.0};
    for (std::size_t i = 0; i < 4; ++i) {
      if (!known(s.beam_velocity_m_s[i])) continue;
      const double azimuth = azimuth_deg[i] * 0.017453292519943295;
      const double predicted = std::sin(s.beam_angle_rad) * (std::cos(azimuth) * s.velocity_D_m_s[0] +
                                                             std::sin(azimuth) * s.velocity_D_m_s[1]) +
                               std::cos(s.beam_angle_rad) * s.velocity_D_m_s[2];
      signal += predicted * predicted;
      residual += std::pow(predicted - s.beam_velocity_m_s[i], 2);
      moving += std::abs(predicted) > 0.05;
    }
  }
  EXPECT_GT(moving, 50U);
  EXPECT_LT(residual, 0.01 * signal);
}

TEST(WaterLinkedCaptures, ObjectSpreadOverLines) {
  const auto file = root() / "waterlinked_json/dvl.json";
  if (!std::filesystem::exists(file)) FATHOM_DATA_IS_MISSING(file << " is not there");
  const Harvest run = decode("waterlinked", load(file));
  const auto dvl = of_kind<DvlSample>(run);
  ASSERT_EQ(dvl.size(), 1U);
  std::ifstream in(file);
  const Json expected = Json::parse(in);
  EXPECT_EQ(dvl[0].second.velocity_D_m_s[0], expected["vx"].get<double>());
  EXPECT_EQ(dvl[0].second.altitude_m, expected["altitude"].get<double>());
  EXPECT_EQ(dvl[0].second.sigma_m_s, expected["fom"].get<double>());
  EXPECT_EQ(run.totals.skipped_bytes, 0U);
  report(file, run, 1, 0);
}

TEST(VectorNavCaptures, AgreeWithTheLoggersOwnParser) {
  const auto file = root() / "vectornav/F00294";
  if (!std::filesystem::exists(file)) FATHOM_DATA_IS_MISSING(file << " is not there");
  const Harvest run = decode("vectornav", load(file));
  const auto imu = of_kind<ImuSample>(run);
  EXPECT_EQ(run.totals.rejected, 0U);
  ASSERT_EQ(imu.size(), 99U);
  const auto rows = lines(root() / "vectornav/F00294_B");
  // That parser lost one frame whose checksum is right.
  constexpr std::size_t kLostByParser = 78;
  std::size_t compared = 0;
  std::size_t mismatches = 0;
  for (std::size_t r = 1; r < rows.size(); ++r) {
    if (rows[r].empty()) continue;
    const auto f = split(rows[r], ',');
    const ImuSample& s = imu.at(r - 1 < kLostByParser ? r - 1 : r).second;
    bool agrees = near_float(std::stod(f[9]), s.temperature_degC);
    for (std::size_t i = 0; i < 3; ++i) {
      agrees = agrees && near_float(std::stod(f[3 + i]), s.specific_force_B_m_s2[i]);
      agrees = agrees && near_float(std::stod(f[6 + i]), s.angular_rate_B_rad_s[i]);
    }
    EXPECT_TRUE(agrees) << "row " << r;
    ++compared;
    mismatches += !agrees;
  }
  EXPECT_EQ(compared, 98U);
  report(file, run, compared, mismatches);
}

/// What somebody else's program printed of each message: names, and below them the values, "X:1.5" each.
std::vector<std::map<std::string, std::vector<double>>> golden_messages(const std::filesystem::path& file) {
  std::vector<std::map<std::string, std::vector<double>>> messages(1);
  std::string name;
  for (const std::string& line : lines(file)) {
    if (line.empty()) {
      messages.emplace_back();
    } else if (line.front() != ' ') {
      name = line.substr(0, line.find_first_of("(:"));
    } else if (name != "UTCTime" && name != "StatusWord") {
      const auto colon = line.find(':');
      messages.back()[name].push_back(
          std::strtod(line.c_str() + (colon == std::string::npos ? 0 : colon + 1), nullptr));
    }
  }
  return messages;
}

TEST(XsensCaptures, AgreeWithAnotherDriversDecoding) {
  for (const char* name : {"einride_1", "einride_2"}) {
    const auto file = root() / "xsens" / name / "output.bin";
    if (!std::filesystem::exists(file)) FATHOM_DATA_IS_MISSING(file << " is not there");
    const Harvest run = decode("xsens", load(file));
    EXPECT_EQ(run.totals.rejected, 0U);
    EXPECT_EQ(run.totals.skipped_bytes, 0U);
    const auto imu = of_kind<ImuSample>(run);
    std::size_t compared = 0;
    std::size_t mismatches = 0;
    for (auto& message : golden_messages(file.parent_path() / "output.golden")) {
      const auto& force = message["Acceleration"];
      const auto& rate = message["RateOfTurn"];
      if (force.size() != 3 || rate.size() != 3) continue;
      ASSERT_LT(compared, imu.size());
      const auto& [decoded, s] = imu[compared++];
      bool agrees = decoded.time.clock_ns == static_cast<TimeNs>(message["SampleTimeFine"].at(0)) * 100'000;
      for (std::size_t i = 0; i < 3; ++i) {
        const double sign = i == 0 ? 1.0 : -1.0;
        agrees = agrees && near_float(sign * force[i], s.specific_force_B_m_s2[i]);
        agrees = agrees && near_float(sign * rate[i], s.angular_rate_B_rad_s[i]);
        // All but the first one know their interval, and increments over it are what the rates say. The
        // second recording has them in fp12.20, which is too coarse for them.
        agrees = agrees && known(s.delta_time_s) == (compared > 1 && name == std::string("einride_1"));
        if (!known(s.delta_time_s)) continue;
        agrees = agrees && near_float(sign * message["DeltaV"].at(i), s.delta_velocity_B_m_s[i]);
        agrees = agrees && std::abs(s.delta_time_s - 0.01) < 1e-12;
        agrees =
            agrees && std::abs(s.delta_angle_B_rad[i] / s.delta_time_s - s.angular_rate_B_rad_s[i]) < 1e-4;
      }
      EXPECT_TRUE(agrees) << name << ", inertial message " << compared;
      mismatches += !agrees;
    }
    EXPECT_EQ(compared, imu.size());
    EXPECT_GT(compared, 90U);
    report(file, run, compared, mismatches);
  }
}

TEST(XsensCaptures, FixesAgreeWithAnotherDriversDecoding) {
  for (const char* name : {"einride_1", "einride_2"}) {
    const auto file = root() / "xsens" / name / "output.bin";
    if (!std::filesystem::exists(file)) FATHOM_DATA_IS_MISSING(file << " is not there");
    const Harvest run = decode("xsens", load(file));
    const auto fixes = of_kind<GpsSample>(run);
    std::size_t compared = 0;
    std::size_t mismatches = 0;
    for (auto& message : golden_messages(file.parent_path() / "output.golden")) {
      // In the order of the fields, without their names.
      const auto& pvt = message["GNSSPVTData"];
      if (pvt.empty()) continue;
      ASSERT_EQ(pvt.size(), 35U);
      ASSERT_LT(compared, fixes.size());
      const auto& [decoded, s] = fixes[compared++];
      const auto whole = [&](std::size_t i) { return static_cast<int>(pvt[i]); };
      const auto utc = from_civil({.year = whole(1),
                                   .month = whole(2),
                                   .day = whole(3),
                                   .hour = whole(4),
                                   .minute = whole(5),
                                   .second = whole(6),
                                   .nanosecond = whole(9)});
      bool agrees = decoded.time.utc_ns == utc && s.fix == GpsFix::fix_3d && s.satellites == whole(12);
      const std::vector<std::pair<double, double>> pairs{
          {pvt[14] * 1e-7, s.longitude_rad * kDegPerRad},
          {pvt[15] * 1e-7, s.latitude_rad * kDegPerRad},
          {pvt[16] * 1e-3, s.altitude_m},
          {pvt[17] * 1e-3, s.altitude_msl_m},
          {pvt[18] * 1e-3, std::hypot(s.position_sigma_N_m[0], s.position_sigma_N_m[1])},
          {pvt[19] * 1e-3, s.position_sigma_N_m[2]},
          {pvt[20] * 1e-3, s.velocity_N_m_s[0]},
          {pvt[21] * 1e-3, s.velocity_N_m_s[1]},
          {pvt[22] * 1e-3, s.velocity_N_m_s[2]},
          {pvt[25] * 1e-3, s.velocity_sigma_N_m_s[0]},
          {pvt[32] * 1e-2, s.hdop}};
      EXPECT_TRUE(agrees) << name << ", fix " << compared;
      for (const auto& [expected, got] : pairs) agrees = agrees && std::abs(expected - got) < 1e-9;
      EXPECT_TRUE(agrees) << name << ", fix " << compared;
      mismatches += !agrees;
      if (compared == 1) continue;
      // Four a second, and as far from each other as its velocity says, within what that knows.
      const auto& [before, last] = fixes[compared - 2];
      EXPECT_NEAR(to_seconds(*decoded.time.utc_ns - *before.time.utc_ns), 0.25, 1e-5);
      constexpr double kEarth_m = 6.37e6;
      EXPECT_NEAR(kEarth_m * (s.latitude_rad - last.latitude_rad), 0.25 * s.velocity_N_m_s[0], 0.1);
    }
    EXPECT_EQ(compared, 4U);
    EXPECT_EQ(compared, fixes.size());
    report(file, run, compared, mismatches);
  }
}

TEST(VectorNavCaptures, AsciiLines) {
  const auto file = root() / "vectornav/vnymr_samples.txt";
  if (!std::filesystem::exists(file)) FATHOM_DATA_IS_MISSING(file << " is not there");
  const Harvest run = decode("vectornav", load(file));
  const auto imu = of_kind<ImuSample>(run);
  std::size_t compared = 0;
  for (const auto& line : lines(file)) {
    const auto f = split(line.substr(0, line.find('*')), ',');
    if (f.size() != 13) continue;
    ASSERT_LT(compared, imu.size());
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_DOUBLE_EQ(imu[compared].second.specific_force_B_m_s2[i], std::stod(f[7 + i]));
      EXPECT_DOUBLE_EQ(imu[compared].second.angular_rate_B_rad_s[i], std::stod(f[10 + i]));
    }
    ++compared;
  }
  EXPECT_EQ(compared, imu.size());
  EXPECT_EQ(compared, 4U);
  // The fifth line has attitude only, which $VNYMR never has.
  ASSERT_EQ(run.rejected.size(), 1U);
  EXPECT_EQ(run.rejected[0].reason, RejectReason::structure);
  report(file, run, compared, 0);
}

TEST(PressureCaptures, AgreeWithTheValuesInTheLines) {
  const auto file = root() / "pressure/paroscientific/digiquartz_samples.txt";
  if (!std::filesystem::exists(file)) FATHOM_DATA_IS_MISSING(file << " is not there");
  std::ifstream in(root() / "pressure/paroscientific/digiquartz_samples.expected.json");
  const Json expected = Json::parse(in);
  CodecOptions options;
  const Harvest run = decode("paroscientific", load(file), {}, options);
  const auto depth = of_kind<DepthSample>(run);
  ASSERT_EQ(depth.size(), expected.size());
  for (std::size_t i = 0; i < depth.size(); ++i) {
    const double pressure_Pa = expected[i].at("value").get<double>() * options.pressure_unit_Pa;
    EXPECT_NEAR(depth[i].second.pressure_Pa, pressure_Pa, 1e-6 * pressure_Pa);
    if (expected[i].contains("temperature")) {
      EXPECT_DOUBLE_EQ(depth[i].second.temperature_degC, expected[i]["temperature"].get<double>());
    }
  }
  EXPECT_EQ(run.totals.rejected, 0U);
  report(file, run, depth.size(), 0);
}

TEST(UsblCaptures, AgreeWithTheExpectedFixes) {
  const auto file = root() / "usbl/psimssb/psimssb_samples.nmea";
  if (!std::filesystem::exists(file)) FATHOM_DATA_IS_MISSING(file << " is not there");
  std::ifstream in(root() / "usbl/expected.json");
  const Json expected = Json::parse(in).at("psimssb");
  const Harvest run = decode("psimssb", load(file));
  const auto usbl = of_kind<UsblSample>(run);
  ASSERT_EQ(usbl.size(), expected.size());
  for (std::size_t i = 0; i < usbl.size(); ++i) {
    const UsblSample& s = usbl[i].second;
    const Json& e = expected[i];
    EXPECT_EQ(s.transponder.view(), e.at("tp").get<std::string>());
    const bool use = e.at("use").is_boolean() && e["use"].get<bool>();
    EXPECT_EQ(known(s.relative_m[0]), use) << "fix " << i;
    if (!use) continue;
    EXPECT_EQ(s.frame, UsblFrame::ned);
    EXPECT_DOUBLE_EQ(s.relative_m[0], e.at("north").get<double>());
    EXPECT_DOUBLE_EQ(s.relative_m[1], e.at("east").get<double>());
    EXPECT_DOUBLE_EQ(s.relative_m[2], e.at("depth").get<double>());
    EXPECT_DOUBLE_EQ(s.travel_time_s, e.at("add").at(1).get<double>());
    const std::string t = e.at("t");
    const double seconds =
        3600.0 * std::stod(t.substr(0, 2)) + 60.0 * std::stod(t.substr(3, 2)) + std::stod(t.substr(6));
    ASSERT_TRUE(usbl[i].first.time.time_of_day_ns.has_value());
    EXPECT_NEAR(to_seconds(*usbl[i].first.time.time_of_day_ns), seconds, 1e-6);
  }
  EXPECT_EQ(run.totals.rejected, 0U);
  report(file, run, usbl.size(), 0);
}

TEST(UsblCaptures, PlacesAgreeWithTheExpectedFix) {
  const auto file = root() / "usbl/psonlld_samples.nmea";
  if (!std::filesystem::exists(file)) FATHOM_DATA_IS_MISSING(file << " is not there");
  std::ifstream in(root() / "usbl/expected.json");
  const Json expected = Json::parse(in).at("psonlld");
  const Harvest run = decode("psonlld", load(file));
  const auto usbl = of_kind<UsblSample>(run);
  ASSERT_EQ(usbl.size(), 3U);
  const UsblSample& first = usbl[0].second;
  EXPECT_EQ(first.transponder.view(), expected.at("id").get<std::string>());
  EXPECT_DOUBLE_EQ(first.latitude_rad * kDegPerRad, expected.at("lat").get<double>());
  EXPECT_DOUBLE_EQ(first.longitude_rad * kDegPerRad, expected.at("lon").get<double>());
  EXPECT_DOUBLE_EQ(first.depth_m, expected.at("depth").get<double>());
  EXPECT_DOUBLE_EQ(first.sigma_m, expected.at("ell_major").get<double>());
  EXPECT_EQ(run.totals.rejected, 0U);
  report(file, run, usbl.size(), 0);
}

}  // namespace
}  // namespace fathom::codec::capture
