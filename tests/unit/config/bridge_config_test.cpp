#include "config/bridge/bridge_config.hpp"

#include <cstdio>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "config/service_config.hpp"
#include "support/paths.hpp"

namespace fathom::config {
namespace {

const std::string kShipped = test::source_dir() + "/deploy/config/";

template <class Config>
Config shipped(const std::string& name, std::vector<std::string> sets = {}) {
  return load_service_config<Config>({kShipped + name + ".json", std::move(sets)}).value;
}

// The message of the error that the overrides cause.
template <class Config>
std::string refused(const std::string& name, std::vector<std::string> sets) {
  try {
    (void)shipped<Config>(name, std::move(sets));
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(BridgeConfig, ShippedFilesLoad) {
  EXPECT_EQ(shipped<ImuBridgeConfig>("imu_bridge").sensors.at(0).sensor.protocol, "vectornav");
  EXPECT_EQ(shipped<DvlBridgeConfig>("dvl_bridge").sensors.at(0).sensor.protocol, "pd0");
  EXPECT_EQ(shipped<GpsBridgeConfig>("gps_bridge").sensors.at(0).sensor.time.mode,
            runtime::TimeMode::device_utc);
  EXPECT_EQ(shipped<DepthBridgeConfig>("depth_bridge").sensors.at(0).unit, DepthUnit::psi);
  EXPECT_EQ(shipped<HeadingBridgeConfig>("heading_bridge").sensors.at(0).sensor.name, "heading");
  EXPECT_EQ(shipped<UsblBridgeConfig>("usbl_bridge").sensors.at(0).sensor.source.type,
            runtime::SourceType::udp);
  EXPECT_EQ(shipped<ActuatorBridgeConfig>("actuator_bridge").sensors.at(0).sensor.rate_hz, 5.0);
}

TEST(BridgeConfig, OverridesReplaceTheSource) {
  const auto config = shipped<ImuBridgeConfig>(
      "imu_bridge", {R"(sensors.0.source={"type":"tcp_client","address":"10.0.0.7","port":7000})",
                     "sensors.0.mounting.rpy_deg=[0, 0, 90]"});
  const auto plan = sensor_plans(config).at(0);
  EXPECT_EQ(plan.sensor.source.type, runtime::SourceType::tcp_client);
  EXPECT_EQ(plan.sensor.source.port, 7000);
  EXPECT_NEAR(plan.R_BS[1], -1.0, 1e-15);
}

TEST(BridgeConfig, ErrorsNameFileKeyValueAndExpectation) {
  const std::string file = kShipped + "imu_bridge.json: ";
  const auto imu = [](std::vector<std::string> sets) {
    return refused<ImuBridgeConfig>("imu_bridge", std::move(sets));
  };
  EXPECT_EQ(imu({"sensors.0.source.baud=12"}),
            file + "sensors.0.source.baud: is 12, expected a whole number from 1200 to 4000000");
  EXPECT_EQ(imu({R"(sensors.0.source={"type":"serial"})"}),
            file + "sensors.0.source.path: is null, expected a path, because the type is serial or file");
  EXPECT_EQ(imu({R"(sensors.0.source={"type":"tcp_client"})"}),
            file + "sensors.0.source.port: is null, expected 1 to 65535, because the type is tcp or udp");
  EXPECT_EQ(imu({R"(sensors.0.source={"type":"udp","port":9,"address":"imu.local"})"}),
            file + "sensors.0.source.address: is \"imu.local\", expected a numeric IPv4 or IPv6 address");
  EXPECT_EQ(imu({R"(sensors.0.mounting={})"}).find(file + "sensors.0.mounting.frame: is missing"), 0U);
  EXPECT_EQ(
      imu({"sensors.0.protocol=xsens", R"(sensors.0.mounting={"frame":"flu"})"}),
      file +
          "sensors.0.mounting.frame: is \"flu\", expected frd or matrix, because the codec of xsens has "
          "turned the unit's own axes to forward-right-down already");
  EXPECT_EQ(imu({R"(sensors.0.mounting={"frame":"matrix"})"}),
            file + "sensors.0.mounting.R_BS: is null, expected 9 numbers of a right-handed rotation matrix");
  EXPECT_EQ(imu({R"(sensors.0.mounting={"frame":"matrix","R_BS":[1,0,0,0,1,0,0,0,-1]})"})
                .find(file + "sensors.0.mounting.R_BS: is [1,0,0"),
            0U);
  EXPECT_EQ(
      imu({"sensors.0.protocol=morse"}).find(file + "sensors.0.protocol: is \"morse\", expected one of "),
      0U);
  EXPECT_EQ(
      imu({"sensors.0.latitude_deg=3"}).find(file + "sensors.0.latitude_deg: is 3, expected no such key"),
      0U);
  EXPECT_EQ(imu({"sensors=[]"}), file + "sensors: is [], expected at least one instrument");
  EXPECT_EQ(imu({"clock.rate=10"}).find(file + "clock.epoch_ns: is 0"), 0U);
  EXPECT_EQ(imu({"vehicle="}).find(file + "vehicle: is "), 0U);
}

TEST(BridgeConfig, UnitAndLatitudeOfAPressureMustBeGiven) {
  const std::string sensor =
      R"("name":"d","source":{"type":"serial","path":"/dev/x"},"protocol":"paroscientific","time":{"mode":"arrival"},"rate_hz":1)";
  EXPECT_NE(refused<DepthBridgeConfig>("depth_bridge", {"sensors=[{" + sensor + R"(,"latitude_deg":1}])"})
                .find("sensors.0.unit: is missing"),
            std::string::npos);
  EXPECT_NE(refused<DepthBridgeConfig>("depth_bridge", {"sensors=[{" + sensor + R"(,"unit":"psi"}])"})
                .find("sensors.0.latitude_deg: is missing"),
            std::string::npos);
}

TEST(BridgeConfig, AKeyOfAnotherProtocolIsRefused) {
  const auto known_where = [](const std::string& key, const std::string& now, const std::string& known) {
    return "sensors.0." + key + "expected no such key where " + now + "; it is known where " + known;
  };
  struct Case {
    std::string answer;
    std::string expected;
  };
  const Case cases[] = {
      {refused<DepthBridgeConfig>("depth_bridge", {"sensors.0.ascii.prefix=P"}),
       known_where("ascii: is {\"prefix\":\"P\"}, ", "protocol is paroscientific",
                   "protocol is one of ascii_depth")},
      {refused<DvlBridgeConfig>("dvl_bridge",
                                {"sensors.0.protocol=a50", "sensors.0.heading_alignment_deg=0"}),
       known_where("heading_alignment_deg: is 0, ", "protocol is waterlinked",
                   "protocol is one of pd0, pd6")},
      {refused<GpsBridgeConfig>("gps_bridge", {"sensors.0.protocol=ubx", "sensors.0.require_checksum=true"}),
       known_where("require_checksum: is true, ", "protocol is ubx",
                   "protocol is one of nmea0183, nmea_attitude, psimssb")},
      {refused<AirDataBridgeConfig>("air_data_bridge", {"sensors.0.transducers.total_pressure=P"}),
       known_where("transducers: is {\"total_pressure\":\"P\"}, ", "protocol is ascii_air_data",
                   "protocol is one of nmea_air_data")},
      {refused<GpsBridgeConfig>("gps_bridge", {"sensors.0.source.type=udp"}),
       known_where("source.baud: is 115200, ", "type is udp", "type is one of serial")},
      {refused<GpsBridgeConfig>("gps_bridge", {"sensors.0.time.drift_ppm=9"}),
       known_where("time.drift_ppm: is 9, ", "mode is device_utc", "mode is one of device_clock")}};
  for (const Case& one : cases) EXPECT_NE(one.answer.find(one.expected), std::string::npos) << one.answer;
  // Aliases are the protocol that they stand for.
  EXPECT_EQ(refused<DvlBridgeConfig>("dvl_bridge",
                                     {"sensors.0.protocol=workhorse", "sensors.0.heading_alignment_deg=45"}),
            "accepted");
}

TEST(BridgeConfig, AnAirDataLineMustGiveTheAirspeedThatIsWanted) {
  const auto columns = [](const std::string& list) {
    return refused<AirDataBridgeConfig>("air_data_bridge", {"sensors.0.line.columns=[" + list + "]"});
  };
  const std::string speed = R"({"quantity":"indicated_airspeed","unit":"kn"})";
  const std::string height = R"({"quantity":"pressure_altitude","unit":"ft"})";
  const std::string warmth = R"({"quantity":"total_temperature","unit":"degC"})";
  EXPECT_EQ(columns(speed + "," + height + "," + warmth), "accepted");
  EXPECT_EQ(columns(R"({"quantity":"true_airspeed","unit":"m/s"})"), "accepted");
  EXPECT_NE(columns(speed + "," + height).find("with a temperature; or airspeed indicated"),
            std::string::npos);
  EXPECT_EQ(refused<AirDataBridgeConfig>("air_data_bridge", {"sensors.0.line.columns=[" + speed + "]",
                                                             "sensors.0.airspeed=indicated"}),
            "accepted");
  EXPECT_NE(columns(R"({"quantity":"indicated_airspeed","unit":"hPa"})").find("columns.0.unit"),
            std::string::npos);
  EXPECT_NE(columns(R"({"quantity":"indicated_airspeed"})").find("columns.0.unit"), std::string::npos);
  EXPECT_NE(columns(speed + "," + speed).find("each quantity once"), std::string::npos);
  EXPECT_NE(refused<AirDataBridgeConfig>("air_data_bridge", {"sensors.0.line.separator=."}).find("separator"),
            std::string::npos);
  EXPECT_NE(refused<AirDataBridgeConfig>("air_data_bridge", {"sensors.0.protocol=nmea_air_data",
                                                             "sensors.0.transducers.impact_pressure=IAS"})
                .find("comes twice"),
            std::string::npos);
}

TEST(BridgeConfig, TwoInstrumentsNeedTwoNames) {
  const std::string sensor =
      R"({"name":"gps","source":{"type":"serial","path":"/dev/x"},"protocol":"ubx","time":{"mode":"device_utc"},"rate_hz":5})";
  EXPECT_NE(refused<GpsBridgeConfig>("gps_bridge", {"sensors=[" + sensor + "," + sensor + "]"})
                .find("different names"),
            std::string::npos);
}

TEST(BridgeConfig, APressureWhoseSentenceSaysItsUnitNeedsNone) {
  const std::string sensor =
      R"("name":"d","source":{"type":"serial","path":"/dev/x"},"protocol":"nmea0183","time":{"mode":"arrival"},"rate_hz":1)";
  const auto config =
      shipped<DepthBridgeConfig>("depth_bridge", {"sensors=[{" + sensor + R"(,"latitude_deg":1}])"});
  EXPECT_FALSE(sensor_plan(config.sensors.at(0)).options.value_is_depth);
}

TEST(BridgeConfig, DepthUnitsBecomePascal) {
  const auto plan = sensor_plans(shipped<DepthBridgeConfig>(
      "depth_bridge", {"sensors.0.protocol=ascii_depth", "sensors.0.unit=dbar",
                       R"(sensors.0.ascii={"prefix":"P=","scale":0.1,"offset":-2})"}));
  EXPECT_DOUBLE_EQ(plan.at(0).options.pressure_unit_Pa, 1e4);
  EXPECT_DOUBLE_EQ(plan.at(0).options.ascii_scale, 1e3);
  EXPECT_DOUBLE_EQ(plan.at(0).options.ascii_offset, -2e4);
  EXPECT_FALSE(plan.at(0).options.value_is_depth);
}

TEST(BridgeConfig, WhatAStim300DoesNotSayReachesItsCodec) {
  const auto plan = [](const std::string& keys) {
    return sensor_plans(shipped<ImuBridgeConfig>("imu_bridge", {R"(sensors.0.protocol=stim)",
                                                                "sensors.0.time={\"mode\":\"arrival\"}",
                                                                "sensors.0.stim300={" + keys + "}"}))
        .at(0)
        .options.stim300;
  };
  EXPECT_EQ(plan("").accel_range_g, 10.0);
  EXPECT_EQ(plan("").increments_hz, 0.0);
  EXPECT_EQ(plan(R"("accel_range_g":5,"increments_hz":500)").accel_range_g, 5.0);
  EXPECT_EQ(plan(R"("accel_range_g":5,"increments_hz":500)").increments_hz, 500.0);
  const auto mistake = [](const std::string& set) {
    return refused<ImuBridgeConfig>("imu_bridge", {"sensors.0.protocol=stim300", set});
  };
  EXPECT_NE(mistake("sensors.0.stim300.accel_range_g=20").find("expected 5, 10, 30 or 80"),
            std::string::npos);
  EXPECT_NE(mistake("sensors.0.stim300.increments_hz=100").find("250, 500, 1000 or 2000"), std::string::npos);
  EXPECT_NE(refused<ImuBridgeConfig>("imu_bridge", {"sensors.0.stim300.accel_range_g=5"})
                .find("protocol is one of stim300"),
            std::string::npos);
}

TEST(BridgeConfig, HowAKvhUnitWasSetReachesItsCodec) {
  const auto plan = [](const std::string& rate_hz, const std::string& keys) {
    return sensor_plans(
               shipped<ImuBridgeConfig>(
                   "imu_bridge", {"sensors.0.protocol=kvh_1750", "sensors.0.rate_hz=" + rate_hz,
                                  "sensors.0.time={\"mode\":\"arrival\"}", "sensors.0.kvh={" + keys + "}"}))
        .at(0)
        .options.kvh;
  };
  EXPECT_EQ(plan("100", "").increments_hz, 0.0);
  EXPECT_FALSE(plan("100", "").degrees);
  EXPECT_TRUE(plan("100", R"("rotation_unit":"deg")").degrees);
  EXPECT_EQ(plan("100", R"("temperature_unit":"F_100")").temperature, codec::KvhTemperature::fahrenheit_100);
  // A rate that was measured is that of the unit that is near; one of its own is kept.
  EXPECT_EQ(plan("998.7", R"("rotation":"delta")").increments_hz, 1'000.0);
  EXPECT_EQ(plan("248", R"("rotation":"delta")").increments_hz, 250.0);
  EXPECT_EQ(plan("200", R"("rotation":"delta")").increments_hz, 200.0);
  EXPECT_NE(
      refused<ImuBridgeConfig>("imu_bridge", {"sensors.0.kvh.rotation=delta"}).find("protocol is one of kvh"),
      std::string::npos);
}

TEST(BridgeConfig, TheNorthOfASentenceThatDoesNotSayItReachesItsCodec) {
  const auto plan = [](const std::string& set) {
    return sensor_plans(shipped<HeadingBridgeConfig>("heading_bridge", {"sensors.0.protocol=pashr", set}))
        .at(0)
        .options.untold_north;
  };
  EXPECT_FALSE(plan("sensors.0.north=null"));
  EXPECT_EQ(plan(R"(sensors.0.north="true")"), North::true_north);
  EXPECT_EQ(plan("sensors.0.north=magnetic"), North::magnetic);
  EXPECT_NE(refused<HeadingBridgeConfig>("heading_bridge", {"sensors.0.north=magnetic"})
                .find("protocol is one of nmea_attitude"),
            std::string::npos);
}

TEST(BridgeConfig, AirColumnsAndNamesReachTheCodec) {
  const auto plan = sensor_plans(shipped<AirDataBridgeConfig>(
      "air_data_bridge",
      {R"(sensors.0.line={"prefix":"$A,","separator":";","columns":[{"quantity":"ignored"},)"
       R"({"quantity":"true_airspeed","unit":"mph"}]})",
       "sensors.0.require_checksum=false"}));
  const codec::AirDataOptions& air = plan.at(0).options.air_data;
  EXPECT_FALSE(plan.at(0).options.require_checksum);
  EXPECT_EQ(air.prefix.view(), "$A,");
  EXPECT_EQ(air.separator, ';');
  ASSERT_EQ(air.count, 2U);
  EXPECT_EQ(air.columns[1].quantity, codec::AirQuantity::true_airspeed);
  EXPECT_EQ(air.columns[1].unit, codec::AirUnit::mph);
  const auto nmea = sensor_plans(shipped<AirDataBridgeConfig>(
      "air_data_bridge", {"sensors.0.protocol=nmea_air_data", "sensors.0.transducers.true_airspeed=SPD"}));
  EXPECT_EQ(nmea.at(0).options.air_data.transducer[1].view(), "SPD");
}

TEST(BridgeConfig, HashFollowsTheEffectiveConfiguration) {
  const std::string file = kShipped + "imu_bridge.json";
  const auto plain = load_service_config<ImuBridgeConfig>({file, {}});
  EXPECT_EQ(plain.hash, load_service_config<ImuBridgeConfig>({file, {"log.level=info"}}).hash);
  EXPECT_NE(plain.hash, load_service_config<ImuBridgeConfig>({file, {"log.level=debug"}}).hash);
}

}  // namespace
}  // namespace fathom::config
