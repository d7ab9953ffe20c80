#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "base/units.hpp"
#include "base/unknown.hpp"
#include "dataset/dataset.hpp"
#include "dataset_folder.hpp"

namespace fathom::dataset {
namespace {

using test::DatasetFolder;

const std::string kImuHeader = "t_s,gx_rad_s,gy_rad_s,gz_rad_s,ax_m_s2,ay_m_s2,az_m_s2\n";
const std::string kGpsHeader =
    "t_s,lat_deg,lon_deg,alt_m,sigma_n_m,sigma_e_m,sigma_d_m,vn_m_s,ve_m_s,vd_m_s,fix\n";

std::string error_of_reading(const DatasetFolder& folder) {
  try {
    static_cast<void>(read(folder.path()));
  } catch (const DatasetError& error) {
    return error.what();
  }
  return "no error";
}

TEST(ReadDataset, GivesEverySensorItsUnitsAndTimes) {
  const DatasetFolder folder;
  folder.file("imu.csv", kImuHeader + "1.0000,0.1,0.2,0.3,1,2,-9.8\n1.0100,,nan,0.3,1,2,+9.8\n");
  folder.file("gps.csv", kGpsHeader +
                             "-2.5010,40.5,-105.25,1601.4,0.01,0.02,0.03,1,2,3,1\n0,,,,,,,,,,0\n1,40,-105,,,,"
                             ",,,,9\n2,40,-105,,,,,,,,\n");
  folder.zipped("dvl.csv.gz",
                "t_s,vx_m_s,vy_m_s,vz_m_s,extra,valid,mode,b1_m_s,b2_m_s,b3_m_s,b4_m_s,t_received_s\n"
                "2,1.5,-0.5,0.25,what ever,1,bottom,1,2,,4,2.25\n3,1,1,1,,0,water,,,,,3.5\n");
  folder.file("depth.csv", "depth_m,t_s\r\n12.5,4\r\n");
  folder.file("heading.csv", "\xEF\xBB\xBFt_s,heading_deg,sigma_deg,north\n5,350,2,magnetic\n5.1,10,,true\n");
  folder.file("usbl.csv", "t_s,lat_deg,lon_deg,depth_m,sigma_m,t_received_s\n6,32,34,100,2,8\n");
  folder.file("airspeed.csv", "t_s,airspeed_m_s,baro_alt_m\n7,20,300\n");
  folder.file("propulsion.csv", "t_s,rpm\n8,-1500\n");
  folder.file("fins.csv", "t_s,rudder_rad,stern_rad\n9,0.1,-0.2\n");
  folder.file("reference.csv",
              "t_s,lat_deg,lon_deg,alt_m,vn_m_s,ve_m_s,vd_m_s,roll_deg,pitch_deg,yaw_deg\n"
              "0.59,32,34,-20,1,2,3,10,,180\n\n\n");
  const TimeNs epoch = 1'000 * kNsPerSecond;
  const Dataset data = read(folder.path(), {epoch, "thor"});

  ASSERT_EQ(data.of<ImuSample>().size(), 2U);
  EXPECT_EQ(data.of<ImuSample>()[0].header.stamp_ns, epoch + kNsPerSecond);
  EXPECT_EQ(data.of<ImuSample>()[1].header.stamp_ns, epoch + 1'010'000'000);
  EXPECT_EQ(data.of<ImuSample>()[1].header.received_ns, data.of<ImuSample>()[1].header.stamp_ns);
  EXPECT_EQ(data.of<ImuSample>()[1].header.sequence, 1U);
  EXPECT_EQ(data.of<ImuSample>()[1].header.sensor, Name("imu"));
  EXPECT_EQ(data.of<ImuSample>()[1].header.vehicle, Name("thor"));
  EXPECT_EQ(data.of<ImuSample>()[0].angular_rate_B_rad_s[2], 0.3);
  EXPECT_FALSE(known(data.of<ImuSample>()[1].angular_rate_B_rad_s[0]));
  EXPECT_FALSE(known(data.of<ImuSample>()[1].angular_rate_B_rad_s[1]));
  EXPECT_EQ(data.of<ImuSample>()[1].specific_force_B_m_s2[2], 9.8);

  ASSERT_EQ(data.of<GpsSample>().size(), 4U);
  EXPECT_EQ(data.of<GpsSample>()[0].header.stamp_ns, epoch - 2'501'000'000);
  EXPECT_DOUBLE_EQ(data.of<GpsSample>()[0].latitude_rad, 40.5 * kRadPerDeg);
  EXPECT_DOUBLE_EQ(data.of<GpsSample>()[0].longitude_rad, -105.25 * kRadPerDeg);
  EXPECT_EQ(data.of<GpsSample>()[0].fix, GpsFix::rtk_fixed);
  EXPECT_EQ(data.of<GpsSample>()[0].position_sigma_N_m[2], 0.03);
  EXPECT_EQ(data.of<GpsSample>()[0].velocity_N_m_s[1], 2.0);
  EXPECT_EQ(data.of<GpsSample>()[0].satellites, -1);
  EXPECT_EQ(data.of<GpsSample>()[1].fix, GpsFix::none);
  EXPECT_EQ(data.of<GpsSample>()[2].fix, GpsFix::fix_3d);
  EXPECT_EQ(data.of<GpsSample>()[3].fix, GpsFix::fix_3d);

  ASSERT_EQ(data.of<DvlSample>().size(), 2U);
  EXPECT_EQ(data.of<DvlSample>()[0].header.received_ns, epoch + 2'250'000'000);
  EXPECT_EQ(data.of<DvlSample>()[0].velocity_D_m_s[0], 1.5);
  EXPECT_EQ(data.of<DvlSample>()[0].beam_velocity_m_s[1], 2.0);
  EXPECT_FALSE(known(data.of<DvlSample>()[0].beam_velocity_m_s[2]));
  EXPECT_FALSE(known(data.of<DvlSample>()[1].velocity_D_m_s[0]));
  EXPECT_EQ(data.of<DvlSample>()[1].mode, DvlMode::water);

  EXPECT_EQ(data.of<DepthSample>().at(0).depth_m, 12.5);
  EXPECT_EQ(data.of<HeadingSample>().at(0).north, North::magnetic);
  EXPECT_DOUBLE_EQ(data.of<HeadingSample>().at(0).sigma_rad, 2.0 * kRadPerDeg);
  EXPECT_EQ(data.of<HeadingSample>().at(1).north, North::true_north);
  EXPECT_FALSE(known(data.of<HeadingSample>().at(1).sigma_rad));
  EXPECT_EQ(data.of<UsblSample>().at(0).header.received_ns, epoch + 8 * kNsPerSecond);
  EXPECT_EQ(data.of<UsblSample>().at(0).frame, UsblFrame::geodetic);
  EXPECT_EQ(data.of<AirspeedSample>().at(0).baro_altitude_m, 300.0);
  EXPECT_EQ(data.of<PropulsionSample>().at(0).rpm, -1500.0);
  EXPECT_EQ(data.of<FinsSample>().at(0).stern_rad, -0.2);
  EXPECT_DOUBLE_EQ(data.reference.at(0).rpy_rad[0], 10.0 * kRadPerDeg);
  EXPECT_FALSE(known(data.reference.at(0).rpy_rad[1]));
  EXPECT_EQ(data.reference.at(0).velocity_N_m_s[2], 3.0);
}

TEST(ReadDataset, TakesMissingFilesForMissingSensors) {
  const DatasetFolder folder;
  const Dataset data = read(folder.path());
  EXPECT_TRUE(data.of<ImuSample>().empty());
  EXPECT_TRUE(data.reference.empty());
  EXPECT_TRUE(arrivals(data).empty());
}

struct BadFile {
  const char* name;  ///< of the case
  const char* file;
  std::string content;
  const char* message;  ///< expected in the error
};

class BadFiles : public testing::TestWithParam<BadFile> {};

TEST_P(BadFiles, AreNamedWithLineAndExpectation) {
  const DatasetFolder folder;
  folder.file(GetParam().file, GetParam().content);
  EXPECT_THAT(error_of_reading(folder), testing::HasSubstr(GetParam().message));
}

INSTANTIATE_TEST_SUITE_P(
    Table, BadFiles,
    testing::Values(
        BadFile{"empty", "imu.csv", "", "imu.csv: is empty, expected a header line"},
        BadFile{"missing_column", "imu.csv", "t_s,gx_rad_s,gy_rad_s,ax_m_s2,ay_m_s2,az_m_s2\n1,1,1,1,1,1\n",
                "imu.csv:1: column 'gz_rad_s' is missing"},
        BadFile{"missing_time", "depth.csv", "depth_m\n1\n", "depth.csv:1: column 't_s' is missing"},
        BadFile{
            "missing_all", "depth.csv", "time,depth\n1,2\n",
            "depth.csv:1: columns 't_s', 'depth_m' are missing from the header, which has 'time', 'depth'"},
        BadFile{"semicolons", "depth.csv", "t_s;depth_m\n1;2\n",
                "depth.csv:1: columns are separated by semicolons, not by commas (and numbers need a decimal "
                "point), expected a header with 't_s', 'depth_m'"},
        BadFile{"tabs", "depth.csv", "t_s\tdepth_m\n1\t2\n", "depth.csv:1: columns are separated by tabs"},
        BadFile{"quotation_marks", "depth.csv", "\"t_s\",\"depth_m\"\n1,2\n",
                "depth.csv:1: the names stand in quotation marks, expected a header with 't_s', 'depth_m'"},
        BadFile{"comment_in_front", "depth.csv", "# of Monday\nt_s,depth_m\n1,2\n",
                "depth.csv:1: the line is a comment, expected a header with 't_s', 'depth_m'"},
        BadFile{"comment_between", "depth.csv", "t_s,depth_m\n1,2\n# restart\n2,2\n",
                "depth.csv:3: row is a comment, expected 2 fields"},
        BadFile{"no_header", "depth.csv", "1,2\n2,2\n",
                "depth.csv:1: the line holds numbers and no names, expected a header with 't_s', 'depth_m'"},
        BadFile{"utf16", "depth.csv", std::string("\xFF\xFEt\0_\0s\0,\0d\0\n\0", 14),
                "depth.csv:1: the text is UTF-16, not UTF-8"},
        BadFile{"old_line_ends", "depth.csv", "t_s,depth_m\r1,2\r2,3\r",
                "depth.csv:1: lines end with a carriage return alone, expected a line feed, or both"},
        BadFile{"old_line_ends_of_a_long_file", "depth.csv",
                [] {
                  std::string text = "t_s,depth_m";
                  for (int i = 0; i < 10'000; ++i) text += "\r" + std::to_string(i) + ",123";
                  return text;
                }(),
                "depth.csv:1: lines end with a carriage return alone"},
        BadFile{
            "cut_row", "depth.csv", "t_s,depth_m\n1,2\n2",
            "depth.csv:3: row has 1 field, expected 2 fields as in the header; it ends the file and has no "
            "line end, so it was cut"},
        BadFile{"lost_end", "depth.csv", std::string("t_s,depth_m\n1,2\n\0\0\0\0", 20),
                "depth.csv:3: row holds zero bytes, as a file does whose end was lost with the power"},
        BadFile{
            "week", "depth.csv", "t_s,depth_m\n604799.5,2\n0.5,2\n",
            "depth.csv:3: t_s 0.5 is earlier than 604799.5 in the row before, expected rows sorted by t_s; "
            "a GPS week began: add 604800 s from here on, in every file"},
        BadFile{"midnight", "depth.csv", "t_s,depth_m\n86399.5,2\n0,2\n",
                "; a day began: add 86400 s from here on"},
        BadFile{"twice", "depth.csv", "t_s,depth_m,depth_m\n", "depth.csv:1: column 'depth_m' appears twice"},
        BadFile{"text_in_number", "depth.csv", "t_s,depth_m\n1,2\n2,deep\n",
                "depth.csv:3: column depth_m: 'deep' is not a number, expected a decimal number"},
        BadFile{"half_a_number", "depth.csv", "t_s,depth_m\n1,2.5m\n", "depth.csv:2: column depth_m: '2.5m'"},
        BadFile{"huge_number", "depth.csv", "t_s,depth_m\n1,1e999\n", "depth.csv:2: column depth_m: '1e999'"},
        BadFile{"binary", "depth.csv", std::string("t_s,depth_m\n1,\x01\xFF\x00z\n", 18),
                "depth.csv:2: column depth_m: '???z'"},
        BadFile{"unsorted", "depth.csv", "t_s,depth_m\n1,2\n3,2\n2,2\n",
                "depth.csv:4: t_s 2 is earlier than 3 in the row before, expected rows sorted by t_s"},
        BadFile{"unsorted_both", "usbl.csv",
                "t_s,lat_deg,lon_deg,depth_m,sigma_m,t_received_s\n5,1,1,1,1,6\n4,1,1,1,1,5\n",
                "usbl.csv:3: t_s 4 is earlier than 5 in the row before, expected rows sorted by t_s or by "
                "t_received_s"},
        BadFile{"blank_time", "depth.csv", "t_s,depth_m\n,2\n", "depth.csv:2: column t_s: '' is not a time"},
        BadFile{"nan_time", "depth.csv", "t_s,depth_m\nnan,2\n",
                "depth.csv:2: column t_s: 'nan' is not a time"},
        BadFile{"infinite_time", "depth.csv", "t_s,depth_m\ninf,2\n",
                "depth.csv:2: column t_s: 'inf' is not a time"},
        BadFile{"absurd_time", "depth.csv", "t_s,depth_m\n1e12,2\n",
                "depth.csv:2: column t_s: '1e12' is not a time"},
        BadFile{"few_fields", "depth.csv", "t_s,depth_m\n1,2\n2\n",
                "depth.csv:3: row has 1 field, expected 2"},
        BadFile{"many_fields", "depth.csv", "t_s,depth_m\n1,2,3\n",
                "depth.csv:2: row has 3 fields, expected 2"},
        BadFile{"blank_line", "depth.csv", "t_s,depth_m\n1,2\n\n2,3\n", "depth.csv:3: line is blank"},
        BadFile{"endless_line", "depth.csv", "t_s,depth_m\n" + std::string(70'000, '1'),
                "depth.csv:2: line is longer"},
        BadFile{"latitude", "gps.csv", kGpsHeader + "0,91,0,0,,,,,,,1\n",
                "gps.csv:2: column lat_deg: latitude"},
        BadFile{"longitude", "gps.csv", kGpsHeader + "0,1,500,0,,,,,,,1\n",
                "gps.csv:2: column lon_deg: longitude"},
        BadFile{"fix", "gps.csv", kGpsHeader + "0,1,2,0,,,,,,,1.5\n", "gps.csv:2: column fix: '1.5'"},
        BadFile{"valid", "dvl.csv", "t_s,vx_m_s,vy_m_s,vz_m_s,valid\n0,1,1,1,2\n",
                "dvl.csv:2: column valid: '2'"},
        BadFile{"mode", "dvl.csv", "t_s,vx_m_s,vy_m_s,vz_m_s,mode\n0,1,1,1,air\n",
                "dvl.csv:2: column mode: 'air'"},
        BadFile{"usbl_frame", "usbl.csv", "t_s,frame,range_m,sigma_m\n1,ship,30,1\n",
                "usbl.csv:2: column frame: 'ship', expected geodetic, ned, vessel or vehicle"},
        BadFile{"usbl_without_place", "usbl.csv", "t_s,frame,range_m,sigma_m\n1,,30,1\n",
                "usbl.csv:2: column frame: geodetic, expected the columns lat_deg, lon_deg and depth_m"},
        BadFile{"north", "heading.csv", "t_s,heading_deg,north\n0,1,grid\n",
                "heading.csv:2: column north: 'grid'"},
        BadFile{"not_gzip", "depth.csv.gz", "t_s,depth_m\n1,2\n", "depth.csv.gz: is not gzip data"}),
    [](const auto& info) { return info.param.name; });

TEST(ReadDataset, NamesATruncatedArchive) {
  const DatasetFolder folder;
  std::string rows = kImuHeader;
  for (int i = 0; i < 20'000; ++i)
    rows += std::to_string(i) + "," + std::to_string(i * 7919 % 1000) + ",1,2,3,4,5\n";
  for (const std::uintmax_t missing : {1U, 9U, 2'000U}) {
    folder.zipped("imu.csv.gz", rows);
    folder.cut("imu.csv.gz", missing);
    EXPECT_THAT(error_of_reading(folder),
                testing::ContainsRegex("imu.csv.gz:[0-9]+: gzip data end too early"))
        << missing << " bytes missing";
  }
}

TEST(ReadDataset, NamesADamagedArchive) {
  const DatasetFolder folder;
  folder.zipped("depth.csv.gz", "t_s,depth_m\n1,2\n2,3\n");
  std::fstream file(folder.path() / "depth.csv.gz", std::ios::in | std::ios::out | std::ios::binary);
  file.seekp(-6, std::ios::end);  // in the checksum
  file.write("\x55\xAA", 2);
  file.close();
  EXPECT_THAT(error_of_reading(folder), testing::ContainsRegex("depth.csv.gz:[0-9]+: gzip data are damaged"));
}

void append(const DatasetFolder& folder, const std::string& to, const std::string& more) {
  std::ofstream(folder.path() / to, std::ios::app | std::ios::binary)
      << std::ifstream(folder.path() / more, std::ios::binary).rdbuf();
}

TEST(ReadDataset, TakesTheRowsOfEveryMemberOfAnArchive) {
  const DatasetFolder folder;
  folder.zipped("depth.csv.gz", "t_s,depth_m\n1,2\n2,3\n");
  folder.zipped("more", "3,4\n4,5\n");
  append(folder, "depth.csv.gz", "more");
  std::ofstream(folder.path() / "depth.csv.gz", std::ios::app | std::ios::binary) << std::string(512, '\0');
  EXPECT_EQ(read(folder.path()).of<DepthSample>().size(), 4U);
}

TEST(ReadDataset, NamesAMemberOfAnArchiveWhoseHeaderIsDamaged) {
  for (const int byte : {0, 1, 2}) {
    const DatasetFolder folder;
    folder.zipped("depth.csv.gz", "t_s,depth_m\n1,2\n2,3\n");
    const auto first = std::filesystem::file_size(folder.path() / "depth.csv.gz");
    folder.zipped("more", "3,4\n4,5\n");
    append(folder, "depth.csv.gz", "more");
    std::fstream file(folder.path() / "depth.csv.gz", std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(static_cast<std::streamoff>(first) + byte);
    file.write("\x55", 1);
    file.close();
    EXPECT_THAT(error_of_reading(folder),
                testing::ContainsRegex("depth.csv.gz:[0-9]+: gzip data are damaged"))
        << byte;
  }
}

TEST(ReadDataset, RefusesTwoVersionsOfOneFileAndAMissingFolder) {
  const DatasetFolder folder;
  folder.file("depth.csv", "t_s,depth_m\n1,2\n");
  folder.zipped("depth.csv.gz", "t_s,depth_m\n1,2\n");
  EXPECT_THAT(error_of_reading(folder), testing::HasSubstr("depth.csv: exists beside depth.csv.gz"));
  EXPECT_THROW(static_cast<void>(read(folder.path() / "nowhere")), DatasetError);
}

TEST(ReadDataset, NamesWhatIsNoFileAndDoesNotWaitForAPipe) {
  const DatasetFolder folder;
  std::filesystem::create_symlink("depth.csv", folder.path() / "depth.csv");
  EXPECT_THAT(error_of_reading(folder),
              testing::HasSubstr("depth.csv: cannot be read: Too many levels of symbolic links"));
  std::filesystem::remove(folder.path() / "depth.csv");
  ASSERT_EQ(::mkfifo((folder.path() / "depth.csv").c_str(), 0600), 0);
  EXPECT_THAT(error_of_reading(folder), testing::HasSubstr("depth.csv: is a pipe, expected a regular file"));
}

TEST(Arrivals, AreInOrderOfReceptionWithTheInertialSampleFirst) {
  const DatasetFolder folder;
  folder.file("imu.csv", kImuHeader + "1,0,0,0,0,0,0\n2,0,0,0,0,0,0\n3,0,0,0,0,0,0\n");
  folder.file("depth.csv", "t_s,depth_m\n2,1\n2,2\n");
  // In the order of arrival, not of validity.
  folder.file("usbl.csv",
              "t_s,lat_deg,lon_deg,depth_m,sigma_m,t_received_s\n1.5,1,1,1,1,1.6\n1,1,1,1,1,2.5\n");
  const Dataset data = read(folder.path());
  std::string order;
  for (const Arrival& arrival : arrivals(data)) {
    order += std::string(to_string(arrival.source)) + std::to_string(arrival.index) + " ";
    visit(data, arrival, [&](const auto& sample) {
      EXPECT_EQ(sample.header.received_ns, arrival.received_ns);
      EXPECT_EQ(sample.header.sequence, arrival.index);
      EXPECT_EQ(sample.header.sensor.view(), to_string(arrival.source));
    });
  }
  EXPECT_EQ(order, "imu0 usbl0 imu1 depth0 depth1 usbl1 imu2 ");
}

}  // namespace
}  // namespace fathom::dataset
