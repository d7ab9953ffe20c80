#include <cmath>
#include <fstream>

#include <gtest/gtest.h>

#include "dataset/dataset.hpp"
#include "support/temporary_folder.hpp"

namespace fathom::dataset {
namespace {

std::string text_of(const std::filesystem::path& path) {
  std::ifstream in(path);
  return {std::istreambuf_iterator<char>(in), {}};
}

AltimeterSample heard(double t_s, double altitude_m) {
  AltimeterSample out;
  out.header = {"auv", "altimeter", kDefaultEpochNs + from_seconds(t_s), kDefaultEpochNs + from_seconds(t_s),
                0};
  out.altitude_m = altitude_m;
  return out;
}

TEST(AltimeterCsv, WhatWasWrittenIsRead) {
  const test::TemporaryFolder folder;
  Dataset data;
  data.of<AltimeterSample>() = {heard(1.0, 12.25), heard(1.5, kUnknown)};
  write(folder.path() / "bare", data);
  EXPECT_EQ(text_of(folder.path() / "bare" / "altimeter.csv"), "t_s,altitude_m\n1.00,12.25\n1.50,\n");
  data.of<AltimeterSample>()[0].sigma_m = 0.1;
  data.of<AltimeterSample>()[1].vertical = true;
  write(folder.path() / "full", data);
  EXPECT_EQ(text_of(folder.path() / "full" / "altimeter.csv"),
            "t_s,altitude_m,sigma_m,along\n1.00,12.25,0.1,axis\n1.50,,,vertical\n");
  const auto back = read(folder.path() / "full").of<AltimeterSample>();
  ASSERT_EQ(back.size(), 2U);
  EXPECT_EQ(back[0].altitude_m, 12.25);
  EXPECT_EQ(back[0].sigma_m, 0.1);
  EXPECT_FALSE(back[0].vertical);
  EXPECT_TRUE(std::isnan(back[1].altitude_m));
  EXPECT_TRUE(back[1].vertical);
  EXPECT_EQ(back[0].header.sensor, Name("altimeter"));
}

TEST(AltimeterCsv, AWordThatIsNoneIsNamed) {
  const test::TemporaryFolder folder;
  std::ofstream(folder.path() / "altimeter.csv") << "t_s,altitude_m,along\n1,12.25,keel\n";
  try {
    (void)read(folder.path());
    FAIL() << "read";
  } catch (const DatasetError& error) {
    EXPECT_NE(
        std::string(error.what()).find("altimeter.csv:2: column along: 'keel', expected axis or vertical"),
        std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace fathom::dataset
