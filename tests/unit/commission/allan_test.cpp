#include "commission/fit/allan.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "sim/random.hpp"

namespace fathom::test {
namespace {

TEST(Allan, FindsTheDensityOfWhiteNoiseWithinItsOwnSigma) {
  int outside = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    sim::Random random(seed, "allan");
    const double density = random.uniform(0.1, 5.0);
    std::vector<double> samples(20000);
    for (double& sample : samples) sample = 3.0 + random.normal(density / std::sqrt(0.01));
    const auto figures = commission::noise_figures(commission::allan_deviation(samples, 0.01));
    EXPECT_NEAR(figures.density / density, 1.0, 0.05);
    if (std::abs(figures.density - density) > 3.0 * figures.density_sigma) ++outside;
    EXPECT_FALSE(known(figures.instability)) << "white noise has no floor";
  }
  EXPECT_LE(outside, 1);
}

TEST(Allan, SeesTheFloorOfABiasThatWanders) {
  sim::Random random(4, "allan");
  sim::GaussMarkov slow(0.05, 20.0, random);
  std::vector<double> samples(200000);
  for (double& sample : samples) sample = slow.advance(0.01, random) + random.normal(0.05);
  const auto figures = commission::noise_figures(commission::allan_deviation(samples, 0.01));
  ASSERT_TRUE(known(figures.instability));
  EXPECT_GT(figures.instability, 0.005);
  EXPECT_LT(figures.instability, 0.06);
}

TEST(Allan, SaysNothingOfTooFewSamples) {
  EXPECT_FALSE(known(commission::noise_figures(commission::allan_deviation({}, 0.01)).density));
  EXPECT_FALSE(known(commission::noise_figures(commission::allan_deviation({1.0, 2.0, 3.0}, 0.01)).density));
}

}  // namespace
}  // namespace fathom::test
