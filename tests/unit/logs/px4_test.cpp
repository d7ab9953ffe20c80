#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/units.hpp"
#include "logs/convert/build.hpp"
#include "logs/convert/vehicle.hpp"

namespace fathom::logs {
namespace {

using ::testing::HasSubstr;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

Series series(const std::string& topic, std::vector<std::string> columns,
              const std::vector<std::vector<double>>& rows, unsigned instance = 0) {
  Series out;
  out.topic = topic;
  out.instance = instance;
  out.columns = std::move(columns);
  for (const auto& row : rows) {
    out.t_us.push_back(static_cast<std::int64_t>(row[0]));
    out.values.insert(out.values.end(), row.begin(), row.end());
  }
  return out;
}

double seconds(TimeNs stamp) {
  return to_seconds(stamp - dataset::kDefaultEpochNs);
}

TEST(Px4, IncrementsBecomeRatesAtTheEndOfTheirPeriods) {
  Log log;
  log.series.push_back(series(
      "vehicle_imu",
      {"timestamp", "timestamp_sample", "delta_angle[0]", "delta_angle[1]", "delta_angle[2]",
       "delta_velocity[0]", "delta_velocity[1]", "delta_velocity[2]", "delta_angle_dt", "delta_velocity_dt"},
      {{1'000'300, 1'000'000, 0.005, 0.0, -0.01, 0.0, 0.04, -0.0490, 5000, 4000},
       {1'005'300, 1'005'000, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 5000, 0}}));
  const Vehicle out = px4(log);
  const auto& imu = out.data.of<ImuSample>();
  ASSERT_EQ(imu.size(), 2U);
  EXPECT_EQ(seconds(imu[0].header.stamp_ns), 1.0);
  EXPECT_EQ(seconds(imu[0].header.received_ns), 1.0003);
  EXPECT_DOUBLE_EQ(imu[0].angular_rate_B_rad_s[0], 1.0);
  EXPECT_DOUBLE_EQ(imu[0].angular_rate_B_rad_s[2], -2.0);
  EXPECT_DOUBLE_EQ(imu[0].specific_force_B_m_s2[1], 10.0);
  EXPECT_DOUBLE_EQ(imu[0].specific_force_B_m_s2[2], -12.25);
  EXPECT_FALSE(known(imu[1].specific_force_B_m_s2[0]));  // no period, no force
}

TEST(Px4, TheFinestUnitIsTakenUnlessAnotherIsChosen) {
  const std::vector<std::string> columns{"timestamp",
                                         "gyro_rad[0]",
                                         "gyro_rad[1]",
                                         "gyro_rad[2]",
                                         "accelerometer_timestamp_relative",
                                         "accelerometer_m_s2[0]",
                                         "accelerometer_m_s2[1]",
                                         "accelerometer_m_s2[2]"};
  Log log;
  std::vector<std::vector<double>> slow;
  for (int i = 0; i < 5; ++i)
    slow.push_back({1e6 + 5e5 * i, 0, 0, 0, i == 2 ? 2147483647.0 : 0.0, 0, 0, -9.8});
  log.series.push_back(series("sensor_combined", columns, slow));
  std::vector<std::vector<double>> fast;
  for (int i = 0; i < 20; ++i) fast.push_back({1e6 + 4e3 * i, 0, 0, 1, 0, 0, 0, -1, 4000, 4000});
  log.series.push_back(series(
      "vehicle_imu",
      {"timestamp", "delta_angle[0]", "delta_angle[1]", "delta_angle[2]", "unused", "delta_velocity[0]",
       "delta_velocity[1]", "delta_velocity[2]", "delta_angle_dt", "delta_velocity_dt"},
      fast, 1));
  EXPECT_EQ(px4(log).sources.at("imu"), "vehicle_imu:1");
  const Vehicle chosen = px4(log, {{{"imu", "sensor_combined"}}, false});
  const auto& imu = chosen.data.of<ImuSample>();
  ASSERT_EQ(imu.size(), 5U);
  EXPECT_EQ(imu[1].specific_force_B_m_s2[2], -9.8);
  EXPECT_FALSE(known(imu[2].specific_force_B_m_s2[2]));
  EXPECT_THROW((void)px4(log, {{{"imu", "vehicle_imu:0"}}, false}), LogError);
}

TEST(Px4, PositionsOfOldAndNewMessagesAreTheSame) {
  Log old_log;
  old_log.series.push_back(series(
      "vehicle_gps_position",
      {"timestamp", "time_utc_usec", "lat", "lon", "alt", "alt_ellipsoid", "s_variance_m_s", "fix_type",
       "eph", "epv", "vel_n_m_s", "vel_e_m_s", "vel_d_m_s", "vel_ned_valid", "timestamp_time_relative",
       "satellites_used", "heading"},
      {{2e6, 1.6e15, 473977422, -85455940, 488000, 535000, 0.5, 3, 1.5, 2.5, 1, 2, -3, 1, -1e5, 9, -0.5},
       {3e6, 0, 473977422, -85455940, 488000, 535000, 0.5, 6, 0.0, 2.5, 1, 2, -3, 0, 0, 9, kNan}}));
  Log new_log;
  new_log.series.push_back(
      series("sensor_gps",
             {"timestamp", "timestamp_sample", "latitude_deg", "longitude_deg", "altitude_msl_m",
              "altitude_ellipsoid_m", "s_variance_m_s", "fix_type", "eph", "epv", "vel_n_m_s", "vel_e_m_s",
              "vel_d_m_s", "vel_ned_valid", "satellites_used"},
             {{2.1e6, 2e6, 47.3977422, -8.545594, 488, 535, 0.5, 3, 1.5, 2.5, 1, 2, -3, 1, 9}}));
  const Vehicle a = px4(old_log);
  const Vehicle b = px4(new_log);
  const auto& old_gps = a.data.of<GpsSample>();
  ASSERT_EQ(old_gps.size(), 2U);
  const GpsSample& new_gps = b.data.of<GpsSample>().at(0);
  EXPECT_EQ(old_gps[0].header.stamp_ns, new_gps.header.stamp_ns);
  EXPECT_EQ(seconds(new_gps.header.received_ns), 2.1);
  EXPECT_NEAR(old_gps[0].latitude_rad, 47.3977422 * kRadPerDeg, 1e-15);
  EXPECT_NEAR(old_gps[0].latitude_rad, new_gps.latitude_rad, 1e-15);
  EXPECT_NEAR(old_gps[0].longitude_rad, new_gps.longitude_rad, 1e-15);
  EXPECT_EQ(old_gps[0].altitude_m, 535.0);
  EXPECT_EQ(new_gps.altitude_m, 535.0);
  EXPECT_EQ(new_gps.altitude_msl_m, 488.0);
  EXPECT_EQ(old_gps[0].fix, GpsFix::fix_3d);
  EXPECT_EQ(old_gps[1].fix, GpsFix::rtk_fixed);
  EXPECT_FALSE(known(old_gps[1].velocity_N_m_s[0]));      // not valid, it says
  EXPECT_FALSE(known(old_gps[1].position_sigma_N_m[0]));  // zero is no accuracy
  const auto& heading = a.data.of<HeadingSample>();
  ASSERT_EQ(heading.size(), 1U);
  EXPECT_DOUBLE_EQ(heading[0].heading_rad, 2.0 * std::numbers::pi - 0.5);
  // 1.6e15 us of UTC were 0.1 s before the stamp of 2 s.
  EXPECT_EQ(a.utc_of_start_ns.value(), 1'600'000'000'000'000'000 - 1'900'000'000);
  const Vehicle utc = px4(old_log, {{}, true});
  EXPECT_EQ(utc.data.of<GpsSample>()[0].header.stamp_ns, 1'600'000'000'100'000'000);
  EXPECT_THROW((void)px4(new_log, {{}, true}), LogError);
}

TEST(Px4, WithoutAnEllipsoidalAltitudeItSaysSo) {
  Log log;
  log.series.push_back(series("vehicle_gps_position", {"timestamp", "lat", "lon", "alt", "alt_ellipsoid"},
                              {{1e6, 1e7, 1e7, 12000, 0}}));
  const Vehicle out = px4(log);
  EXPECT_EQ(out.data.of<GpsSample>()[0].altitude_m, 12.0);
  ASSERT_EQ(out.notes.size(), 1U);
  EXPECT_THAT(out.notes[0], HasSubstr("mean sea level"));
}

TEST(Px4, MadeUpAirspeedsAreNoMeasurement) {
  Log log;
  log.series.push_back(series("airspeed_validated",
                              {"timestamp", "indicated_airspeed_m_s", "calibrated_airspeed_m_s",
                               "true_airspeed_m_s", "airspeed_source"},
                              {{1e6, 10, 11, 12, 1}, {2e6, 20, 21, 22, 0}, {3e6, 30, 31, 32, 4}}));
  const Vehicle out = px4(log);
  const auto& air = out.data.of<AirspeedSample>();
  ASSERT_EQ(air.size(), 1U);
  EXPECT_EQ(air[0].airspeed_m_s, 11.0);
  EXPECT_EQ(air[0].true_airspeed_m_s, 12.0);
  EXPECT_THAT(out.notes.at(0), HasSubstr("2 rows"));
}

TEST(Px4, EarlyBarometersGaveHectopascal) {
  for (const double unit : {1.0, 100.0}) {
    Log log;
    log.series.push_back(
        series("sensor_baro", {"timestamp", "pressure", "temperature"}, {{1e6, 101325.0 / unit, 20}}));
    const Vehicle out = px4(log);
    ASSERT_EQ(out.tables.size(), 1U);
    EXPECT_NEAR(out.tables[0].values[0], 101325.0, 1e-9);
    EXPECT_NEAR(out.tables[0].values[2], 0.0, 1e-6);
    // No airspeed in the log: the barometer has rows of its own.
    ASSERT_EQ(out.data.of<AirspeedSample>().size(), 1U);
    EXPECT_FALSE(known(out.data.of<AirspeedSample>()[0].airspeed_m_s));
  }
  EXPECT_NEAR(standard_altitude_m(89874.6), 1000.0, 0.1);  // ICAO table
  EXPECT_NEAR(standard_altitude_m(54019.9), 5000.0, 0.5);
}

TEST(Px4, ABarometricAltitudeIsGivenOnce) {
  Table baro{"baro", {"altitude_m"}, {}, {}};
  std::vector<AirspeedSample> air(6);
  for (int i = 0; i < 6; ++i) air[static_cast<std::size_t>(i)].header.stamp_ns = i * kNsPerSecond / 10;
  for (int i = 0; i < 3; ++i) {
    baro.stamps_ns.push_back(i * kNsPerSecond / 5 + 1);
    baro.values.push_back(100.0 + i);
  }
  attach_baro(baro, 0, air);
  const std::vector<double> want{kNan, 100, kNan, 101, kNan, 102};
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(known(air[i].baro_altitude_m), known(want[i])) << i;
    if (known(want[i])) {
      EXPECT_EQ(air[i].baro_altitude_m, want[i]);
    }
  }
}

}  // namespace
}  // namespace fathom::logs
