#include <cmath>
#include <fstream>
#include <iterator>
#include <random>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/unknown.hpp"
#include "dataset/dataset.hpp"
#include "dataset/nav_csv.hpp"
#include "dataset_folder.hpp"

namespace fathom::dataset {
namespace {

using test::DatasetFolder;

std::string content(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

template <std::size_t N>
void fill(std::array<double, N>& values, std::mt19937_64& random) {
  for (double& value : values) value = std::uniform_real_distribution<double>(-10.0, 10.0)(random);
}

SampleHeader header(TimeNs stamp, DurationNs delay = 0) {
  SampleHeader out;
  out.stamp_ns = stamp;
  out.received_ns = stamp + delay;
  return out;
}

Dataset sample_data() {
  std::mt19937_64 random(7);
  Dataset data;
  for (int i = 0; i < 500; ++i) {
    ImuSample& imu = data.of<ImuSample>().emplace_back();
    imu.header = header(kDefaultEpochNs - kNsPerSecond + i * 10'000'001LL);
    fill(imu.angular_rate_B_rad_s, random);
    fill(imu.specific_force_B_m_s2, random);
  }
  data.of<ImuSample>()[3].specific_force_B_m_s2[1] = kUnknown;
  for (int i = 0; i < 20; ++i) {
    const TimeNs stamp = kDefaultEpochNs + i * 250'000'000LL;
    GpsSample& gps = data.of<GpsSample>().emplace_back();
    gps.header = header(stamp, 120'000'000);
    gps.fix = i % 5 == 0 ? GpsFix::none : GpsFix::fix_3d;
    if (gps.fix != GpsFix::none) {
      gps.latitude_rad = 0.6 + 1e-7 * i;
      gps.longitude_rad = -2.1 + 1e-7 * i;
      gps.altitude_m = 18.5;
      gps.satellites = 9;
    }
    fill(gps.position_sigma_N_m, random);
    fill(gps.velocity_N_m_s, random);
    fill(gps.velocity_sigma_N_m_s, random);
    DvlSample& dvl = data.of<DvlSample>().emplace_back();
    dvl.header = header(stamp);
    fill(dvl.velocity_D_m_s, random);
    fill(dvl.beam_velocity_m_s, random);
    dvl.beam_velocity_m_s[2] = kUnknown;
    dvl.mode = i % 2 == 0 ? DvlMode::bottom : DvlMode::water;
    dvl.sigma_m_s = 0.01;
    dvl.altitude_m = 44.0;
    data.of<DepthSample>().push_back({header(stamp), 5.0 + i, 0.02, kUnknown, kUnknown});
    HeadingSample& heading = data.of<HeadingSample>().emplace_back();
    heading.header = header(stamp);
    heading.heading_rad = 0.1 * i;
    heading.north = i < 10 ? North::magnetic : North::true_north;
    UsblSample& usbl = data.of<UsblSample>().emplace_back();
    usbl.header = header(stamp, 2 * kNsPerSecond);
    usbl.latitude_rad = 0.6;
    usbl.longitude_rad = -2.1;
    usbl.depth_m = 40.0;
    usbl.sigma_m = 1.5;
    if (i % 2 == 1) {
      usbl.frame = UsblFrame::vessel_frd;
      usbl.latitude_rad = usbl.longitude_rad = usbl.depth_m = kUnknown;
      usbl.relative_m = {10.0 + i, -20.0, 30.0};
      usbl.range_m = 37.0 + i;
      usbl.bearing_rad = 0.2 * i;
      usbl.depression_rad = 0.9;
      usbl.sigma_rad = 0.01;
      usbl.station_latitude_rad = 0.61;
      usbl.station_longitude_rad = -2.11;
      usbl.station_depth_m = 4.0;
      usbl.station_rpy_rad = {0.01, -0.02, 1.3};
    }
    data.of<AirspeedSample>().push_back({header(stamp), 20.0, 300.0, kUnknown, 20.3});
    data.of<PropulsionSample>().push_back({header(stamp), 1500.0 + i});
    data.of<FinsSample>().push_back({header(stamp), 0.01 * i, -0.01 * i});
    Truth& truth = data.reference.emplace_back();
    truth.header = header(stamp);
    truth.latitude_rad = 0.6;
    truth.longitude_rad = -2.1;
    truth.altitude_m = -40.0;
    fill(truth.velocity_N_m_s, random);
    truth.rpy_rad = {0.1, -0.2, kUnknown};
  }
  return data;
}

// Equal, both unknown, or apart by the rounding of a conversion to degrees and back.
void expect_same(double a, double b) {
  if (!known(a) && !known(b)) return;
  EXPECT_NEAR(a, b, 4e-16 * std::abs(a));
}

template <std::size_t N>
void expect_same(const std::array<double, N>& a, const std::array<double, N>& b) {
  for (std::size_t i = 0; i < N; ++i) expect_same(a[i], b[i]);
}

void expect_round_trip(bool gzip) {
  const DatasetFolder folder;
  const Dataset data = sample_data();
  write(folder.path() / "new", data, {kDefaultEpochNs, gzip});
  EXPECT_EQ(std::filesystem::exists(folder.path() / "new" / "imu.csv.gz"), gzip);
  const Dataset back = read(folder.path() / "new");
  ASSERT_EQ(back.of<ImuSample>().size(), data.of<ImuSample>().size());
  for (std::size_t i = 0; i < data.of<ImuSample>().size(); ++i) {
    EXPECT_EQ(back.of<ImuSample>()[i].header.stamp_ns, data.of<ImuSample>()[i].header.stamp_ns);
    expect_same(back.of<ImuSample>()[i].angular_rate_B_rad_s, data.of<ImuSample>()[i].angular_rate_B_rad_s);
    expect_same(back.of<ImuSample>()[i].specific_force_B_m_s2, data.of<ImuSample>()[i].specific_force_B_m_s2);
  }
  ASSERT_EQ(back.of<GpsSample>().size(), data.of<GpsSample>().size());
  ASSERT_EQ(back.of<DvlSample>().size(), data.of<DvlSample>().size());
  ASSERT_EQ(back.of<UsblSample>().size(), data.of<UsblSample>().size());
  ASSERT_EQ(back.of<HeadingSample>().size(), data.of<HeadingSample>().size());
  ASSERT_EQ(back.reference.size(), data.reference.size());
  for (std::size_t i = 0; i < data.of<GpsSample>().size(); ++i) {
    EXPECT_EQ(back.of<GpsSample>()[i].header.received_ns, data.of<GpsSample>()[i].header.received_ns);
    EXPECT_EQ(back.of<GpsSample>()[i].fix, data.of<GpsSample>()[i].fix);
    EXPECT_EQ(back.of<GpsSample>()[i].satellites, data.of<GpsSample>()[i].satellites);
    expect_same(back.of<GpsSample>()[i].latitude_rad, data.of<GpsSample>()[i].latitude_rad);
    expect_same(back.of<GpsSample>()[i].longitude_rad, data.of<GpsSample>()[i].longitude_rad);
    expect_same(back.of<GpsSample>()[i].velocity_sigma_N_m_s, data.of<GpsSample>()[i].velocity_sigma_N_m_s);
    expect_same(back.of<DvlSample>()[i].velocity_D_m_s, data.of<DvlSample>()[i].velocity_D_m_s);
    expect_same(back.of<DvlSample>()[i].beam_velocity_m_s, data.of<DvlSample>()[i].beam_velocity_m_s);
    EXPECT_EQ(back.of<DvlSample>()[i].mode, data.of<DvlSample>()[i].mode);
    expect_same(back.of<DvlSample>()[i].altitude_m, data.of<DvlSample>()[i].altitude_m);
    expect_same(back.of<DepthSample>().at(i).depth_m, data.of<DepthSample>()[i].depth_m);
    expect_same(back.of<DepthSample>().at(i).sigma_m, data.of<DepthSample>()[i].sigma_m);
    expect_same(back.of<HeadingSample>()[i].heading_rad, data.of<HeadingSample>()[i].heading_rad);
    EXPECT_EQ(back.of<HeadingSample>()[i].north, data.of<HeadingSample>()[i].north);
    EXPECT_EQ(back.of<UsblSample>()[i].header.received_ns, data.of<UsblSample>()[i].header.received_ns);
    expect_same(back.of<UsblSample>()[i].sigma_m, data.of<UsblSample>()[i].sigma_m);
    EXPECT_EQ(back.of<UsblSample>()[i].frame, data.of<UsblSample>()[i].frame);
    expect_same(back.of<UsblSample>()[i].depth_m, data.of<UsblSample>()[i].depth_m);
    expect_same(back.of<UsblSample>()[i].relative_m, data.of<UsblSample>()[i].relative_m);
    expect_same(back.of<UsblSample>()[i].range_m, data.of<UsblSample>()[i].range_m);
    expect_same(back.of<UsblSample>()[i].bearing_rad, data.of<UsblSample>()[i].bearing_rad);
    expect_same(back.of<UsblSample>()[i].depression_rad, data.of<UsblSample>()[i].depression_rad);
    expect_same(back.of<UsblSample>()[i].sigma_rad, data.of<UsblSample>()[i].sigma_rad);
    expect_same(back.of<UsblSample>()[i].station_latitude_rad, data.of<UsblSample>()[i].station_latitude_rad);
    expect_same(back.of<UsblSample>()[i].station_longitude_rad,
                data.of<UsblSample>()[i].station_longitude_rad);
    expect_same(back.of<UsblSample>()[i].station_depth_m, data.of<UsblSample>()[i].station_depth_m);
    expect_same(back.of<UsblSample>()[i].station_rpy_rad, data.of<UsblSample>()[i].station_rpy_rad);
    expect_same(back.of<AirspeedSample>().at(i).baro_altitude_m,
                data.of<AirspeedSample>()[i].baro_altitude_m);
    expect_same(back.of<AirspeedSample>().at(i).true_airspeed_m_s,
                data.of<AirspeedSample>()[i].true_airspeed_m_s);
    expect_same(back.of<PropulsionSample>().at(i).rpm, data.of<PropulsionSample>()[i].rpm);
    expect_same(back.of<FinsSample>().at(i).stern_rad, data.of<FinsSample>()[i].stern_rad);
    expect_same(back.reference[i].velocity_N_m_s, data.reference[i].velocity_N_m_s);
    expect_same(back.reference[i].rpy_rad, data.reference[i].rpy_rad);
  }
}

TEST(WriteDataset, ReadsBackTheSamePlain) {
  expect_round_trip(false);
}

TEST(WriteDataset, ReadsBackTheSameCompressed) {
  expect_round_trip(true);
}

TEST(WriteDataset, GivesTheSameBytesTwiceAndRemovesWhatWasThere) {
  const DatasetFolder folder;
  Dataset data = sample_data();
  write(folder.path() / "a", data, {kDefaultEpochNs, true});
  write(folder.path() / "b", data, {kDefaultEpochNs, true});
  EXPECT_EQ(content(folder.path() / "a" / "imu.csv.gz"), content(folder.path() / "b" / "imu.csv.gz"));
  data.of<GpsSample>().clear();
  write(folder.path() / "a", data);
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "a" / "imu.csv.gz"));
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "a" / "gps.csv.gz"));
  EXPECT_TRUE(read(folder.path() / "a").of<GpsSample>().empty());
}

