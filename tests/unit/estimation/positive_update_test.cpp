// The covariance stays one however much better a measurement knows than the filter.

#include <cmath>

#include <gtest/gtest.h>

#include "archive/covariance.hpp"
#include "estimation/filter/error_filter.hpp"
#include "support/orders.hpp"
#include "support/vehicles/survey_run.hpp"

namespace fathom::estimation {
namespace {

using test::SurveyRun;

std::array<double, kMaxStates> ones() {
  std::array<double, kMaxStates> out{};
  out.fill(1.0);
  return out;
}

/// Takes `h` x with this sigma in.
void update(ErrorFilter& filter, std::initializer_list<std::pair<int, double>> h, double sigma) {
  Observation observation;
  observation.rows = 1;
  observation.sigma[0] = sigma;
  for (const auto& [state, weight] : h) observation.h[0][static_cast<std::size_t>(state)] = weight;
  observation.list_columns(filter.size());
  InnovationStatistics statistics;
  filter.statistics(observation, 1.0, statistics);
  std::array<double, kMaxStates> x{};
  ASSERT_TRUE(filter.update(observation, statistics, x));
}

void expect_covariance(const ErrorFilter& filter) {
  Eigen::MatrixXd p(filter.size(), filter.size());
  for (int i = 0; i < filter.size(); ++i)
    for (int j = 0; j < filter.size(); ++j) p(i, j) = filter(i, j);
  EXPECT_TRUE(archive::is_covariance(p.data(), static_cast<std::size_t>(filter.size()),
                                     static_cast<std::size_t>(filter.size())));
}

TEST(PositiveUpdate, OfOneState) {
  ErrorFilter filter(15);
  auto sigma = ones();
  sigma[0] = 1e6;
  filter.reset(sigma);
  for (int fixes = 1; fixes <= 3; ++fixes) {
    update(filter, {{0, 1.0}}, 0.01);
    EXPECT_NEAR(std::sqrt(filter(0, 0)), 0.01 / std::sqrt(fixes), 1e-6) << fixes;
  }
  expect_covariance(filter);
}

TEST(PositiveUpdate, OfASumWhoseOtherPartIsKnownBetter) {
  // As a position and the slow error of GPS: the sum becomes known to 6 mm, neither part does.
  ErrorFilter filter(15);
  auto sigma = ones();
  sigma[0] = 1e6;
  sigma[9] = 1.5;
  filter.reset(sigma);
  for (int fixes = 1; fixes <= 3; ++fixes) {
    update(filter, {{0, 1.0}, {9, 1.0}}, 0.01);
    const double sum = filter(0, 0) + filter(9, 9) + 2.0 * filter(0, 9);
    EXPECT_NEAR(std::sqrt(sum), 0.01 / std::sqrt(fixes), 1e-6) << fixes;
    EXPECT_NEAR(std::sqrt(filter(0, 0)), 1.5, 1e-3);
  }
  expect_covariance(filter);
}

TEST(PositiveUpdate, OfWhatIsTiedToOthers) {
  // A velocity that the position has been tied to for a while.
  ErrorFilter filter(15);
  auto sigma = ones();
  sigma[0] = 1e6;
  sigma[3] = 1e3;
  filter.reset(sigma);
  filter.set(0, 3, 0.999 * 1e9);
  filter.set(0, 4, 0.5e6);
  filter.set(3, 4, 0.4995e3);
  expect_covariance(filter);
  for (const double noise : {1e-2, 1e-4, 1e-6}) {
    update(filter, {{0, 1.0}, {3, -0.2}, {9, 1.0}}, noise);
    expect_covariance(filter);
    update(filter, {{3, 1.0}}, noise);
    expect_covariance(filter);
    EXPECT_GT(filter(0, 0), 0.0);
    EXPECT_LE(filter(3, 3), 1.001 * noise * noise);
    EXPECT_GE(filter(3, 3), 0.4 * noise * noise);
  }
}

TEST(PositiveUpdate, OfAllRowsAtOnce) {
  ErrorFilter filter(15);
  auto sigma = ones();
  for (std::size_t i = 0; i < 3; ++i) sigma[i] = 1e6;
  filter.reset(sigma);
  for (int fixes = 1; fixes <= 3; ++fixes) {
    Observation observation;
    observation.rows = 3;
    for (std::size_t i = 0; i < 3; ++i) {
      observation.sigma[i] = 0.01;
      observation.h[i][i] = 1.0;
      observation.h[i][6 + (i + 1) % 3] = 0.4;
    }
    observation.list_columns(filter.size());
    InnovationStatistics statistics;
    filter.statistics(observation, 1.0, statistics);
    std::array<double, kMaxStates> x{};
    ASSERT_TRUE(filter.update(observation, statistics, x));
    for (int i = 0; i < 3; ++i) {
      const int other = 6 + (i + 1) % 3;
      const double sum = filter(i, i) + 0.8 * filter(i, other) + 0.16 * filter(other, other);
      EXPECT_NEAR(std::sqrt(sum), 0.01 / std::sqrt(fixes), 1e-6);
    }
    expect_covariance(filter);
  }
}

TEST(PositiveUpdate, OfAnEngineToldAMillionMetres) {
  const SurveyRun run({.duration_s = 45.0, .gps_delay_s = 0.0});
  EngineConfig config = SurveyRun::config();
  config.sensors[0].sigma = {0.01, 0.01, 0.01};
  config.sensors[0].reacquire_step_m = 1e6;
  FusionEngine engine(config);
  Command order;
  order.kind = CommandKind::set_position;
  order.sigma_m = 1e6;
  int fixes = -1;
  for (const test::Sample& sample : run.samples) {
    const bool gps = std::holds_alternative<GpsSample>(sample);
    if (fixes >= 0 && gps) ++fixes;
    if (gps && fixes < 0 && test::header(sample).stamp_ns > SurveyRun::kEpochNs + 40 * kNsPerSecond) {
      order.latitude_rad = engine.nav_state().latitude_rad;
      order.longitude_rad = engine.nav_state().longitude_rad;
      ASSERT_EQ(test::order_now(engine, order), "");
      fixes = 0;
      continue;
    }
    test::feed(engine, sample);
    if (fixes < 1) continue;
    const double sigma_m = std::sqrt(engine.nav_state().position_covariance_N_m2[0]);
    ASSERT_GT(sigma_m, 1e-3) << fixes;
  }
  ASSERT_GT(fixes, 3);
  EXPECT_LT(std::sqrt(engine.nav_state().position_covariance_N_m2[0]), 0.5);
}

}  // namespace
}  // namespace fathom::estimation
