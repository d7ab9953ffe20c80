#include <fstream>

#include <gtest/gtest.h>

#include "dataset/dataset.hpp"
#include "support/temporary_folder.hpp"

namespace fathom::dataset {
namespace {

TEST(RangeCsv, WhatWasWrittenIsRead) {
  const test::TemporaryFolder folder;
  Dataset data;
  RangeSample one;
  one.header = {"auv", "range", kDefaultEpochNs + kNsPerSecond, kDefaultEpochNs + kNsPerSecond, 0};
  one.range_m = 123.5;
  one.sigma_m = 0.3;
  one.beacon_latitude_rad = 0.6;
  one.beacon_longitude_rad = 2.2;
  one.beacon_depth_m = 20.0;
  data.of<RangeSample>() = {one};
  write(folder.path(), data);
  std::ifstream in(folder.path() / "range.csv");
  std::string header;
  std::getline(in, header);
  EXPECT_EQ(header, "t_s,range_m,sigma_m,beacon_lat_deg,beacon_lon_deg,beacon_depth_m");
  const auto back = read(folder.path()).of<RangeSample>();
  ASSERT_EQ(back.size(), 1U);
  EXPECT_EQ(back[0].range_m, 123.5);
  EXPECT_EQ(back[0].sigma_m, 0.3);
  EXPECT_NEAR(back[0].beacon_latitude_rad, 0.6, 1e-12);
  EXPECT_NEAR(back[0].beacon_longitude_rad, 2.2, 1e-12);
  EXPECT_EQ(back[0].beacon_depth_m, 20.0);
}

}  // namespace
}  // namespace fathom::dataset
