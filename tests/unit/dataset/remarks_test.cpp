#include "dataset/remarks.hpp"

#include <array>
#include <cstdio>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "dataset/dataset.hpp"
#include "dataset_folder.hpp"

namespace fathom::dataset {
namespace {

using test::DatasetFolder;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// Inertial samples of ten seconds, their times by a printf form.
std::string imu_file(const char* form = "%.2f", double factor = 1.0) {
  std::string text = "t_s,gx_rad_s,gy_rad_s,gz_rad_s,ax_m_s2,ay_m_s2,az_m_s2\n";
  for (int i = 0; i < 1000; ++i) {
    std::array<char, 40> time{};
    std::snprintf(time.data(), time.size(), form, (100.0 + 0.01 * i) * factor);
    text += std::string(time.data()) + ",0,0,0,0,0,-9.8\n";
  }
  return text;
}

std::vector<std::string> remarks_of(const DatasetFolder& folder) {
  return remarks(folder.path(), read(folder.path()));
}

TEST(Remarks, AreNoneWhereAllIsWell) {
  const DatasetFolder folder;
  folder.file("imu.csv", imu_file());
  // It began an hour before the inertial unit.
  folder.file("depth.csv", "t_s,depth_m\n-3500,1\n104,2\n");
  folder.zipped("reference.csv.gz",
                "t_s,lat_deg,lon_deg,alt_m,vn_m_s,ve_m_s,vd_m_s,roll_deg,pitch_deg,yaw_deg\n"
                "105,1,2,3,0,0,0,0,0,0\n");
  folder.file("mag.csv", "t_s\n");
  folder.file("nav.csv", "t_s\n");
  folder.file("import.json", "{}");
  EXPECT_THAT(remarks_of(folder), IsEmpty());
}

TEST(Remarks, NameAStreamOnAnotherClock) {
  const DatasetFolder folder;
  folder.file("imu.csv", imu_file());
  folder.file("depth.csv", "t_s,depth_m\n1752003361.25,1\n1752003364.5,2\n");
  EXPECT_THAT(remarks_of(folder),
              ElementsAre("depth: none of its 2 rows lies in the time of imu: t_s is 1752003361 s to "
                          "1752003364 s here and 100 s to 109.99 s there. Expected one clock, in seconds, in "
                          "all files"));
}

TEST(Remarks, NameTimesThatAreNoSeconds) {
  const DatasetFolder folder;
  folder.file("imu.csv", imu_file("%.2f", 1000.0));
  EXPECT_THAT(remarks_of(folder), ElementsAre("imu: from row to row pass 10 s, expected less than a second: "
                                              "look whether t_s is in seconds"));
}

TEST(Remarks, NameTimesWithTooFewDigits) {
  const DatasetFolder folder;
  folder.file("imu.csv", imu_file("%.1f"));
  EXPECT_THAT(remarks_of(folder),
              ElementsAre(HasSubstr(" of 1000 rows have the t_s of the row before and are "
                                    "not used: write t_s with more digits")));
}

TEST(Remarks, NameSigmasOfZeroButNotThoseOfRowsWithoutAFix) {
  const DatasetFolder folder;
  folder.file("imu.csv", imu_file());
  const std::string header =
      "t_s,lat_deg,lon_deg,alt_m,sigma_n_m,sigma_e_m,sigma_d_m,vn_m_s,ve_m_s,vd_m_s,fix\n";
  folder.file("gps.csv", header + "101,46,7,0,0,0,0,,,,0\n102,46,7,0,,,,,,,1\n103,46,7,0,1,1,2,,,,1\n");
  EXPECT_THAT(remarks_of(folder), IsEmpty());
  folder.file("gps.csv", header + "101,46,7,0,0,0,0,,,,1\n102,46,7,0,1,1,-1,,,,1\n103,46,7,0,1,1,2,,,,1\n");
  EXPECT_THAT(remarks_of(folder),
              ElementsAre("gps: 2 of 3 rows say a sigma of zero or less, which no fix can have: "
                          "leave sigma_n_m, sigma_e_m and sigma_d_m blank where they are "
                          "not known"));
}

TEST(Remarks, NameTablesThatNobodyReads) {
  const DatasetFolder folder;
  folder.file("imu.csv", imu_file());
  folder.file("gnss.csv", "t_s\n");
  EXPECT_THAT(remarks_of(folder),
              ElementsAre("gnss.csv is not read: its name is none of imu, gps, dvl, depth, "
                          "heading, usbl, airspeed, propulsion, fins, altimeter, range, "
                          "fix and reference, with .csv or .csv.gz behind it"));
  folder.file("Depth.csv.gz", "");
  folder.file("heading.CSV", "t_s\n");
  EXPECT_THAT(remarks_of(folder),
              ElementsAre(HasSubstr("Depth.csv.gz, gnss.csv, heading.CSV are not read: their names")));
}

}  // namespace
}  // namespace fathom::dataset
