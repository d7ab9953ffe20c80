// Noise by innovations (GATE-10).
#include "estimation/doubt/adaptive_noise.hpp"

#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "support/vehicles/spoilt_survey.hpp"

namespace fathom::test {
namespace {

using estimation::AdaptiveNoise;
using estimation::Observation;

constexpr double kSaid = 0.1;
constexpr double kMost = 30.0;

/// A velocity that drifts, a filter for it, and an instrument at 5 Hz that measures it.
class Filtered {
 public:
  explicit Filtered(std::uint64_t seed) : normal_(seed) {}

  /// The instrument is off by so much, this time.
  void measure(double off) {
    now_ns_ += kNsPerSecond / 5;
    error_ += normal_(kDrift);
    variance_ += kDrift * kDrift;
    Observation row;
    row.rows = 1;
    row.innovation[0] = error_ - off;
    row.sigma[0] = kSaid;
    row.h[0][0] = 1.0;
    row.list_columns(1);
    noise.widen(row);
    const double square = variance_ + row.sigma[0] * row.sigma[0];
    const bool used = row.innovation[0] * row.innovation[0] < 10.8 * square;
    std::array<double, estimation::kMaxStates> moved{};
    if (used) {
      moved[0] = variance_ / square * row.innovation[0];
      error_ -= moved[0];
      variance_ *= row.sigma[0] * row.sigma[0] / square;
    }
    noise.note({.now_ns = now_ns_,
                .used = used,
                .rows = row,
                .innovation_sigma = {std::sqrt(square)},
                .moved = moved,
                .most = kMost});
  }
  double draw(double sigma) { return normal_(sigma); }
  [[nodiscard]] double variance() const { return variance_; }

  AdaptiveNoise noise;

 private:
  static constexpr double kDrift = 0.01;

  Normal normal_;
  TimeNs now_ns_ = 1'000 * kNsPerSecond;
  double error_ = 0.0;
  double variance_ = 1.0;
};

TEST(AdaptiveNoise, LeavesAnInstrumentAloneThatIsAsSaid) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Filtered filtered(seed);
    for (int i = 0; i < 3'000; ++i) {
      filtered.measure(filtered.draw(kSaid));
      ASSERT_EQ(filtered.noise.factor(0), 1.0) << seed << " " << i;
      ASSERT_EQ(filtered.noise.white_share(0), 1.0) << seed << " " << i;
    }
  }
}

/// (GATE-13)
TEST(AdaptiveNoise, FindsTheShareOfTheNoiseThatIsThere) {
  for (const double share : {0.01, 0.1, 0.3}) {
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
      Filtered filtered(seed);
      for (int i = 0; i < 1'000; ++i) filtered.measure(0.7 * kSaid + filtered.draw(std::sqrt(share) * kSaid));
      EXPECT_NEAR(filtered.noise.white_share(0) / share, 1.0, 0.3) << share << " " << seed;
      EXPECT_EQ(filtered.noise.factor(0), 1.0) << "what is said is the least";
    }
  }
}

/// (GATE-13)
TEST(AdaptiveNoise, SeesWithinSecondsThatThereIsHardlyAny) {
  Filtered filtered(1);
  for (int i = 0; i < 40; ++i) filtered.measure(filtered.draw(0.1 * kSaid));
  EXPECT_LT(filtered.noise.white_share(0), 0.1);
}

TEST(AdaptiveNoise, FindsTheNoiseThatIsThereFromBelowTheGateAndFarBeyondIt) {
  for (const double factor : {2.0, 5.0, 20.0}) {
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
      Filtered filtered(seed);
      for (int i = 0; i < 1'000; ++i) filtered.measure(filtered.draw(factor * kSaid));
      EXPECT_NEAR(filtered.noise.factor(0) / factor, 1.0, 0.2) << factor << " " << seed;
    }
  }
}

TEST(AdaptiveNoise, FollowsANoiseThatComesAndGoes) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    Filtered filtered(seed);
    for (int i = 0; i < 1'000; ++i) filtered.measure(filtered.draw(kSaid));
    for (int i = 0; i < 250; ++i) filtered.measure(filtered.draw(10.0 * kSaid));
    EXPECT_GT(filtered.noise.factor(0), 5.0) << seed;
    EXPECT_LT(filtered.noise.factor(0), 14.0) << seed;
    for (int i = 0; i < 400; ++i) filtered.measure(filtered.draw(kSaid));
    EXPECT_EQ(filtered.noise.factor(0), 1.0) << seed;
  }
}

TEST(AdaptiveNoise, TakesNoErrorThatStaysForNoise) {
  Filtered filtered(1);
  for (int i = 0; i < 300; ++i) filtered.measure(filtered.draw(kSaid));
  // Refused from here on: with every other one the error would be two sigmas more.
  for (int i = 0; i < 500; ++i) {
    filtered.measure(3.0 + filtered.draw(kSaid));
    ASSERT_EQ(filtered.noise.factor(0), 1.0) << i;
  }
}

TEST(AdaptiveNoise, IsNotLedByOneWildMeasurementInTen) {
  Filtered filtered(1);
  for (int i = 0; i < 2'000; ++i) {
    filtered.measure(i % 10 == 3 ? filtered.draw(100.0 * kSaid) : filtered.draw(kSaid));
    ASSERT_LT(filtered.noise.factor(0), 1.5) << i;
  }
}

TEST(AdaptiveNoise, IsBounded) {
  Filtered filtered(1);
  for (int i = 0; i < 2'000; ++i) filtered.measure(filtered.draw(1'000.0 * kSaid));
  EXPECT_NEAR(filtered.noise.factor(0), kMost, 1e-9);
}

/// A survey whose DVL has that much more noise, whichever is configured.
SpoiltSurvey with_noisy_dvl(double more_m_s, double max_noise_factor) {
  const SurveyRun run({.duration_s = 140.0, .usbl = false});
  estimation::EngineConfig config = SurveyRun::config();
  for (estimation::SensorConfig& sensor : config.sensors) sensor.max_noise_factor = max_noise_factor;
  Normal normal(7);
  return survey(
      run, 60.0,
      [&](Sample& sample, double) {
        auto* dvl = std::get_if<DvlSample>(&sample);
        if (dvl == nullptr) return;
        for (double& v : dvl->velocity_D_m_s) v += normal(more_m_s);
      },
      config);
}

TEST(AdaptiveNoise, KeepsNavigationHonestBesideANoisyDvl) {
  for (const double more_m_s : {0.2, 0.4}) {
    const SpoiltSurvey as_said = with_noisy_dvl(more_m_s, 1.0);
    const SpoiltSurvey adapted = with_noisy_dvl(more_m_s, kMost);
    EXPECT_LT(adapted.worst_h_sigmas, 3.7) << more_m_s;
    EXPECT_GT(as_said.worst_h_sigmas, 5.0) << more_m_s << ": or this test shows nothing";
    EXPECT_NE(adapted.advice.find("The noise of dvl0 is "), std::string::npos) << adapted.advice;
    EXPECT_EQ(as_said.advice, "") << more_m_s;
  }
}

}  // namespace
}  // namespace fathom::test
