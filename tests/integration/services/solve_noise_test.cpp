// What `fathom solve` and `fathom report` say of an instrument that is noisier than its sigmas.
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "solve_fixture.hpp"

namespace fathom::test {
namespace {

class NoisyInstrument : public SolveTest {
 protected:
  void simulate(const std::vector<std::string>& set) {
    std::vector<std::string> arguments{"simulate", "survey", "--out", path("data"), "--duration", "150"};
    arguments.insert(arguments.end(), set.begin(), set.end());
    ASSERT_EQ(run("fathom", arguments), 0) << err;
  }
  const std::string& told(const std::string& command, const std::vector<std::string>& more) {
    std::vector<std::string> arguments{command, path("data"), "--config",
                                       std::string(FATHOM_SOURCE_DIR) + "/deploy/config/fusion.json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    EXPECT_EQ(run("fathom", arguments), 0) << err;
    return out;
  }
};

TEST_F(NoisyInstrument, IsNamedWithItsFactor) {
  simulate({"--set", "sensors.dvl.beam_sigma_m_s=0.05"});
  const auto metrics = nlohmann::json::parse(told("solve", {"--json", "--out", path("nav.csv")}));
  ASSERT_EQ(metrics["noise_factors"].size(), 1U) << metrics["noise_factors"];
  // Four beams at 30 degrees make 0.071 m/s of it, where 0.011 are configured.
  EXPECT_NEAR(metrics["noise_factors"]["dvl"].get<double>(), 6.5, 2.0);
  EXPECT_NE(told("solve", {"--out", path("nav.csv")}).find("the noise of dvl was up to "), std::string::npos);
  told("report", {"--out", path("report.html")});
  EXPECT_NE(content("report.html").find("The noise of dvl was up to "), std::string::npos);
}

TEST_F(NoisyInstrument, IsNoneOfASoundVehicle) {
  simulate({});
  const auto metrics = nlohmann::json::parse(told("solve", {"--json", "--out", path("nav.csv")}));
  EXPECT_TRUE(metrics["noise_factors"].empty()) << metrics["noise_factors"];
}

}  // namespace
}  // namespace fathom::test
