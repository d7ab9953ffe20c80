// An engine that takes up a drop goes on with it to the last bit, in every phase of the alignment.

#include <fstream>
#include <iterator>
#include <set>
#include <span>
#include <string>

#include <gtest/gtest.h>

#include "support/paths.hpp"
#include "support/vehicles/drop_run.hpp"
#include "support/vehicles/engine_states.hpp"

namespace fathom::estimation {
namespace {

TEST(SavedDrop, GoesOnToTheLastBit) {
  const test::Fall fall(40.0);
  FusionEngine first(test::drop_config());
  first.start_from(test::release());
  std::set<AlignmentPhase> phases;
  std::optional<FusionEngine> second;
  int compared = 0;
  for (std::size_t i = 0; i < fall.samples.size(); ++i) {
    if (i % 60 == 0 && i > 0) {
      std::vector<std::byte> image;
      ASSERT_TRUE(first.save(image));
      second.emplace(test::drop_config());
      ASSERT_EQ(second->restore(image), "");
      phases.insert(first.nav_state().alignment);
    }
    test::feed(first, fall.samples[i]);
    if (!second) continue;
    test::feed(*second, fall.samples[i]);
    // What waited when it was saved acts with the next inertial sample.
    if (i % 60 < 20) continue;
    const NavState& a = first.nav_state();
    const NavState& b = second->nav_state();
    ASSERT_EQ(a.alignment, b.alignment);
    ASSERT_EQ(a.latitude_rad, b.latitude_rad);
    ASSERT_EQ(a.altitude_m, b.altitude_m);
    ASSERT_EQ(a.velocity_N_m_s, b.velocity_N_m_s);
    ASSERT_EQ(a.q_NB, b.q_NB);
    ++compared;
  }
  EXPECT_GT(compared, 2000);
  EXPECT_GE(phases.size(), 3U);
  EXPECT_TRUE(phases.contains(AlignmentPhase::aligned));
}

TEST(SavedStates, OfASurveyWithEveryInstrumentAreTakenUp) {
  for (const double at_s : {2.0, 12.0, 24.0}) {
    const test::EngineState state = test::survey_state(at_s);
    ASSERT_FALSE(state.image.empty());
    FusionEngine engine(state.config);
    ASSERT_EQ(engine.restore(state.image), "") << at_s;
    state.feed_to(engine);
    std::vector<std::byte> image;
    ASSERT_TRUE(engine.save(image));
    FusionEngine another(state.config);
    EXPECT_EQ(another.restore(image), "") << at_s;
  }
}

/// An engine that goes on from a state which the first version of the archive wrote; no orders.
NavState gone_on_from(const std::string& file, const test::EngineState& state) {
  std::ifstream bytes(test::vectors_dir() + "/archive/" + file, std::ios::binary);
  const std::string image((std::istreambuf_iterator<char>(bytes)), {});
  EXPECT_FALSE(image.empty()) << file;
  FusionEngine engine(state.config);
  EXPECT_EQ(engine.restore(std::as_bytes(std::span(image))), "") << file;
  for (const auto& one : state.next) {
    std::visit(
        [&]<class T>(const T& sample) {
          if constexpr (!std::is_same_v<T, Command>) engine.add(sample);
        },
        one);
  }
  return engine.nav_state();
}

// What the build that wrote them made of the second after them: an estimator that has learnt to consider what
// it left out then goes on from the same place, if not to the bit.
TEST(SavedStates, OfTheFirstVersionAreTakenUp) {
  const NavState survey = gone_on_from("survey.v1", test::survey_state(48.0));
  EXPECT_NEAR(survey.latitude_rad, 0.63529719041432187, 1e-10);
  EXPECT_NEAR(survey.longitude_rad, 2.2235066761446785, 1e-10);
  EXPECT_NEAR(survey.altitude_m, 18.490737483902635, 1e-3);
  EXPECT_NEAR(survey.rpy_rad[2], 2.5031130389052039, 1e-5);
  const NavState drop = gone_on_from("drop.v1", test::drop_state(30.0));
  EXPECT_NEAR(drop.latitude_rad, 0.6000676365507297, 1e-10);
  EXPECT_NEAR(drop.longitude_rad, 2.0000840493002938, 1e-10);
  EXPECT_NEAR(drop.altitude_m, -81.900773177163387, 1e-3);
  EXPECT_NEAR(drop.rpy_rad[0], 0.000294962486762574, 1e-6);
}

}  // namespace
}  // namespace fathom::estimation
