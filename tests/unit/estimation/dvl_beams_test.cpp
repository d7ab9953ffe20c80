#include "estimation/aiding/dvl_beams.hpp"

#include <gtest/gtest.h>

#include "estimation/aiding/registry.hpp"
#include "estimation/filter/gate.hpp"
#include "support/vehicles/analytic_vehicle.hpp"

namespace fathom::estimation {
namespace {

using Eigen::Vector3d;

class Beams : public ::testing::Test {
 protected:
  Beams() : sensor_(default_sensor(SourceKind::dvl, "dvl0")), filter_(index_.size()) {
    sensor_.use_beams = true;
    sensor_.proportional_sigma = 0.0;
    sensor_.robust = RobustKind::none;
    state_.nav.position = {0.6, 0.2, -10.0};
    state_.nav.q_NB = geo::from_rpy({0.1, -0.05, 2.0});
    state_.nav.v_N_m_s = geo::to_matrix(state_.nav.q_NB) * kVelocity_B;
    std::array<double, kMaxStates> sigma{};
    for (std::size_t i = 0; i < static_cast<std::size_t>(index_.size()); ++i)
      sigma[i] = i < 3 ? 10.0 : (i < 6 ? 0.5 : 0.01);
    filter_.reset(sigma);
  }

  static DvlSample sample(const Vector3d& velocity_D) {
    DvlSample s;
    s.velocity_D_m_s = geo::arr(velocity_D);
    s.beam_angle_rad = kAngle;
    const double sine = std::sin(kAngle);
    const double down = std::cos(kAngle) * velocity_D.z();
    s.beam_velocity_m_s = {-sine * velocity_D.y() + down, sine * velocity_D.y() + down,
                           sine * velocity_D.x() + down, -sine * velocity_D.x() + down};
    return s;
  }

  [[nodiscard]] Observation rows(const DvlSample& sample) const {
    const AidingState aiding(index_, state_, Vector3d::Zero(), kUnknown);
    Observation out;
    for (const AidingEntry& entry : aiding_registry())
      if (entry.source == SourceKind::dvl) (void)entry.observe({aiding, sensor_, 0.0}, sample, out);
    out.list_columns(index_.size());
    return out;
  }

  /// Sigma of the velocity along each axis of B after the sample.
  [[nodiscard]] Vector3d velocity_sigma_after(const DvlSample& sample) const {
    ErrorFilter filter = filter_;
    Observation observation = rows(sample);
    InnovationStatistics statistics;
    filter.statistics(observation, 1.0, statistics);
    std::array<double, kMaxStates> x{};
    EXPECT_TRUE(filter.update(observation, statistics, x));
    Eigen::Matrix3d p;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) p(i, j) = filter(3 + i, 3 + j);
    const Eigen::Matrix3d c = geo::to_matrix(state_.nav.q_NB);
    return (c.transpose() * p * c).diagonal().cwiseSqrt();
  }

  static constexpr double kAngle = 0.5235987755982988;
  const Vector3d kVelocity_B{2.0, 0.1, -0.05};
  StateIndex index_{StateGroups{}};
  SensorConfig sensor_;
  FilterState state_;
  ErrorFilter filter_;
};

TEST_F(Beams, FourSayWhatTheVectorSays) {
  const DvlSample four = sample(kVelocity_B + Vector3d(0.02, -0.01, 0.005));
  const Observation beams = rows(four);
  ASSERT_EQ(beams.rows, 4);
  EXPECT_TRUE(beams.each_alone);
  EXPECT_NEAR(beams.innovation[2] - beams.innovation[3], 2.0 * std::sin(kAngle) * -0.02, 1e-12);
  const Vector3d by_beams = velocity_sigma_after(four);
  sensor_.use_beams = false;
  ASSERT_EQ(rows(four).rows, 3);
  const Vector3d by_vector = velocity_sigma_after(four);
  EXPECT_NEAR(by_beams.x(), by_vector.x(), 1e-3 * by_vector.x());
  EXPECT_NEAR(by_beams.y(), by_vector.y(), 1e-3 * by_vector.y());
  // The vertical velocity is the mean of all four and so the best known of the three.
  EXPECT_LT(by_beams.z(), by_vector.z());
}

TEST_F(Beams, TwoAndOneStillAid) {
  DvlSample two = sample(kVelocity_B);
  two.velocity_D_m_s.fill(kUnknown);
  two.beam_velocity_m_s[1] = two.beam_velocity_m_s[3] = kUnknown;
  ASSERT_EQ(rows(two).rows, 2);
  const Vector3d sigma = velocity_sigma_after(two);
  EXPECT_LT(sigma.maxCoeff(), 0.45);
  two.beam_velocity_m_s[0] = kUnknown;
  const Observation one = rows(two);
  ASSERT_EQ(one.rows, 1);
  EXPECT_NEAR(one.innovation[0], 0.0, 1e-12);
  two.beam_velocity_m_s[2] = kUnknown;
  EXPECT_EQ(rows(two).rows, 0);
}

TEST_F(Beams, AFishInOneBeamCostsThatBeamOnly) {
  DvlSample fish = sample(kVelocity_B);
  fish.beam_velocity_m_s[1] += 3.0;
  Observation observation = rows(fish);
  InnovationStatistics statistics;
  const GateResult result = gate(filter_, sensor_, gate_limits(sensor_), observation, statistics);
  EXPECT_TRUE(result.pass);
  EXPECT_EQ(observation.rows, 3);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(observation.innovation[i], 0.0, 1e-12);
}

TEST_F(Beams, WhatNoBeamCanSayIsOutOfRange) {
  const AidingState aiding(index_, state_, Vector3d::Zero(), kUnknown);
  DvlSample wild = sample(kVelocity_B);
  wild.beam_velocity_m_s[0] = 80.0;
  EXPECT_EQ(DvlBeams::usable(aiding, wild), Usable::out_of_range);
  wild = sample(kVelocity_B);
  wild.beam_angle_rad = 0.0;
  EXPECT_EQ(DvlBeams::usable(aiding, wild), Usable::out_of_range);
  wild = sample(kVelocity_B);
  wild.mode = DvlMode::water;
  EXPECT_EQ(DvlBeams::usable(aiding, wild), Usable::not_estimated);
}

}  // namespace
}  // namespace fathom::estimation
