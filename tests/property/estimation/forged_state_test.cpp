// Whatever stands in an engine's state that comes from a disk or a network: it is refused with a reason and
// changes nothing, or the engine goes on with it.

#include <cstring>
#include <string>

#include <gtest/gtest.h>

#include "support/vehicles/survey_run.hpp"

namespace fathom::estimation {
namespace {

using test::SurveyRun;

std::vector<std::byte> saved_at(const SurveyRun& run, double share) {
  FusionEngine engine(SurveyRun::config());
  const auto cut = static_cast<std::size_t>(share * static_cast<double>(run.samples.size()));
  for (std::size_t i = 0; i < cut; ++i) test::feed(engine, run.samples[i]);
  std::vector<std::byte> image;
  EXPECT_TRUE(engine.save(image));
  return image;
}

/// Restores into an engine that navigates and lets it go on for a second. The reason of a refusal.
std::string tried(const SurveyRun& run, FusionEngine& engine, std::span<const std::byte> image) {
  const NavState before = engine.nav_state();
  const std::string why = engine.restore(image);
  if (!why.empty()) {
    EXPECT_EQ(std::memcmp(&before, &engine.nav_state(), sizeof before), 0) << why;
  }
  const TimeNs from_ns = engine.nav_state().header.stamp_ns;
  for (const test::Sample& sample : run.samples) {
    const TimeNs at_ns = test::header(sample).received_ns;
    if (at_ns > from_ns && at_ns < from_ns + kNsPerSecond) test::feed(engine, sample);
  }
  for (Verdict verdict; engine.next_verdict(verdict);) continue;
  return why;
}

TEST(ForgedState, MutatedImagesAreRefusedOrHarmless) {
  const SurveyRun run({.duration_s = 40.0, .dive_s = 30.0});
  test::Normal random(5);
  int refused = 0;
  for (const double share : {0.1, 0.9}) {
    const std::vector<std::byte> good = saved_at(run, share);
    FusionEngine engine(SurveyRun::config());
    for (int trial = 0; trial < 100; ++trial) {
      SCOPED_TRACE(trial);
      std::vector<std::byte> bad = good;
      for (int i = 0; i < 1 + trial % 8; ++i) {
        const auto at = static_cast<std::size_t>(random.uniform(0.0, static_cast<double>(bad.size())));
        const auto to = static_cast<unsigned char>(random.uniform(0.0, 256.0));
        bad[std::min(at, bad.size() - 1)] = std::byte{to};
      }
      refused += tried(run, engine, bad).empty() ? 0 : 1;
      ASSERT_EQ(engine.restore(good), "");
    }
  }
  EXPECT_GT(refused, 20);
}

TEST(ForgedState, EachByteSetToAllOnesIsRefusedOrHarmless) {
  const SurveyRun run({.duration_s = 20.0});
  const std::vector<std::byte> good = saved_at(run, 0.9);
  FusionEngine engine(SurveyRun::config());
  ASSERT_EQ(engine.restore(good), "");
  // The front of the image: head, intake, navigator. In words each time.
  for (std::size_t at = 0; at + 8 < 4000 && at + 8 < good.size(); ++at) {
    std::vector<std::byte> bad = good;
    std::memset(bad.data() + at, 0xff, 8);
    const std::string why = engine.restore(bad);
    if (why.empty()) {
      ASSERT_EQ(engine.restore(good), "");
    } else {
      ASSERT_NE(why.find("expect"), std::string::npos) << why;
    }
  }
}

TEST(ForgedState, EachCutIsRefused) {
  const SurveyRun run({.duration_s = 20.0});
  const std::vector<std::byte> good = saved_at(run, 0.9);
  FusionEngine engine(SurveyRun::config());
  for (std::size_t size = 0; size < good.size(); size += 97)
    ASSERT_NE(engine.restore(std::span(good).first(size)), "") << size;
}

TEST(ForgedState, OfAnotherConfigurationIsRefused) {
  const SurveyRun run({.duration_s = 20.0});
  const std::vector<std::byte> good = saved_at(run, 0.9);
  EngineConfig config = SurveyRun::config();
  ASSERT_TRUE(named_state_groups("gps_ins15", config.groups));
  FusionEngine fewer(config);
  EXPECT_EQ(fewer.restore(good), "core.filter.states is 49, 46 to 46 was expected");
}

}  // namespace
}  // namespace fathom::estimation
