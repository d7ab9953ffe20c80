// A receiver that lies: standing aside, or moving away from the vehicle, for half a minute to five minutes.
#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "health/vehicle_health.hpp"
#include "support/sanitized.hpp"
#include "support/vehicles/survey_run.hpp"

namespace fathom::estimation {
namespace {

using test::SurveyRun;

enum class Aiding { log_and_compass, inertial };

struct Lie {
  double length_s = 30.0;
  double aside_m = 700.0;
  double away_m_s = 0.0;  ///< off the motion of the vehicle, which the told velocity shares
  double silent_s = 0.0;  ///< without any fix before
};

struct LyingOutcome {
  double pulled_m = 0.0;        ///< furthest from where the navigator would be without the lie, during it
  double drift_m = 0.0;         ///< largest error without the lie, at the same time
  double disputed_after_s = 0;  ///< from the first false fix until the first such verdict; 0: never
  int used = 0;                 ///< of the false fixes
  double back_after_s = 0.0;    ///< from the last false fix until the error stays below kBack_m
};

class Liar {
 public:
  static constexpr double kBegin_s = 60.0;
  static constexpr double kBack_m = 10.0;
  static constexpr double kSilence_s = 300.0;  ///< at most
  static constexpr double kAfter_s = 60.0;

  std::function<void(const Verdict&)> heard;  ///< where set, each verdict
  std::function<void(double)> at_each;        ///< and the time after each sample, s

  Liar(Aiding aiding, double longest_s) : aiding_(aiding), run_(options(longest_s)) {}

  [[nodiscard]] LyingOutcome navigate(const Lie& lie, double dispute_s = 600.0) const {
    EngineConfig told = config();
    told.sensors[0].dispute_s = dispute_s;
    FusionEngine deceived(told);
    FusionEngine left_alone(told);
    const double from = kBegin_s + lie.silent_s;
    const double to = from + lie.length_s;
    LyingOutcome out;
    std::size_t row = 0;
    for (const test::Sample& sample : run_.samples) {
      const double t = to_seconds(test::header(sample).stamp_ns - SurveyRun::kEpochNs);
      if (t > to + kAfter_s) break;
      if (aiding_ == Aiding::inertial && t > kBegin_s && !std::holds_alternative<ImuSample>(sample) &&
          !std::holds_alternative<GpsSample>(sample))
        continue;
      if (const auto* gps = std::get_if<GpsSample>(&sample)) {
        if (t > kBegin_s && t < from) continue;
        if (t < from || t >= to) {
          deceived.add(*gps);
          left_alone.add(*gps);
          continue;
        }
        GpsSample false_fix = *gps;
        const double aside = lie.aside_m + lie.away_m_s * (t - from);
        false_fix.longitude_rad += aside / (6.38e6 * std::cos(false_fix.latitude_rad));
        false_fix.velocity_N_m_s[1] += lie.away_m_s;
        deceived.add(false_fix);
        continue;
      }
      test::feed(deceived, sample);
      test::feed(left_alone, sample);
      note_verdicts(deceived, from, to, out);
      if (at_each) at_each(t);
      if (!std::holds_alternative<ImuSample>(sample)) continue;
      const Truth& truth = run_.truth[row++];
      if (t < from) continue;
      if (t < to) {
        out.pulled_m =
            std::max(out.pulled_m, between(place(deceived.nav_state()), place(left_alone.nav_state())));
        out.drift_m = std::max(out.drift_m, between(place(left_alone.nav_state()), place(truth)));
      } else {
        const double error = between(place(deceived.nav_state()), place(truth));
        if (error > kBack_m) out.back_after_s = t - to;
      }
    }
    return out;
  }

 private:
  static SurveyRun::Options options(double longest_s) {
    SurveyRun::Options o;
    o.duration_s = kBegin_s + kSilence_s + longest_s + kAfter_s + 1.0;
    o.dive_s = 1e9;
    o.wave_rad = 0.0;
    o.usbl = false;
    return o;
  }
  static EngineConfig config() {
    EngineConfig config = SurveyRun::config();
    config.sensors[0].sigma = {1.0, 1.0, 2.0};
    return config;
  }
  template <class T>
  static geo::Geodetic place(const T& at) {
    return {at.latitude_rad, at.longitude_rad, at.altitude_m};
  }
  static double between(const geo::Geodetic& a, const geo::Geodetic& b) {
    return geo::difference_N(a, b).head<2>().norm();
  }
  void note_verdicts(FusionEngine& engine, double from, double to, LyingOutcome& out) const {
    Verdict verdict;
    while (engine.next_verdict(verdict)) {
      if (heard) heard(verdict);
      const double t = to_seconds(verdict.header.stamp_ns - SurveyRun::kEpochNs);
      if (verdict.source != SourceKind::gps || t < from || t >= to || verdict.revision != 0) continue;
      if (verdict.kind == VerdictKind::used) ++out.used;
      if (verdict.kind == VerdictKind::disputed && out.disputed_after_s == 0.0)
        out.disputed_after_s = t - from;
    }
  }

