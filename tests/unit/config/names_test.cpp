// Names become topic keys, file names, metric labels and words on screens: the door lets no others in.

#include <fstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/is_name.hpp"
#include "config/registry.hpp"
#include "support/paths.hpp"

namespace fathom::config {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

/// The answer of `fathom-KIND --check` to a shipped file and one override.
std::string refusal(const std::string& kind, const std::string& set) {
  for (const ConfigKind& each : config_kinds()) {
    if (each.name != kind) continue;
    try {
      each.check({test::source_dir() + "/deploy/config/" + kind + ".json", {set}});
      return "accepted";
    } catch (const ConfigError& error) {
      return error.what();
    }
  }
  return "no such kind";
}

constexpr std::array kBad{"a/b",       "<script>alert(1)</script>",
                          "",          ".",
                          "../../etc", "a b",
                          "a\"b",      "a{b}",
                          "a\\b",      "\xc3\xa4",
                          "a\nb",      "01234567890123456789012345678901"};

TEST(Names, HaveASafeAlphabet) {
  for (const char* good :
       {"auv", "gps0", "imu_2", "aft", "hull-7", "A.1", "_x", "0123456789012345678901234567890"}) {
    EXPECT_TRUE(is_name(good)) << good;
  }
  for (const char* bad : kBad) EXPECT_FALSE(is_name(bad)) << bad;
}

TEST(Names, AreCheckedAtTheDoorOfEveryService) {
  struct Case {
    std::string kind, key;
  };
  for (const auto& [kind, key] : std::vector<Case>{{"heading_bridge", "vehicle"},
                                                   {"monitor", "vehicle"},
                                                   {"console", "vehicle"},
                                                   {"heading_bridge", "sensors.0.name"},
                                                   {"imu_bridge", "sensors.0.name"},
                                                   {"fusion", "instance"},
                                                   {"fusion", "engine.sensors.0.sensor"},
                                                   {"fusion", "engine.forecast_limits.0.name"},
                                                   {"monitor", "sensors.0.name"},
                                                   {"monitor", "services.0.name"}}) {
    EXPECT_EQ(refusal(kind, key + "=auv-2.b"), "accepted") << kind;
    for (const char* bad : kBad) {
      EXPECT_THAT(refusal(kind, key + "=" + bad),
                  AllOf(HasSubstr(kind + ".json"), HasSubstr(key + ": is "), HasSubstr("1 to 31 letters")))
          << bad;
    }
  }
  EXPECT_THAT(refusal("fusion", "imu_sensor=<script>"), HasSubstr("imu_sensor: is \"<script>\""));
  EXPECT_THAT(refusal("fusion", "bus.security.identity=../keys/monitor"), HasSubstr("bus.security.identity"));
}

}  // namespace
}  // namespace fathom::config
