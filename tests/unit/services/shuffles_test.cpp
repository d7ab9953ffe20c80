// States do not depend on the order in which aiding samples arrive. FATHOM_SHUFFLES: how many orders are
// tried.

#include <algorithm>
#include <cstdlib>
#include <random>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include "config/fusion/fusion_config.hpp"
#include "live/record/difference.hpp"
#include "support/vehicles/survey_run.hpp"

namespace fathom {
namespace {

using Archive = std::vector<std::byte>;

constexpr DurationNs kLate_ns = 2 * kNsPerSecond;      // that a sample arrives at most
constexpr DurationNs kSettled_ns = 3 * kNsPerSecond;   // at the end, in which all is there
constexpr DurationNs kShuffled_ns = 6 * kNsPerSecond;  // in front of it

config::FusionConfig configuration() {
  config::FusionConfig config;
  config.engine = test::SurveyRun::config();
  return config;
}

void give(estimation::FusionEngine& engine, const test::Sample& sample) {
  std::visit(
      [&]<class T>(const T& known) {
        if constexpr (std::is_same_v<T, ImuSample>)
          (void)engine.add(known);
        else
          engine.add(known, "bridge");
      },
      sample);
  for (Verdict verdict; engine.next_verdict(verdict);) continue;
}

TEST(Shuffles, OfArrivalGiveTheSameState) {
  test::SurveyRun::Options options;
  options.duration_s = 60.0;
  const std::vector<test::Sample> samples = test::SurveyRun(options).samples;
  const TimeNs end_ns = test::header(samples.back()).stamp_ns;
  const TimeNs begin_ns = end_ns - kSettled_ns - kShuffled_ns;
  estimation::FusionEngine first(config::engine_config(configuration()));
  std::size_t at = 0;
  for (; test::header(samples[at]).stamp_ns < begin_ns; ++at) give(first, samples[at]);
  Archive state;
  ASSERT_TRUE(first.save(state));
  for (std::size_t i = at; i < samples.size(); ++i) give(first, samples[i]);
  const NavState expected = first.nav_state();
  ASSERT_EQ(expected.alignment, AlignmentPhase::aligned) << "before, aiding changes nothing";

  // What the comparison would find: one sample of depth less.
  estimation::FusionEngine without(config::engine_config(configuration()));
  ASSERT_EQ(without.restore(state), "");
  bool left_out = false;
  for (std::size_t i = at; i < samples.size(); ++i) {
    if (!left_out && std::holds_alternative<DepthSample>(samples[i]))
      left_out = true;
    else
      give(without, samples[i]);
  }
  ASSERT_NE(cli::first_difference(expected, without.nav_state()), "");

  const char* wanted = std::getenv("FATHOM_SHUFFLES");
  const int shuffles = wanted == nullptr ? 40 : std::atoi(wanted);
  ASSERT_GT(shuffles, 0);
  std::mt19937_64 random(7);
  std::size_t moved = 0;
  int worked_back = 0;
  for (int run = 0; run < shuffles; ++run) {
    std::vector<std::pair<TimeNs, const test::Sample*>> arrivals;
    for (std::size_t i = at; i < samples.size(); ++i) {
      const TimeNs stamp_ns = test::header(samples[i]).stamp_ns;
      const bool late = !std::holds_alternative<ImuSample>(samples[i]) && stamp_ns < end_ns - kSettled_ns;
      const auto delay_ns =
          late ? static_cast<DurationNs>(random() % static_cast<std::uint64_t>(kLate_ns)) : 0;
      moved += late ? 1 : 0;
      arrivals.emplace_back(stamp_ns + delay_ns, &samples[i]);
    }
    std::stable_sort(arrivals.begin(), arrivals.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    estimation::FusionEngine engine(config::engine_config(configuration()));
    ASSERT_EQ(engine.restore(state), "");
    bool differed = false;
    for (const auto& [when_ns, sample] : arrivals) {
      give(engine, *sample);
      differed = differed || when_ns != test::header(*sample).stamp_ns;
    }
    worked_back += differed ? 1 : 0;
    ASSERT_EQ(cli::first_difference(expected, engine.nav_state()), "") << "shuffle " << run;
  }
  EXPECT_EQ(worked_back, shuffles);
  EXPECT_GT(moved, 20U * static_cast<std::size_t>(shuffles));
}

}  // namespace
}  // namespace fathom
