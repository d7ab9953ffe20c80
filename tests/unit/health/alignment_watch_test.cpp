// What the monitor says of the alignment and of what its conditions tell.
#include "health/navigation/alignment_watch.hpp"

#include <cstdio>

#include <gtest/gtest.h>

#include "timeline.hpp"

namespace fathom::health {
namespace {

/// With one condition.
AlignmentStatus alignment(AlignmentPhase phase, const char* name, double value, double limit,
                          bool met = false) {
  AlignmentStatus status;
  status.phase = phase;
  status.condition_count = 1;
  status.conditions[0] = {.name = name, .value = value, .limit = limit, .met = met};
  return status;
}

TEST(AlignmentWatch, TooLongTimedOutLostAndRegained) {
  AlignmentWatch watch{AlignmentWatchConfig{}};
  AlarmBook book;
  AlignmentStatus status = alignment(AlignmentPhase::waiting, "pitch_rad", 0.4, 0.1);
  for (double t = 0.0; t < 180.0; t += 1.0) watch.add(status, at(t)), watch.report(book, at(t));
  EXPECT_EQ(book.all().size(), 0u);
  for (double t = 180.0; t < 190.0; t += 1.0) watch.add(status, at(t)), watch.report(book, at(t));
  ASSERT_TRUE(alarmed(book, "not_aligned"));
  EXPECT_NE(book.find("not_aligned")->text.find("pitch_rad: 0.4"), std::string::npos)
      << book.find("not_aligned")->text;
  status.phase = AlignmentPhase::aligned;
  for (double t = 190.0; t < 195.0; t += 1.0) watch.add(status, at(t)), watch.report(book, at(t));
  EXPECT_FALSE(alarmed(book, "not_aligned"));
  status.phase = AlignmentPhase::lost;
  watch.add(status, at(195.0));
  watch.report(book, at(195.0));
  ASSERT_TRUE(alarmed(book, "alignment_lost"));
  EXPECT_EQ(book.find("alignment_lost")->severity, Severity::critical);
  status.phase = AlignmentPhase::aligned;
  watch.add(status, at(196.0));
  watch.report(book, at(196.0));
  watch.report(book, at(197.9));
  EXPECT_TRUE(alarmed(book, "alignment_lost"));
  watch.report(book, at(198.1));
  EXPECT_FALSE(alarmed(book, "alignment_lost"));
}

TEST(AlignmentWatch, WhatCannotBeRightIsAnAlarmWithTheAdviceUntilItIsPutRight) {
  AlignmentWatch watch{AlignmentWatchConfig{}};
  AlarmBook book;
  AlignmentStatus status;
  status.phase = AlignmentPhase::fine;
  status.condition_count = 2;
  status.conditions[0].name = "yaw_sigma_rad";
  status.conditions[0].met = true;
  status.conditions[1].name = "implausible_dvl_unit";
  status.conditions[1].value = 0.001;
  std::snprintf(status.advice.data(), status.advice.size(), "%s", "DVL velocity is not in m/s.");
  watch.add(status, at(1.0));
  watch.report(book, at(1.0));
  ASSERT_TRUE(alarmed(book, "implausible"));
  EXPECT_EQ(book.find("implausible")->severity, Severity::critical);
  EXPECT_EQ(book.find("implausible")->text, "DVL velocity is not in m/s.");
  EXPECT_EQ(book.find("implausible")->value, 0.001);
  status.condition_count = 1;
  watch.add(status, at(2.0));
  for (double t = 2.0; t < 60.0; t += 1.0) watch.report(book, at(t));
  EXPECT_FALSE(alarmed(book, "implausible"));
}

TEST(AlignmentWatch, WhatScattersMoreThanIsSaidIsANoticeUntilItDoesNot) {
  AlignmentWatch watch{AlignmentWatchConfig{}};
  AlarmBook book;
  AlignmentStatus status = alignment(AlignmentPhase::aligned, "noise_of_dvl0", 6.5, 30.0, true);
  watch.add(status, at(1.0));
  watch.report(book, at(1.0));
  ASSERT_TRUE(alarmed(book, "noisy:dvl0"));
  EXPECT_EQ(book.find("noisy:dvl0")->severity, Severity::notice);
  EXPECT_EQ(book.find("noisy:dvl0")->text,
            "dvl0 scatters 6.5 times as much as its sigmas say. Navigation counts with that.");
  EXPECT_EQ(book.find("noisy:dvl0")->value, 6.5);
  status.condition_count = 0;
  watch.add(status, at(2.0));
  for (double t = 2.0; t < 60.0; t += 1.0) watch.report(book, at(t));
  EXPECT_FALSE(alarmed(book, "noisy:dvl0"));
}

TEST(AlignmentWatch, NoiseOfTheInertialUnitIsToldByTheMotion) {
  AlignmentWatch watch{AlignmentWatchConfig{}};
  AlarmBook book;
  watch.add(alignment(AlignmentPhase::aligned, "noise_of_gyros", 3.6, 30.0, true), at(1.0));
  watch.report(book, at(1.0));
  ASSERT_TRUE(alarmed(book, "noisy:gyros"));
  EXPECT_EQ(book.find("noisy:gyros")->text,
            "The motion strays as if the noise of the gyros were 3.6 times what is configured. Navigation "
            "counts with that.");
}

TEST(AlignmentWatch, ABiasBeyondItsSigmaIsANoticeOfItsAxis) {
  AlignmentWatch watch{AlignmentWatchConfig{}};
  AlarmBook book;
  AlignmentStatus status = alignment(AlignmentPhase::aligned, "bias_of_gyro_x", 1.0e-4, 4.85e-6, true);
  status.condition_count = 3;
  status.conditions[1] = {
      .name = "bias_of_accelerometer_z", .value = -0.0980665, .limit = 9.80665e-3, .met = true};
  status.conditions[2] = {.name = "bias_of_anything", .value = 1.0, .limit = 0.1, .met = true};
  watch.add(status, at(1.0));
  watch.report(book, at(1.0));
  ASSERT_TRUE(alarmed(book, "biased:gyro_x"));
  EXPECT_EQ(book.find("biased:gyro_x")->severity, Severity::notice);
  EXPECT_EQ(book.find("biased:gyro_x")->text,
            "The bias of gyro x is 20.6 deg/h, and a sigma of 1 deg/h is configured. Navigation counts with "
            "the bias.");
  ASSERT_TRUE(alarmed(book, "biased:accelerometer_z"));
  EXPECT_EQ(
      book.find("biased:accelerometer_z")->text,
      "The bias of accelerometer z is -10.0 mg, and a sigma of 1 mg is configured. Navigation counts with "
      "the bias.");
  EXPECT_FALSE(alarmed(book, "biased:anything"));
  status.condition_count = 0;
  watch.add(status, at(2.0));
  for (double t = 2.0; t < 60.0; t += 1.0) watch.report(book, at(t));
  EXPECT_FALSE(alarmed(book, "biased:gyro_x"));
}

TEST(AlignmentWatch, WhatIsWaitedForIsNamedWithWhatHelps) {
  AlignmentWatch watch{AlignmentWatchConfig{}};
  AlarmBook book;
  AlignmentStatus status = alignment(AlignmentPhase::waiting, "yaw_sigma_rad", 0.2, 0.1);
  watch.add(status, at(0.0));
  status.phase = AlignmentPhase::timed_out;
  watch.add(status, at(1.0));
  watch.report(book, at(1.0));
  ASSERT_TRUE(alarmed(book, "not_aligned"));
  EXPECT_NE(book.find("not_aligned")->text.find("turn by 90 degrees"), std::string::npos)
      << book.find("not_aligned")->text;
}

TEST(AlignmentWatch, ALateStatusIsNoLossWhileNavigationStatesCome) {
  AlignmentWatch watch{AlignmentWatchConfig{}};
  AlarmBook book;
  watch.add(nav(1.0), at(1.0));
  AlignmentStatus old;
  old.phase = AlignmentPhase::fine;
  watch.add(old, at(1.01));
  watch.report(book, at(1.01));
  EXPECT_EQ(watch.phase(), AlignmentPhase::aligned);
  EXPECT_EQ(book.find("alignment_lost"), nullptr);
}

}  // namespace
}  // namespace fathom::health