TEST(WriteDataset, LeavesOutColumnsThatNobodyKnows) {
  const DatasetFolder folder;
  Dataset data;
  data.of<DepthSample>().push_back(
      {header(kDefaultEpochNs + 1'500'000'000), 2.5, kUnknown, kUnknown, kUnknown});
  write(folder.path(), data);
  EXPECT_EQ(content(folder.path() / "depth.csv"), "t_s,depth_m\n1.50,2.5\n");
}

TEST(WriteDataset, SaysWhereItCannotWrite) {
  const DatasetFolder folder;
  folder.file("blocked", "a file where a folder is wanted");
  EXPECT_THROW(write(folder.path() / "blocked" / "inside", sample_data()), DatasetError);
}

TEST(NavCsv, HasTheReferenceColumnsAndUncertaintyBehind) {
  const DatasetFolder folder;
  NavState state;
  state.header.stamp_ns = kDefaultEpochNs - 250'000'000;
  state.mode = NavMode::dead_reckoning;
  state.alignment = AlignmentPhase::aligned;
  state.latitude_rad = 0.5;
  state.longitude_rad = -1.0;
  state.altitude_m = -20.25;
  state.velocity_N_m_s = {1.5, -0.5, 0.25};
  state.rpy_rad = {0.0, 0.1, -3.0};
  state.position_covariance_N_m2 = {4.0, 0, 0, 0, 9.0, 0, 0, 0, 16.0};
  state.velocity_covariance_N_m2_s2 = {0.04, 0, 0, 0, 0.09, 0, 0, 0, 0.16};
  state.rpy_sigma_rad = {0.01, 0.02, 0.03};
  NavCsv csv(folder.path() / "nav.csv", kDefaultEpochNs);
  csv.add(state);
  csv.close();
  EXPECT_EQ(
      content(folder.path() / "nav.csv"),
      "t_s,lat_deg,lon_deg,alt_m,vn_m_s,ve_m_s,vd_m_s,roll_deg,pitch_deg,yaw_deg,sigma_n_m,sigma_e_m,sigma_d_"
      "m,"
      "sigma_vn_m_s,sigma_ve_m_s,sigma_vd_m_s,sigma_roll_deg,sigma_pitch_deg,sigma_yaw_deg,mode,gps_outage_s,"
      "alignment\n"
      "-0.25,28.64788975654,-57.29577951308,-20.250000,1.500000,-0.500000,0.250000,0.000000000,5.729577951,"
      "-171.887338539,2.000000,3.000000,4.000000,0.200000,0.300000,0.400000,0.572957795,1.145915590,"
      "1.718873385,dead_reckoning,,aligned\n");
}

}  // namespace
}  // namespace fathom::dataset
