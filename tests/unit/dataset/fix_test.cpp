#include "samples/position/fix.hpp"

#include <fstream>

#include <gtest/gtest.h>

#include "dataset/dataset.hpp"
#include "support/temporary_folder.hpp"

namespace fathom::dataset {
namespace {

TEST(FixCsv, WhatWasWrittenIsReadWithWhenItWasTold) {
  const test::TemporaryFolder folder;
  Dataset data;
  FixSample one;
  one.header = {"auv", "fix", kDefaultEpochNs + kNsPerSecond, kDefaultEpochNs + 601 * kNsPerSecond, 0};
  one.latitude_rad = 0.6;
  one.longitude_rad = 2.2;
  one.sigma_m = 20.0;
  data.of<FixSample>() = {one};
  write(folder.path(), data);
  std::ifstream in(folder.path() / "fix.csv");
  std::string header;
  std::getline(in, header);
  EXPECT_EQ(header, "t_s,lat_deg,lon_deg,sigma_m,t_received_s");
  const auto back = read(folder.path()).of<FixSample>();
  ASSERT_EQ(back.size(), 1U);
  EXPECT_EQ(back[0].header.stamp_ns, one.header.stamp_ns);
  EXPECT_EQ(back[0].header.received_ns, one.header.received_ns);
  EXPECT_NEAR(back[0].latitude_rad, 0.6, 1e-12);
  EXPECT_NEAR(back[0].longitude_rad, 2.2, 1e-12);
  EXPECT_EQ(back[0].sigma_m, 20.0);
  EXPECT_FALSE(known(back[0].depth_m));
}

TEST(FixCsv, TheDepthIsThereWhereSomebodyTellsIt) {
  const test::TemporaryFolder folder;
  std::ofstream(folder.path() / "imu.csv")
      << "t_s,gx_rad_s,gy_rad_s,gz_rad_s,ax_m_s2,ay_m_s2,az_m_s2\n0,0,0,0,0,0,-9.8\n";
  std::ofstream(folder.path() / "fix.csv")
      << "t_s,lat_deg,lon_deg,sigma_m,depth_m,depth_sigma_m\n0,36,127,20,5,1\n1,36,127,20,,\n";
  const auto back = read(folder.path()).of<FixSample>();
  ASSERT_EQ(back.size(), 2U);
  EXPECT_EQ(back[0].depth_m, 5.0);
  EXPECT_EQ(back[0].depth_sigma_m, 1.0);
  EXPECT_FALSE(known(back[1].depth_m));
}

}  // namespace
}  // namespace fathom::dataset
