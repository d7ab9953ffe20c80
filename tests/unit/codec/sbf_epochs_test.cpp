// Blocks of Septentrio receivers that belong together.
#include <cmath>
#include <initializer_list>

#include <gtest/gtest.h>

#include "base/units.hpp"
#include "codec/satellite/sbf/sbf.hpp"
#include "sbf_bytes.hpp"

namespace fathom::codec::sbf_epochs_test {
namespace {

using namespace sbf_bytes;

struct Collector final : Sink {
  void on_sample(const Decoded& decoded) override { samples.push_back(decoded); }
  void on_rejected(const Rejected& /*rejected*/) override { ADD_FAILURE(); }
  std::vector<Decoded> samples;
};

/// A stream that is fed block by block.
class SbfStream : public ::testing::Test {
 protected:
  /// How many samples came of these bytes.
  std::size_t feed(const ByteVector& bytes) {
    const std::size_t before = sink_.samples.size();
    codec_->feed(bytes, sink_);
    return sink_.samples.size() - before;
  }
  std::size_t finish() {
    const std::size_t before = sink_.samples.size();
    codec_->finish(sink_);
    return sink_.samples.size() - before;
  }
  [[nodiscard]] GpsSample last_fix() const { return std::get<GpsSample>(sink_.samples.back().sample); }
  [[nodiscard]] HeadingSample last_heading() const {
    return std::get<HeadingSample>(sink_.samples.back().sample);
  }
  static ByteVector fix(std::uint32_t epoch) { return pvt({.tow_ms = epoch}); }
  static ByteVector position(std::uint32_t epoch) { return covariance(kPosition, {.tow_ms = epoch}); }
  static ByteVector velocity(std::uint32_t epoch) { return covariance(kVelocity, {.tow_ms = epoch}); }
  [[nodiscard]] bool has_both() const {
    const GpsSample s = last_fix();
    return s.position_sigma_N_m == std::array{0.5, 1.0, 1.5} &&
           s.velocity_sigma_N_m_s == std::array{0.5, 1.0, 1.5};
  }