  Aiding aiding_;
  SurveyRun run_;
};

constexpr double kDisputed_s = 25.0;  // reacquire_s of a receiver is 20, fixes come every 0.5 s
// A measurement that is refused still parts the covariance's strides (KF-1), and rounds the gains otherwise.
constexpr double kNothing_m = 1e-4;

void expect_refused(const LyingOutcome& got) {
  EXPECT_EQ(got.used, 0);
  EXPECT_LT(got.pulled_m, kNothing_m);
  EXPECT_GT(got.disputed_after_s, 0.0);
  EXPECT_LT(got.disputed_after_s, kDisputed_s);
  EXPECT_LT(got.back_after_s, 1.0);
}

/// A vehicle with a DVL and a compass knows where it is far better than such a fix says.
TEST(LyingGps, NoStandingOrMovingLieWinsAgainstALog) {
  FATHOM_MANY_RUNS();
  const Liar liar(Aiding::log_and_compass, 300.0);
  for (const double silent_s : {0.0, 300.0})
    for (const double length_s : {30.0, 120.0, 300.0}) {
      if (silent_s > 0.0 && length_s < 300.0) continue;
      for (const Lie& lie : {Lie{length_s, 700.0, 0.0, silent_s}, Lie{length_s, 0.0, 10.0, silent_s},
                             Lie{length_s, 100.0, 0.0, silent_s}, Lie{length_s, 0.0, 3.0, silent_s},
                             Lie{length_s, 0.0, 1.0, silent_s}}) {
        SCOPED_TRACE(::testing::Message() << lie.aside_m << " m aside, " << lie.away_m_s << " m/s, for "
                                          << length_s << " s after " << silent_s << " s of silence");
        expect_refused(liar.navigate(lie));
      }
    }
}

TEST(LyingGps, AnInertialNavigatorRefusesWhatItsUncertaintyCannotExplain) {
  const Liar liar(Aiding::inertial, 120.0);
  for (const double length_s : {30.0, 120.0})
    for (const Lie& lie : {Lie{length_s, 700.0, 0.0}, Lie{length_s, 0.0, 10.0}, Lie{length_s, 0.0, 3.0}}) {
      SCOPED_TRACE(::testing::Message()
                   << lie.aside_m << " m aside, " << lie.away_m_s << " m/s, for " << length_s << " s");
      expect_refused(liar.navigate(lie));
    }
}

/// After minutes of inertial navigation alone the lie is as likely as the estimate: it may be believed. It is
/// disputed before, and once the receiver tells the truth again the estimate follows.
TEST(LyingGps, AnEstimateThatWasLedAstrayFollowsTheTruth) {
  const Liar liar(Aiding::inertial, 300.0);
  for (const Lie& lie : {Lie{300.0, 700.0, 0.0}, Lie{300.0, 0.0, 10.0}, Lie{300.0, 0.0, 1.0},
                         Lie{300.0, 0.0, 10.0, 300.0}, Lie{300.0, 700.0, 0.0, 300.0}}) {
    SCOPED_TRACE(::testing::Message() << lie.aside_m << " m aside, " << lie.away_m_s << " m/s, after "
                                      << lie.silent_s << " s of silence");
    const LyingOutcome got = liar.navigate(lie);
    EXPECT_GT(got.used, 0) << "else this shows nothing";
    EXPECT_LT(got.back_after_s, 60.0);
    if (lie.silent_s == 0.0) {
      EXPECT_GT(got.disputed_after_s, 0.0);
    }
  }
}

/// A lie that leaves the motion more slowly than a drift could is followed at its own rate, no faster.
TEST(LyingGps, ASlowLieIsFollowedAndLeft) {
  const LyingOutcome got = Liar(Aiding::log_and_compass, 300.0).navigate({300.0, 0.0, 0.3});
  EXPECT_LT(got.pulled_m, 0.3 * 300.0 + 5.0);
  EXPECT_LT(got.back_after_s, 30.0);
}

TEST(LyingGps, TheMonitorAsksAPersonAndKeepsAsking) {
  Liar liar(Aiding::log_and_compass, 120.0);
  constexpr TimeNs kBoot = 1000 * kNsPerSecond;
  double now_s = 0.0;
  const auto now = [&] {
    return health::Instant{kBoot + from_seconds(now_s), SurveyRun::kEpochNs + from_seconds(now_s)};
  };
  health::VehicleHealth monitor(health::HealthConfig{}, now());
  double raised_s = 0.0;
  std::string text;
  liar.heard = [&](const Verdict& verdict) { monitor.add(verdict, now()); };
  liar.at_each = [&](double t) {
    now_s = t;
    monitor.evaluate(now());
    const Alarm* alarm = monitor.alarms().find("gps_disputed:gps0");
    if (alarm == nullptr || !alarm->active || raised_s != 0.0) return;
    raised_s = t;
    text = alarm->text;
    EXPECT_EQ(alarm->severity, Severity::critical);
  };
  const LyingOutcome got = liar.navigate({120.0, 700.0, 0.0});
  EXPECT_EQ(got.used, 0);
  EXPECT_GT(raised_s, Liar::kBegin_s + 20.0);
  EXPECT_LT(raised_s, Liar::kBegin_s + kDisputed_s);
  EXPECT_NE(text.find("gps0 has put the vehicle 70"), std::string::npos) << text;
  const Alarm* after = monitor.alarms().find("gps_disputed:gps0");
  ASSERT_NE(after, nullptr) << "it stays until somebody has seen it";
  EXPECT_FALSE(after->active) << "true fixes were used";
  EXPECT_FALSE(after->acknowledged);
}

TEST(LyingGps, HowLongADisputeLastsIsConfigured) {
  const Liar liar(Aiding::log_and_compass, 200.0);
  const Lie lie{200.0, 700.0, 0.0};
  EXPECT_GT(liar.navigate(lie, 100.0).used, 100);
  EXPECT_EQ(liar.navigate(lie, 300.0).used, 0);
  EXPECT_EQ(liar.navigate(lie, 0.0).used, 0);
}

}  // namespace
}  // namespace fathom::estimation
