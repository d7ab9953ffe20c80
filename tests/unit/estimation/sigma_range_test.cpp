#include "estimation/filter/sigma_range.hpp"

#include <limits>

#include <gtest/gtest.h>

#include "estimation/engine/order.hpp"
#include "support/orders.hpp"
#include "support/vehicles/survey_run.hpp"

namespace fathom::estimation {
namespace {

using test::SurveyRun;

Command set_position(double sigma_m) {
  Command out;
  out.kind = CommandKind::set_position;
  out.latitude_rad = 0.6;
  out.longitude_rad = 2.2;
  out.sigma_m = sigma_m;
  return out;
}

TEST(SigmaRange, AnOrderOutsideItIsRefusedInWords) {
  for (const double good : {kLeastSigma, 0.01, 1e5, kMostSigma})
    EXPECT_EQ(objection_to(set_position(good)), "");
  EXPECT_EQ(objection_to(set_position(1e-9)), "sigma_m is 1e-09, expected 1e-06 to 1e+06");
  for (const double bad : {0.0, -1.0, 2e6, kUnknown, std::numeric_limits<double>::infinity()})
    EXPECT_NE(objection_to(set_position(bad)), "") << bad;
  FusionEngine engine(SurveyRun::config());
  const SurveyRun run({.duration_s = 1.0});
  for (const test::Sample& sample : run.samples) test::feed(engine, sample);
  EXPECT_NE(test::order_now(engine, set_position(2e6)), "");
  EXPECT_EQ(test::order_now(engine, set_position(1e6)), "");
}

/// The verdict on the next fix with this sigma.
VerdictKind verdict_on(double sigma_m, bool use_sample_sigma) {
  EngineConfig config = SurveyRun::config();
  config.sensors[0].use_sample_sigma = use_sample_sigma;
  FusionEngine engine(config);
  const SurveyRun run({.duration_s = 20.0});
  VerdictKind last = VerdictKind::late;
  for (test::Sample sample : run.samples) {
    if (auto* gps = std::get_if<GpsSample>(&sample);
        gps != nullptr && gps->header.stamp_ns > SurveyRun::kEpochNs + 15 * kNsPerSecond)
      gps->position_sigma_N_m[1] = sigma_m;
    test::feed(engine, sample);
    for (Verdict verdict; engine.next_verdict(verdict);)
      if (verdict.source == SourceKind::gps) last = verdict.kind;
  }
  return last;
}

TEST(SigmaRange, ASampleOutsideItIsOutOfRange) {
  EXPECT_EQ(verdict_on(2.0, true), VerdictKind::used);
  EXPECT_EQ(verdict_on(kUnknown, true), VerdictKind::used);
  for (const double bad : {0.0, -1.0, 1e-9, 2e6, std::numeric_limits<double>::infinity()})
    EXPECT_EQ(verdict_on(bad, true), VerdictKind::out_of_range) << bad;
  EXPECT_EQ(verdict_on(0.0, false), VerdictKind::used) << "where the configuration leaves it aside";
}

TEST(SigmaRange, HoldsForEveryKind) {
  DvlSample dvl;
  HeadingSample heading;
  DepthSample depth;
  AirspeedSample air;
  UsblSample usbl;
  GpsSample gps;
  EXPECT_TRUE(sound_sigmas(dvl) && sound_sigmas(heading) && sound_sigmas(depth) && sound_sigmas(air) &&
              sound_sigmas(usbl) && sound_sigmas(gps));
  dvl.sigma_m_s = heading.sigma_rad = depth.sigma_m = air.sigma_m_s = usbl.sigma_rad = 1e7;
  gps.velocity_sigma_N_m_s[2] = 1e-7;
  EXPECT_FALSE(sound_sigmas(dvl) || sound_sigmas(heading) || sound_sigmas(depth) || sound_sigmas(air) ||
               sound_sigmas(usbl) || sound_sigmas(gps));
}

}  // namespace
}  // namespace fathom::estimation
