// What the documentation of configurations says, which comes from the description that the loader follows.
#include "config/explain.hpp"

#include <algorithm>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "config/fusion/fusion_config.hpp"
#include "config/registry.hpp"
#include "config/service_config.hpp"
#include "support/unit_of_key.hpp"

namespace fathom::config {
namespace {

using testing::HasSubstr;

TEST(Keys, EachHasASentenceAndTheUnitThatItsNameSays) {
  std::size_t keys = 0;
  for (const ConfigKind& kind : config_kinds()) {
    for (const FieldRow& row : kind.rows()) {
      ++keys;
      EXPECT_GE(row.info.sentence.size(), 2U) << kind.name << " " << row.key;
      // A moment, whose ending is also that of lengths along N, and a product of units without a name.
      if (row.info.key == "trim_moment_sigma_N_m" || row.info.key == "roll_per_turn_s_m") continue;
      EXPECT_EQ(row.info.unit, test::unit_of_key(row.info.key).value_or(row.info.unit))
          << kind.name << " " << row.key;
    }
  }
  EXPECT_GT(keys, 500U);
}

TEST(Keys, AreKnownToChoicesThatThereAre) {
  std::size_t limited = 0;
  for (const ConfigKind& kind : config_kinds()) {
    const auto rows = kind.rows();
    const auto section_of = [](const FieldRow& row) { return row.key.substr(0, row.key.rfind('.') + 1); };
    for (const FieldRow& row : rows) {
      if (row.info.only_for.empty()) continue;
      ++limited;
      const auto decider = std::find_if(rows.begin(), rows.end(), [&](const FieldRow& one) {
        return one.info.decides() && section_of(one) == section_of(row);
      });
      ASSERT_NE(decider, rows.end()) << kind.name << " " << row.key;
      for (const std::string& choice : row.info.only_for)
        EXPECT_THAT(decider->info.choices, testing::Contains(choice)) << kind.name << " " << row.key;
      for (const std::string& choice : row.info.required_for)
        EXPECT_TRUE(row.info.known_to(choice)) << kind.name << " " << row.key;
    }
  }
  EXPECT_GT(limited, 40U);
}

TEST(Keys, ReachIntoSectionsAndLists) {
  const auto rows = fusion_kind().rows();
  const auto row = [&](const std::string& key) {
    const auto at =
        std::find_if(rows.begin(), rows.end(), [&](const FieldRow& one) { return one.key == key; });
    return at == rows.end() ? FieldRow{} : *at;
  };
  EXPECT_EQ(row("engine.imu.nominal_rate_hz").range, "1 to 2000");
  EXPECT_EQ(row("engine.imu.nominal_rate_hz").default_text, "100");
  EXPECT_EQ(row("engine.imu.nominal_rate_hz").info.unit, "Hz");
  EXPECT_EQ(row("engine.sensors").default_text, "") << "a section has no default of its own";
  EXPECT_EQ(row("engine.sensors[].kind").range,
            "gps, dvl, depth, heading, usbl, airspeed, propulsion, fins, range, fix");
  EXPECT_EQ(row("engine.sensors[].use_beams").range, "true or false");
  EXPECT_THAT(row("engine.sensors[].use_beams").info.sentence, HasSubstr("dvl: "));
  EXPECT_EQ(row("engine.sensors[].use_position").default_text, "true");
  EXPECT_EQ(row("engine.sensors[].sigma_deg").default_text, "[0.498473, 0.498473, 0.498473]")
      << "that of its kind";
  EXPECT_THAT(row("engine.sensors[].reacquire_s").default_text,
              HasSubstr("21 for gps; 5 for dvl, depth; 30 for"));
  EXPECT_EQ(row("engine.forecast_limits[].name").range, "name");
  EXPECT_EQ(row("start.state.latitude_deg").range, "-90 to 90");
}

TEST(Keys, ArePrintedInColumns) {
  FieldRow first{"a", {}, "1 to 2", "1"};
  first.info.unit = "m";
  first.info.sentence = "one thing";
  FieldRow second{"longer.key", {}, "", ""};
  second.info.sentence = "another";
  second.info.required = true;
  EXPECT_EQ(explain_text({first, second}),
            "KEY         UNIT  RANGE   DEFAULT   MEANING\n"
            "a           m     1 to 2  1         one thing\n"
            "longer.key                required  another\n");
}

TEST(Keys, OfAServiceAreThoseOfItsFile) {
  const std::string text = explain_service_config<FusionConfig>();
  EXPECT_EQ(text, explain_text(fusion_kind().rows()));
  EXPECT_THAT(text, HasSubstr("engine.imu.gyro_bias_sigma_deg_h"));
}

}  // namespace
}  // namespace fathom::config