  Collector sink_;
  std::unique_ptr<Codec> codec_ = make_sbf({});
};

TEST_F(SbfStream, CovariancesBeforeTheFixAreJoinedAtOnce) {
  for (std::uint32_t epoch = 1; epoch < 4; ++epoch) {
    EXPECT_EQ(feed(position(epoch) + velocity(epoch)), 0U);
    EXPECT_EQ(feed(fix(epoch)), 1U);
    EXPECT_TRUE(has_both());
  }
  EXPECT_EQ(finish(), 0U);
}

TEST_F(SbfStream, AFixWaitsForWhatFollowedTheLast) {
  EXPECT_EQ(feed(fix(1)), 1U) << "nobody knows yet that more follows";
  EXPECT_NEAR(last_fix().position_sigma_N_m[0], std::sqrt(2.0), 1e-12) << "HAccuracy";
  EXPECT_EQ(feed(position(1) + velocity(1)), 0U) << "delivered already";
  for (std::uint32_t epoch = 2; epoch < 5; ++epoch) {
    EXPECT_EQ(feed(fix(epoch)), 0U);
    EXPECT_EQ(feed(position(epoch)), 0U);
    EXPECT_EQ(feed(velocity(epoch)), 1U);
    EXPECT_TRUE(has_both());
    EXPECT_EQ(sink_.samples.back().length, 96U) << "of the fix";
  }
}

TEST_F(SbfStream, ItWaitsInVainOnlyOnce) {
  feed(fix(1) + position(1) + velocity(1));
  EXPECT_EQ(feed(fix(2) + position(2)), 0U);
  EXPECT_EQ(feed(fix(3)), 1U) << "the velocity's did not come; the third is not waited for";
  EXPECT_EQ(last_fix().position_sigma_N_m[1], 1.0);
  EXPECT_FALSE(known(last_fix().velocity_sigma_N_m_s[1]));
  EXPECT_EQ(feed(position(3)), 1U);
  EXPECT_EQ(feed(fix(4)), 0U);
  EXPECT_EQ(feed(fix(5)), 2U) << "now neither is expected";
  EXPECT_EQ(feed(fix(6)), 1U);
}

TEST_F(SbfStream, TheEndOfTheEpochEndsTheWaiting) {
  feed(fix(1) + position(1) + velocity(1) + end_of_pvt(1));
  EXPECT_EQ(feed(fix(2) + position(2)), 0U);
  EXPECT_EQ(feed(end_of_pvt(1)), 0U) << "of another epoch";
  EXPECT_EQ(feed(end_of_pvt(2)), 1U);
  EXPECT_EQ(feed(end_of_pvt(2)), 0U);
}

TEST_F(SbfStream, WhatComesOfALaterEpochEndsTheWaiting) {
  feed(fix(1) + position(1));
  EXPECT_EQ(feed(fix(2)), 0U);
  EXPECT_EQ(feed(attitude({.tow_ms = 1})), 1U) << "an earlier one does not";
  EXPECT_EQ(feed(attitude({.tow_ms = 3})), 2U);
  EXPECT_EQ(feed(position(3)), 0U);
  EXPECT_EQ(feed(fix(3)), 1U);
  EXPECT_EQ(last_fix().position_sigma_N_m[1], 1.0);
}

TEST_F(SbfStream, AtTheEndNothingIsLost) {
  feed(fix(1) + position(1));
  EXPECT_EQ(feed(fix(2)), 0U);
  EXPECT_EQ(finish(), 1U);
}

TEST_F(SbfStream, AFixIsDeliveredOnce) {
  EXPECT_EQ(feed(fix(1) + fix(1)), 1U);
  feed(position(1));
  EXPECT_EQ(feed(fix(2) + fix(2)), 0U);
  EXPECT_EQ(feed(position(2) + fix(2) + position(2)), 1U);
  EXPECT_EQ(finish(), 0U);
  EXPECT_EQ(feed(fix(2)), 1U) << "another stream";
}

TEST_F(SbfStream, WithoutTimeNothingIsJoined) {
  constexpr std::uint32_t kNever = 0xFFFF'FFFF;
  feed(fix(1) + position(1));
  EXPECT_EQ(feed(position(kNever) + fix(kNever)), 1U);
  EXPECT_NEAR(last_fix().position_sigma_N_m[0], std::sqrt(2.0), 1e-12);
  EXPECT_EQ(feed(fix(kNever)), 1U);
  EXPECT_EQ(feed(position(kNever)), 0U);
}

TEST_F(SbfStream, TheWeekIsPartOfTheInstant) {
  EXPECT_EQ(feed(fix(1)), 1U);
  EXPECT_EQ(feed(pvt({.tow_ms = 1, .week = kWeek + 1})), 1U);
  feed(position(1));
  EXPECT_EQ(feed(pvt({.tow_ms = 2, .week = kWeek + 1})), 1U);
  EXPECT_NEAR(last_fix().position_sigma_N_m[0], std::sqrt(2.0), 1e-12);
}

TEST_F(SbfStream, AVarianceWithoutValueLeavesTheAccuracy) {
  feed(covariance(kPosition, {.tow_ms = 1, .north = 0.25F, .east = kNone, .vertical = 0.0F}));
  feed(fix(1));
  EXPECT_EQ(last_fix().position_sigma_N_m[0], 0.5);
  EXPECT_NEAR(last_fix().position_sigma_N_m[1], std::sqrt(2.0), 1e-12);
  EXPECT_EQ(last_fix().position_sigma_N_m[2], 2.5);
  feed(covariance(kPosition, {.tow_ms = 2, .mode = 0, .error = 1}) + fix(2));
  EXPECT_EQ(last_fix().position_sigma_N_m[2], 2.5);
  feed(position(3) + pvt({.tow_ms = 3, .mode = 0}));
  EXPECT_FALSE(known(last_fix().position_sigma_N_m[0])) << "no fix, no sigma";
}

TEST_F(SbfStream, AHeadingWaitsForItsCovarianceAsAFix) {
  EXPECT_EQ(feed(attitude({.tow_ms = 1})), 1U);
  EXPECT_FALSE(known(last_heading().sigma_rad));
  EXPECT_EQ(feed(attitude_covariance(1)), 0U);
  EXPECT_EQ(feed(attitude({.tow_ms = 2})), 0U);
  EXPECT_EQ(feed(attitude_covariance(2)), 1U);
  EXPECT_DOUBLE_EQ(last_heading().sigma_rad, 0.25 * kRadPerDeg);
  EXPECT_EQ(feed(attitude({.tow_ms = 3}) + end_of_pvt(3)), 0U);
  EXPECT_EQ(feed(end_of_att(3)), 1U);
  EXPECT_EQ(feed(attitude({.tow_ms = 4})), 1U);
  feed(attitude_covariance(4));
  EXPECT_EQ(feed(attitude({.tow_ms = 5})), 0U);
  EXPECT_EQ(feed(fix(6)), 2U);
}

}  // namespace
}  // namespace fathom::codec::sbf_epochs_test
