// What `fathom solve` and `fathom report` say of an instrument that is worse than its sigmas.
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "solve_fixture.hpp"
#include "support/paths.hpp"

namespace fathom::test {
namespace {

class WorseThanSaid : public SolveTest {
 protected:
  void simulate(const std::vector<std::string>& set, const std::string& duration_s = "150") {
    std::vector<std::string> arguments{"simulate", "survey", "--out", path("data"), "--duration", duration_s};
    arguments.insert(arguments.end(), set.begin(), set.end());
    ASSERT_EQ(run("fathom", arguments), 0) << err;
  }
  const std::string& told(const std::string& command, const std::vector<std::string>& more) {
    std::vector<std::string> arguments{command, path("data"), "--config",
                                       source_dir() + "/deploy/config/fusion.json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    EXPECT_EQ(run("fathom", arguments), 0) << err;
    return out;
  }
};

TEST_F(WorseThanSaid, NoiseIsNamedWithItsFactor) {
  simulate({"--set", "sensors.dvl.beam_sigma_m_s=0.05"});
  const auto metrics = nlohmann::json::parse(told("solve", {"--json", "--out", path("nav.csv")}));
  ASSERT_EQ(metrics["noise_factors"].size(), 1U) << metrics["noise_factors"];
  // Four beams at 30 degrees make 0.071 m/s of it, where 0.011 are configured.
  EXPECT_NEAR(metrics["noise_factors"]["dvl"].get<double>(), 6.5, 2.0);
  EXPECT_NE(told("solve", {"--out", path("nav.csv")}).find("the noise of dvl was up to "), std::string::npos);
  told("report", {"--out", path("report.html")});
  EXPECT_NE(content("report.html").find("The noise of dvl was up to "), std::string::npos);
}

TEST_F(WorseThanSaid, NoiseOfTheInertialUnitIsNamed) {
  struct Case {
    const char* set;
    const char* name;
    double factor;
  };
  for (const Case& one :
       {Case{"sensors.imu.gyro.random_walk_deg_sqrt_h=0.5", "gyros", 5.0},
        Case{"sensors.imu.accelerometer.random_walk_m_s_sqrt_h=0.3", "accelerometers", 10.0}}) {
    simulate({"--set", one.set}, "400");
    const auto metrics = nlohmann::json::parse(told("solve", {"--json", "--out", path("nav.csv")}));
    ASSERT_TRUE(metrics["noise_factors"].contains(one.name)) << metrics["noise_factors"];
    EXPECT_NEAR(metrics["noise_factors"][one.name].get<double>() / one.factor, 1.0, 0.6) << one.name;
    EXPECT_LT(metrics["nees"]["velocity"]["mean"].get<double>(), 7.5) << one.name;
    const std::string words = std::string("the noise of ") + one.name + " was up to ";
    EXPECT_NE(told("solve", {"--out", path("nav.csv")}).find(words), std::string::npos);
  }
}

TEST_F(WorseThanSaid, ASlowErrorOfGpsIsNamedWithItsSigma) {
  simulate({"--set", "sensors.gps.correlated_sigma_m=4"});
  const auto metrics = nlohmann::json::parse(told("solve", {"--json", "--out", path("nav.csv")}));
  ASSERT_TRUE(metrics["slow_errors"].contains("gps")) << metrics["slow_errors"];
  const auto& slow = metrics["slow_errors"]["gps"];
  EXPECT_NEAR(slow["sigma_m"].get<double>(), 4.0, 0.8);
  EXPECT_NEAR(slow["configured_sigma_m"].get<double>(), 1.5, 1e-9);
  EXPECT_NE(told("solve", {"--out", path("nav.csv")}).find("the fixes of gps are off slowly by "),
            std::string::npos);
}

TEST_F(WorseThanSaid, ABiasIsNamedWithItsAxis) {
  simulate({"--set", "sensors.imu.gyro.bias_sigma_deg_h=100"});
  const auto metrics = nlohmann::json::parse(told("solve", {"--json", "--out", path("nav.csv")}));
  ASSERT_GE(metrics["biases"].size(), 2U) << metrics["biases"];
  for (const auto& [axis, bias] : metrics["biases"].items()) {
    EXPECT_EQ(axis.substr(0, 5), "gyro_");
    EXPECT_EQ(bias["unit"], "deg/h");
    EXPECT_NEAR(bias["configured_sigma"].get<double>(), 1.0, 1e-9);
    EXPECT_GT(std::abs(bias["value"].get<double>()), 5.0) << axis;
    EXPECT_LT(std::abs(bias["value"].get<double>()), 300.0) << axis;
  }
  EXPECT_NE(told("solve", {"--out", path("nav.csv")}).find("the bias of gyro "), std::string::npos);
  told("report", {"--out", path("report.html")});
  EXPECT_NE(content("report.html").find("The bias of gyro "), std::string::npos);
}

TEST_F(WorseThanSaid, NothingIsOfASoundVehicle) {
  simulate({});
  const auto metrics = nlohmann::json::parse(told("solve", {"--json", "--out", path("nav.csv")}));
  EXPECT_TRUE(metrics["noise_factors"].empty()) << metrics["noise_factors"];
  EXPECT_TRUE(metrics["biases"].empty()) << metrics["biases"];
}

}  // namespace
}  // namespace fathom::test
