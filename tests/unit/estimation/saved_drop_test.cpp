// An engine that takes up a drop goes on with it to the last bit, in every phase of the alignment.

#include <set>

#include <gtest/gtest.h>

#include "support/drop_run.hpp"
#include "support/engine_states.hpp"

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

}  // namespace
}  // namespace fathom::estimation
