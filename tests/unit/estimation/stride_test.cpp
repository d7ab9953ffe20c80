// The covariance follows the state in strides (KF-1).
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "archive/reader.hpp"
#include "archive/writer.hpp"
#include "estimation/fields/navigator.hpp"
#include "estimation/fields/state_head.hpp"
#include "estimation/navigator/estimate.hpp"
#include "support/vehicles/survey_run.hpp"

namespace fathom::estimation {
namespace {

using Eigen::Vector3d;
using test::SurveyRun;

constexpr TimeNs kBegin_ns = 1'000 * kNsPerSecond;
constexpr DurationNs kStep_ns = 10'000'000;

EngineConfig config() {
  EngineConfig out = SurveyRun::config();
  out.imu.gyro_g_sensitivity_rad_s_per_m_s2 = 1e-5;
  out.imu.gyro_bias_settling_rad_s = 1e-5;
  return out;
}

/// One that turns and speeds up.
ImuStep step_at(TimeNs from_ns, double turn_rad_s) {
  ImuStep step;
  step.from_ns = from_ns;
  step.to_ns = from_ns + kStep_ns;
  Increments& in = step.increments;
  in.dt_s = 0.01;
  in.dtheta_rad = in.dtheta_before_rad = 0.01 * Vector3d(0.1, -0.05, turn_rad_s);
  in.dv_m_s = in.dv_before_m_s = 0.01 * Vector3d(1.5, 0.8, -9.9);
  return step;
}

Estimate navigating(const Setup& setup) {
  Estimate out(setup);
  out.now_ns = kBegin_ns;
  std::array<double, kMaxStates> sigma = setup.initial_sigma;
  for (std::size_t i = 0; i < 3; ++i) {
    sigma[i] = 3.0;
    sigma[3 + i] = 0.5;
    sigma[6 + i] = 0.03;
  }
  FilterState start;
  start.nav.position.latitude_rad = 0.6;
  out.begin(start, sigma);
  return out;
}

/// As if the covariance followed with each sample.
Setup by_steps(const EngineConfig& config) {
  Setup out(config);
  out.stride_s = 0.0;
  return out;
}

TEST(Stride, TenSecondsOfThemAreTenSecondsOfSteps) {
  const estimation::Setup strides(config());
  const estimation::Setup steps = by_steps(config());
  Estimate one = navigating(strides);
  Estimate other = navigating(steps);
  int behind = 0;
  for (int i = 0; i < 1000; ++i) {
    const ImuStep step = step_at(one.now_ns, 0.3 * std::sin(0.05 * i));
    one.advance(strides, step, step.to_ns);
    other.advance(steps, step, step.to_ns);
    behind += one.stride.is_empty() ? 0 : 1;
    ASSERT_TRUE(other.stride.is_empty());
  }
  EXPECT_EQ(behind, 800);  // four of five steps
  one.follow(strides);
  EXPECT_TRUE(one.stride.is_empty());
  EXPECT_EQ(one.now_ns, other.now_ns);
  for (int i = 0; i < one.filter.size(); ++i)
    for (int j = 0; j <= i; ++j) {
      const double scale = std::sqrt(other.filter(i, i) * other.filter(j, j));
      EXPECT_NEAR(one.filter(i, j), other.filter(i, j), 2e-3 * scale) << i << " " << j;
      EXPECT_EQ(one.filter(i, j), one.filter(j, i));
    }
}

TEST(Stride, EndsWhereTheVehicleHasTurnedFar) {
  const estimation::Setup setup(config());
  Estimate estimate = navigating(setup);
  for (int i = 0; i < 20; ++i) {
    const ImuStep step = step_at(estimate.now_ns, 12.0);
    estimate.advance(setup, step, step.to_ns);
    EXPECT_TRUE(estimate.stride.is_empty()) << "0.12 rad within one step";
  }
}

/// What a reader says to an image whose first number, the length of the stride, is this one.
std::string complaint_about(double dt_s) {
  Stride stride;
  stride.add(0.01, Eigen::Matrix3d::Identity(), Vector3d(0.1, 0.2, 0.3), Vector3d(0.0, 0.0, -9.8));
  std::vector<std::byte> image;
  archive::Writer writer(image, kStateVersion);
  writer("stride", stride);
  const double written = stride.dt_s();
  const auto* bytes = reinterpret_cast<const std::byte*>(&written);
  const auto at = std::search(image.begin(), image.end(), bytes, bytes + sizeof written);
  EXPECT_NE(at, image.end());
  std::copy_n(reinterpret_cast<const std::byte*>(&dt_s), sizeof dt_s, at);
  archive::Reader reader(image);
  reader.set_version(kStateVersion);
  Stride read;
  reader("stride", read);
  if (reader.good() && dt_s == 0.0) {
    // An empty one holds nothing: the next step is alone in it.
    read.add(0.01, Eigen::Matrix3d::Identity(), Vector3d::Zero(), Vector3d::Zero());
    EXPECT_EQ(read.rate_B_rad_s().norm(), 0.0);
  }
  return reader.good() ? "" : reader.complaint();
}

TEST(Stride, OneFromOutsideHasALengthThatItsIntegralsCanBeDividedBy) {
  EXPECT_EQ(complaint_about(0.01), "");
  EXPECT_EQ(complaint_about(0.0), "");
  EXPECT_NE(complaint_about(1e-300).find("dt_s"), std::string::npos) << complaint_about(1e-300);
  EXPECT_NE(complaint_about(-0.01).find("dt_s"), std::string::npos);
  EXPECT_NE(complaint_about(std::nan("")).find("dt_s"), std::string::npos);
}

}  // namespace
}  // namespace fathom::estimation
