#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "solve_fixture.hpp"

namespace fathom::test {
namespace {

TEST_F(SolveTest, FollowsTheReferenceFromItsStart) {
  dataset::write(path("data"), StraightCourse(false).data);
  ASSERT_EQ(solve({"--start", "reference", "--metrics", path("m.json")}), 0) << err;
  EXPECT_EQ(err, "");
  const auto metrics = nlohmann::json::parse(content("m.json"));
  EXPECT_EQ(metrics["imu_samples"], 6001);
  EXPECT_EQ(metrics["start"], "reference");
  EXPECT_EQ(metrics["verdicts"]["dvl"]["used"], 60);
  EXPECT_NEAR(metrics["distance_m"].get<double>(), 120.0, 0.5);
  EXPECT_LT(metrics["horizontal_error_m"]["end"].get<double>(), 0.1);
  EXPECT_LT(metrics["horizontal_error_percent"]["end"].get<double>(), 0.1);
  EXPECT_LT(metrics["attitude_error_deg"]["yaw"]["max"].get<double>(), 0.1);
  EXPECT_LT(metrics["nees"]["horizontal"]["mean"].get<double>(), 7.4);
  EXPECT_GT(metrics["time_per_imu_sample_us"].get<double>(), 0.0);

  std::istringstream nav(content("nav.csv"));
  std::string line;
  std::getline(nav, line);
  EXPECT_EQ(line.substr(0, 75),
            "t_s,lat_deg,lon_deg,alt_m,vn_m_s,ve_m_s,vd_m_s,roll_deg,pitch_deg,yaw_deg,s");
  int rows = 0;
  std::string last;
  while (std::getline(nav, line)) {
    ++rows;
    last = line;
  }
  EXPECT_EQ(rows, 6001);
  EXPECT_EQ(last.substr(0, 6), "60.00,");
  EXPECT_NE(last.find(",dead_reckoning,,"), std::string::npos) << last;
}

TEST_F(SolveTest, SaysWhichInstrumentRefusedToAlign) {
  auto data = StraightCourse(false).data;
  dataset::write(path("data"), data);
  ASSERT_EQ(solve({"--start", "reference", "--metrics", path("sound.json")}), 0) << err;
  EXPECT_EQ(nlohmann::json::parse(content("sound.json"))["refused_to_align"], nlohmann::json::array());
  for (ImuSample& imu : data.of<ImuSample>())
    for (double& one : imu.specific_force_B_m_s2) one *= -1.0;
  dataset::write(path("data"), data);
  (void)solve({"--set", "start.mode=in_motion", "--metrics", path("m.json")});
  const auto refused = nlohmann::json::parse(content("m.json"))["refused_to_align"];
  ASSERT_EQ(refused.size(), 1U) << err;
  EXPECT_EQ(refused[0]["sensor"], "imu");
  EXPECT_EQ(refused[0]["kind"], "sign");
  EXPECT_NE(refused[0]["text"].get<std::string>().find("negate accelerometer"), std::string::npos);
}

TEST_F(SolveTest, WritesTheSameBytesTwiceAndFewerRowsWhereAsked) {
  dataset::write(path("data"), StraightCourse(false).data);
  ASSERT_EQ(solve({"--start", "reference"}), 0) << err;
  const std::string first = content("nav.csv");
  ASSERT_EQ(solve({"--start", "reference"}), 0) << err;
  EXPECT_EQ(first, content("nav.csv"));
  ASSERT_EQ(solve({"--start", "reference", "--rate", "10"}), 0) << err;
  const std::string thin = content("nav.csv");
  EXPECT_EQ(std::count(thin.begin(), thin.end(), '\n'), 1 + 601);
}

TEST_F(SolveTest, ComparesOutagesWithTheRemovedFixes) {
  dataset::write(path("data"), StraightCourse(true).data);
  ASSERT_EQ(solve({"--start", "reference", "--gps-outage", "4,8@5:6", "--json"}), 0) << err;
  const auto metrics = nlohmann::json::parse(out);
  ASSERT_EQ(metrics["gps_outages"].size(), 2U);
  const auto& four = metrics["gps_outages"][0];
  EXPECT_EQ(four["duration_s"], 4.0);
  // 4 s every 10 s until 60 s, from 5, 18, 31 and 44 s.
  EXPECT_EQ(four["count"], 6 + 4 + 3 + 2);
  EXPECT_NEAR(four["windows"][0]["start_s"].get<double>(), 5.0, 1e-9);
  EXPECT_NEAR(four["windows"][0]["end_s"].get<double>(), 8.5, 1e-9);
  EXPECT_LT(four["horizontal_error_m"]["max"].get<double>(), 0.5);
  EXPECT_GT(four["windows"][0]["predicted_95_m"].get<double>(), 0.0);
  // The passage itself lacks the six windows of 4 s from 5 s on, with eight fixes each.
  const auto& gps = metrics["verdicts"]["gps"];
  std::uint64_t judged = 0;
  for (const auto& [kind, count] : gps.items()) judged += count.get<std::uint64_t>();
  EXPECT_EQ(judged, 121U - 6U * 8U);
}

TEST_F(SolveTest, FindsTheMotionOfAReceiverThatTellsNoVelocity) {
  dataset::Dataset data = StraightCourse(true).data;
  for (GpsSample& fix : data.of<GpsSample>()) fix.velocity_N_m_s = {kUnknown, kUnknown, kUnknown};
  dataset::write(path("data"), data);
  ASSERT_EQ(solve({"--start", "reference", "--gps-outage", "4@5:6", "--json"}), 0) << err;
  EXPECT_EQ(nlohmann::json::parse(out)["gps_outages"][0]["count"], 6 + 4 + 3 + 2);
}

struct BadCall {
  const char* name;
  std::vector<std::string> more;
  const char* message;
};

class BadSolveCall : public SolveTest, public ::testing::WithParamInterface<BadCall> {};

TEST_P(BadSolveCall, EndsWithTwo) {
  dataset::write(path("data"), StraightCourse(true).data);
  EXPECT_EQ(solve(GetParam().more), 2);
  EXPECT_NE(err.find(GetParam().message), std::string::npos) << err;
  EXPECT_EQ(std::count(err.begin(), err.end(), '\n'), 1) << err;
}

INSTANTIATE_TEST_SUITE_P(
    Table, BadSolveCall,
    ::testing::Values(
        BadCall{"outage_text", {"--gps-outage", "ten"}, "fathom: --gps-outage: is 'ten', expected T1,T2"},
        BadCall{"outage_zero", {"--gps-outage", "0"}, "fathom: --gps-outage: is '0'"},
        BadCall{"outage_nothing", {"--gps-outage", "1e-10@100:0"}, "fathom: --gps-outage: is '1e-10@100:0'"},
        BadCall{"outage_tail", {"--gps-outage", "10@5:x"}, "fathom: --gps-outage: is '10@5:x'"},
        BadCall{"start", {"--start", "somewhere"}, "--start"},
        BadCall{"set", {"--set", "engine.horizon_s=-1"}, "config.json: engine.horizon_s: is -1, expected"},
        BadCall{"unknown", {"--faster"}, "--faster"}),
    [](const auto& info) { return info.param.name; });

TEST_F(SolveTest, SmoothsFromBothEnds) {
  // Fixes that scatter by a quarter of a metre, and an accelerometer that begins to pull to the east while
  // there are none.
  dataset::Dataset data = StraightCourse(true).data;
  data.of<DvlSample>().clear();
  for (std::size_t i = 2500; i < data.of<ImuSample>().size(); ++i)
    data.of<ImuSample>()[i].specific_force_B_m_s2[1] += 2e-2;
  for (std::size_t i = 0; i < data.of<GpsSample>().size(); ++i) {
    data.of<GpsSample>()[i].latitude_rad += 4e-8 * std::sin(12.9898 * static_cast<double>(i));
    data.of<GpsSample>()[i].longitude_rad += 4e-8 * std::sin(78.233 * static_cast<double>(i));
  }
  dataset::write(path("data"), data);
  // Nothing is wrong with these instruments that a state could be left out for.
  const std::vector<std::string> call{"--smooth", "--start", "reference", "--gps-outage",
                                      "20@20:10", "--json",  "--set",     "engine.left_out=noise"};
  ASSERT_EQ(solve(call), 0) << err;
  EXPECT_EQ(err, "");
  const auto metrics = nlohmann::json::parse(out);
  EXPECT_EQ(metrics["smoothed"], true);
  const double smoothed = metrics["horizontal_error_m"]["rms"];
  const double filtered = metrics["filtered"]["horizontal_error_m"]["rms"];
  EXPECT_LT(smoothed, 0.9 * filtered);
  const auto& outage = metrics["gps_outages"][0];
  EXPECT_LT(outage["smoothed_inside_horizontal_error_m"]["rms"].get<double>(),
            0.7 * outage["inside_horizontal_error_m"]["rms"].get<double>());
  EXPECT_EQ(metrics["nav_states"], 6001);
  const std::string nav = content("nav.csv");
  EXPECT_EQ(std::count(nav.begin(), nav.end(), '\n'), 1 + 6001);
  ASSERT_EQ(solve(call), 0) << err;
  EXPECT_EQ(nav, content("nav.csv"));
}

const std::string kImuHeader = "t_s,gx_rad_s,gy_rad_s,gz_rad_s,ax_m_s2,ay_m_s2,az_m_s2\n";
const std::string kGpsHeader =
    "t_s,lat_deg,lon_deg,alt_m,sigma_n_m,sigma_e_m,sigma_d_m,vn_m_s,ve_m_s,vd_m_s,fix\n";

struct BadFile {
  const char* name;  ///< of the case
  const char* file;
  std::string content;
  const char* message;  ///< behind "fathom: FOLDER/"
};

class BadDataFile : public SolveTest, public ::testing::WithParamInterface<BadFile> {};

TEST_P(BadDataFile, EndsWithThreeAndOneLineThatNamesIt) {
  fs::create_directory(path("data"));
  write("data/imu.csv", kImuHeader + "0,0,0,0,0,0,-9.8\n0.01,0,0,0,0,0,-9.8\n");
  write(std::string("data/") + GetParam().file, GetParam().content);
  EXPECT_EQ(solve({}), 3);
  EXPECT_EQ(err.find("fathom: " + path("data") + "/" + GetParam().message), 0U) << err;
  EXPECT_EQ(std::count(err.begin(), err.end(), '\n'), 1) << err;
  EXPECT_EQ(out, "");
}

INSTANTIATE_TEST_SUITE_P(
    Table, BadDataFile,
    ::testing::Values(
        BadFile{"empty", "imu.csv", "", "imu.csv: is empty, expected a header line"},
        BadFile{"only_a_header", "imu.csv", kImuHeader, "imu.csv: no inertial samples, expected"},
        BadFile{"missing_column", "imu.csv", "t_s,gx_rad_s,gy_rad_s,ax_m_s2,ay_m_s2,az_m_s2\n0,0,0,0,0,0\n",
                "imu.csv:1: column 'gz_rad_s' is missing"},
        BadFile{"column_twice", "imu.csv", "t_s,t_s\n", "imu.csv:1: column 't_s' appears twice"},
        BadFile{"text", "dvl.csv", "t_s,vx_m_s,vy_m_s,vz_m_s\n1,2,0,0\n2,fast,0,0\n",
                "dvl.csv:3: column vx_m_s: 'fast' is not a number, expected a decimal number"},
        BadFile{"hexadecimal", "depth.csv", "t_s,depth_m\n1,0x10\n", "depth.csv:2: column depth_m: '0x10'"},
        BadFile{"too_large", "depth.csv", "t_s,depth_m\n1,1e400\n", "depth.csv:2: column depth_m: '1e400'"},
        BadFile{"decimal_comma", "depth.csv", "t_s,depth_m\n1,2,5\n",
                "depth.csv:2: row has 3 fields, expected 2"},
        BadFile{"zero_bytes", "depth.csv", std::string("t_s,depth_m\n1,2\0\0\n", 18),
                "depth.csv:2: column depth_m: '2?\?' is not a number"},
        BadFile{"unsorted", "imu.csv",
                kImuHeader + "1,0,0,0,0,0,-9.8\n2,0,0,0,0,0,-9.8\n1.5,0,0,0,0,0,-9.8\n",
                "imu.csv:4: t_s 1.5 is earlier than 2 in the row before, expected rows sorted by t_s"},
        BadFile{"time_not_a_number", "imu.csv", kImuHeader + "nan,0,0,0,0,0,-9.8\n",
                "imu.csv:2: column t_s: 'nan' is not a time"},
        BadFile{"short_row", "imu.csv", kImuHeader + "0,0,0,0,0,0,-9.8\n0.01,0,0\n",
                "imu.csv:3: row has 3 fields"},
        BadFile{"blank_line", "imu.csv", kImuHeader + "0,0,0,0,0,0,-9.8\n\n0.01,0,0,0,0,0,-9.8\n",
                "imu.csv:3: line is blank"},
        BadFile{"line_ends_of_old", "depth.csv", "t_s,depth_m\r1,2\r2,3\r",
                "depth.csv:1: lines end with a carriage return alone"},
        BadFile{"endless_line", "depth.csv", "t_s,depth_m\n" + std::string(100'000, '1'),
                "depth.csv:2: line is longer than 65536 bytes"},
        BadFile{"latitude", "gps.csv", kGpsHeader + "0,91,0,0,,,,,,,1\n",
                "gps.csv:2: column lat_deg: latitude"},
        BadFile{"not_gzip", "depth.csv.gz", "t_s,depth_m\n1,2\n", "depth.csv.gz: is not gzip data"},
        BadFile{"both", "imu.csv.gz", "", "imu.csv: exists beside imu.csv.gz, expected one of the two"}),
    [](const auto& info) { return info.param.name; });

// The disk was full, or the power went.
TEST_F(SolveTest, AFileThatWasCutIsNamedAndSolvedUpToThere) {
  dataset::write(path("data"), StraightCourse(false).data, {dataset::kDefaultEpochNs, true});
  ASSERT_EQ(solve({"--start", "reference"}), 0) << err;
  const auto rows = [&] {
    const std::string nav = content("nav.csv");
    return std::count(nav.begin(), nav.end(), '\n');
  };
  const auto whole = rows();
  const fs::path imu = fs::path(path("data")) / "imu.csv.gz";
  fs::resize_file(imu, fs::file_size(imu) * 9 / 10);
  EXPECT_EQ(solve({"--start", "reference"}), 0) << err;
  EXPECT_EQ(err.find("fathom: " + path("data") + ": imu.csv.gz:"), 0U) << err;
  EXPECT_NE(err.find("gzip data end too early: the file is truncated, expected a complete .gz file; the rows "
                     "before it are used\n"),
            std::string::npos)
      << err;
  EXPECT_LT(rows(), whole);
  EXPECT_GT(rows(), whole * 8 / 10);
}

TEST_F(SolveTest, NoFolderAndAnEmptyOneEndWithThree) {
  EXPECT_EQ(solve({}), 3);
  EXPECT_NE(err.find("data: No such file or directory, expected the folder"), std::string::npos) << err;
  fs::create_directory(path("data"));
  EXPECT_EQ(solve({}), 3);
  EXPECT_NE(err.find("data/imu.csv: is not there, nor is imu.csv.gz; expected the inertial samples"),
            std::string::npos)
      << err;
}

TEST_F(SolveTest, NoPositionIsTheAnswerNo) {
  dataset::Dataset data = StraightCourse(false).data;
  dataset::write(path("data"), data);
  EXPECT_EQ(solve({}), 1);
  EXPECT_EQ(err, "");
  EXPECT_NE(
      out.find("\nthe data have no position: neither gps nor usbl nor fix has a row\nno position was found: "
               "alignment is"),
      std::string::npos)
      << out;
  EXPECT_EQ(out.find("nan"), std::string::npos) << out;
}

TEST_F(SolveTest, FixesOnAnotherClockAndTablesOfOtherNamesAreNamed) {
  dataset::write(path("data"), StraightCourse(false).data);
  write("data/gps.csv",
        kGpsHeader + "1752003261,46,7,100,1,1,2,0,0,0,1\n1752003262,46,7,100,1,1,2,0,0,0,1\n");
  write("data/gnss.csv", kGpsHeader);
  EXPECT_EQ(solve({}), 1);
  EXPECT_EQ(err.find("fathom: " + path("data") +
                     ": gps: none of its 2 rows lies in the time of imu: t_s is 1752003261 s to 1752003262 s "
                     "here and 0 s to 60 s there."),
            0U)
      << err;
  EXPECT_NE(err.find("\nfathom: " + path("data") + ": gnss.csv is not read: its name is none of imu, gps, "),
            std::string::npos)
      << err;
  EXPECT_EQ(out.find("the data have no position"), std::string::npos) << out;
}

TEST_F(SolveTest, AFolderInPlaceOfAFileIsNamed) {
  fs::create_directories(path("data/imu.csv"));
  EXPECT_EQ(solve({}), 3);
  EXPECT_NE(err.find("data/imu.csv: is a folder, expected a regular file"), std::string::npos) << err;
}

TEST_F(SolveTest, OddButReadableFilesAreRead) {
  dataset::write(path("data"), StraightCourse(false).data);
  ASSERT_EQ(solve({"--start", "reference"}), 0) << err;
  const std::string plain = content("nav.csv");
  // A byte order mark, carriage returns, blanks, a column that nobody knows and no line end at the end.
  const std::string dvl = content("data/dvl.csv");
  std::istringstream lines(dvl);
  std::string odd = "\xEF\xBB\xBF";
  for (std::string line; std::getline(lines, line);)
    odd += (odd.size() > 3 ? "\r\n" : "") + line + (odd.size() > 3 ? " ,what ever" : " , remark");
  write("data/dvl.csv", odd);
  ASSERT_EQ(solve({"--start", "reference"}), 0) << err;
  EXPECT_EQ(content("nav.csv"), plain);
}

TEST_F(SolveTest, AGapWidensTheUncertaintyAndALongOneLosesTheAttitude) {
  dataset::Dataset data = StraightCourse(false).data;
  const auto cut = [&](int from_s, int to_s) {
    dataset::Dataset gappy = data;
    gappy.of<ImuSample>().erase(gappy.of<ImuSample>().begin() + from_s * 100,
                                gappy.of<ImuSample>().begin() + to_s * 100);
    dataset::write(path("data"), gappy);
  };
  ASSERT_EQ((cut(30, 33), solve({"--start", "reference", "--json"})), 0) << err;
  auto metrics = nlohmann::json::parse(out);
  EXPECT_EQ(metrics["nav_states"], 6001 - 300);
  EXPECT_LT(metrics["horizontal_error_m"]["end"].get<double>(), 3.0);
  EXPECT_LT(metrics["nees"]["horizontal"]["mean"].get<double>(), 7.4);
  ASSERT_EQ((cut(20, 40), solve({"--start", "reference", "--json"})), 0) << err;
  metrics = nlohmann::json::parse(out);
  EXPECT_GT(metrics["verdicts"]["imu"]["from_the_future"].get<int>(), 0);
  EXPECT_GT(metrics["verdicts"]["dvl"]["not_aligned"].get<int>(), 0);
}

TEST_F(SolveTest, NoReferenceIsNoStart) {
  dataset::Dataset data = StraightCourse(false).data;
  data.reference.clear();
  dataset::write(path("data"), data);
  EXPECT_EQ(solve({"--start", "reference"}), 3);
  EXPECT_NE(err.find("reference.csv: no rows, expected a reference to start from"), std::string::npos) << err;
}

// Lying still with its bow to the north-east, as its instruments feel it.
dataset::Dataset at_rest(double heading_rad) {
  dataset::Dataset data;
  for (int i = 0; i <= 3000; ++i) {
    ImuSample& imu = data.of<ImuSample>().emplace_back();
    imu.header.stamp_ns = imu.header.received_ns = dataset::kDefaultEpochNs + i * 10'000'000LL;
    imu.header.sequence = static_cast<std::uint64_t>(i);
    imu.angular_rate_B_rad_s = {kEarthRate * std::cos(kSolvedLatitude_rad) * std::cos(heading_rad),
                                -kEarthRate * std::cos(kSolvedLatitude_rad) * std::sin(heading_rad),
                                -kEarthRate * std::sin(kSolvedLatitude_rad)};
    imu.specific_force_B_m_s2 = {0.0, 0.0, -9.797};
    Truth& truth = data.reference.emplace_back();
    truth.header = imu.header;
    truth.latitude_rad = kSolvedLatitude_rad;
    truth.longitude_rad = 0.3;
    truth.altitude_m = 0.0;
    truth.velocity_N_m_s = {0.0, 0.0, 0.0};
    truth.rpy_rad = {0.0, 0.0, heading_rad};
    if (i % 100 != 7) continue;
    GpsSample& gps = data.of<GpsSample>().emplace_back();
    gps.header = imu.header;
    gps.fix = GpsFix::fix_3d;
    gps.latitude_rad = kSolvedLatitude_rad;
    gps.longitude_rad = 0.3;
    gps.altitude_m = 0.0;
    gps.position_sigma_N_m = {1.0, 1.0, 2.0};
    gps.velocity_N_m_s = {0.0, 0.0, 0.0};
  }
  return data;
}

TEST_F(SolveTest, StartsAtRestWithAHeadingFromTheGyroOrFromAnInstrument) {
  constexpr double kHeading = 0.7;
  dataset::Dataset data = at_rest(kHeading);
  dataset::write(path("data"), data);
  // Gyro bias far below what the Earth's rate needs: it finds north by itself.
  const std::vector<std::string> rest{"--set", "start.mode=at_rest", "--json"};
  auto call = rest;
  call.insert(call.end(), {"--set", "engine.imu.gyro_bias_sigma_deg_h=0.01", "--set",
                           "engine.imu.angle_random_walk_deg_sqrt_h=0.001"});
  ASSERT_EQ(solve(call), 0) << err << out;
  EXPECT_LT(nlohmann::json::parse(out)["attitude_error_deg"]["yaw"]["max"].get<double>(), 0.5);

  // The unit of the defaults cannot, and no instrument says: no position, and it says why.
  EXPECT_EQ(solve({"--set", "start.mode=at_rest"}), 1);
  EXPECT_NE(out.find("no position was found"), std::string::npos) << out;
  EXPECT_NE(out.find("course_sigma_rad below 0.3 (is not known)"), std::string::npos) << out;

  // Two antennas give a heading that needs no doubt.
  write("data/heading.csv", "t_s,heading_deg,sigma_deg\n");
  std::ofstream heading(path("data/heading.csv"), std::ios::app);
  for (int i = 0; i < 300; ++i)
    heading << 0.1 * i + 0.003 << "," << kHeading * 180.0 / 3.14159265358979 << ",0.2\n";
  heading.close();
  std::string config = content("config.json");
  config.insert(config.rfind("]}}"),
                R"(, {"sensor": "heading0", "kind": "heading", "sigma_deg": [0.2, 0.2, 0.2]})");
  write("config.json", config);
  ASSERT_EQ(solve(rest), 0) << err << out;
  EXPECT_LT(nlohmann::json::parse(out)["attitude_error_deg"]["yaw"]["max"].get<double>(), 0.2);
}

TEST_F(SolveTest, StartsFromAGivenStateWithItsSigmas) {
  dataset::Dataset data = StraightCourse(false).data;
  dataset::write(path("data"), data);
  std::string config = content("config.json");
  const std::string automatic = R"("start": {"mode": "automatic"})";
  config.replace(config.find(automatic), automatic.size(),
                 R"("start": {"mode": "given", "state": {"latitude_deg": 34.37746770784939,
                     "longitude_deg": 17.188733853924695, "altitude_m": 0, "velocity_N_m_s": [2, 0, 0],
                     "rpy_deg": [0, 0, 0]}, "sigma": {"position_N_m": [0.5, 0.5, 0.5]}})");
  write("config.json", config);
  ASSERT_EQ(solve({"--json"}), 0) << err;
  const auto metrics = nlohmann::json::parse(out);
  EXPECT_LT(metrics["horizontal_error_m"]["max"].get<double>(), 0.2);
  std::istringstream nav(content("nav.csv"));
  std::string header;
  std::string row;
  std::getline(nav, header);
  std::getline(nav, row);
  std::vector<std::string> fields;
  std::istringstream split(row);
  for (std::string field; std::getline(split, field, ',');) fields.push_back(field);
  EXPECT_NEAR(std::stod(fields.at(10)), 0.5, 0.01) << row;
  // Without the state the mode means nothing.
  EXPECT_EQ(solve({"--set", "start.state=null"}), 2);
  EXPECT_EQ(std::count(err.begin(), err.end(), '\n'), 1) << err;
}

TEST_F(SolveTest, AReferenceWithoutAttitudeIsNoStart) {
  dataset::Dataset data = StraightCourse(false).data;
  for (Truth& truth : data.reference) truth.rpy_rad[2] = kUnknown;
  dataset::write(path("data"), data);
  EXPECT_EQ(solve({"--start", "reference"}), 3);
  EXPECT_NE(err.find("reference.csv: the first row"), std::string::npos) << err;
}

TEST_F(SolveTest, BadMeasurementsGetVerdictsAndMoveNothing) {
  dataset::Dataset data = StraightCourse(false).data;
  data.of<ImuSample>()[1000].angular_rate_B_rad_s[2] = kUnknown;
  data.of<ImuSample>()[2001].header.stamp_ns = data.of<ImuSample>()[2000].header.stamp_ns;
  data.of<ImuSample>()[2001].header.received_ns = data.of<ImuSample>()[2000].header.stamp_ns;
  data.of<DvlSample>()[10].velocity_D_m_s.fill(kUnknown);
  dataset::write(path("data"), data);
  ASSERT_EQ(solve({"--start", "reference", "--json"}), 0) << err;
  const auto metrics = nlohmann::json::parse(out);
  EXPECT_EQ(metrics["verdicts"]["imu"]["out_of_range"], 1);
  EXPECT_EQ(metrics["verdicts"]["imu"]["duplicate"], 1);
  EXPECT_EQ(metrics["verdicts"]["dvl"]["out_of_range"], 1);
  EXPECT_LT(metrics["horizontal_error_m"]["end"].get<double>(), 0.1);
}

}  // namespace
}  // namespace fathom::test
