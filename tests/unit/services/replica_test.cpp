// When one of several fusion services speaks, and when it knows that another one knows better.

#include "fusion/replica/replica.hpp"

#include <gtest/gtest.h>

namespace fathom::fusion {
namespace {

constexpr DurationNs kPeriod = 10 * kNsPerMillisecond;
constexpr TimeNs kStamp0 = 1'700'000'000 * kNsPerSecond;

Replica::Options options() {
  Replica::Options out;
  out.listen_ns = 300 * kNsPerMillisecond;
  out.silence_ns = 200 * kNsPerMillisecond;
  out.quarrel_ns = 2 * kNsPerSecond;
  out.gap_ns = 100 * kNsPerMillisecond;
  out.late_ns = 250 * kNsPerMillisecond;
  out.pause_ns = 30 * kNsPerMillisecond;
  out.hold_ns = 2 * kNsPerSecond;
  out.hold_silence_ns = 100 * kNsPerMillisecond;
  out.strength = 10;
  return out;
}

/// A replica, what its engine makes of the samples, and the leader it hears.
struct Scene {
  TimeNs now_ns = 1000 * kNsPerSecond;
  int step = 0;
  Replica replica{options(), now_ns};

  NavState state(const char* instance, double north_m) const {
    NavState out;
    out.header.sensor = instance;
    out.header.stamp_ns = kStamp0 + step * kPeriod;
    out.latitude_rad = 0.6 + north_m / 6.371e6;
    out.longitude_rad = 2.2;
    out.altitude_m = -5.0;
    out.velocity_N_m_s = {1.0, 0.0, 0.0};
    out.q_NB = {1.0, 0.0, 0.0, 0.0};
    return out;
  }
  void advance() {
    now_ns += kPeriod;
    ++step;
  }
  /// Inertial samples with nobody else about. How many states were published.
  int alone(int steps) {
    int spoke = 0;
    for (int i = 0; i < steps; ++i) {
      advance();
      if (!replica.own(state("b", 0.0), now_ns)) continue;
      ++spoke;
      replica.heard(state("b", 0.0), true, now_ns);
    }
    return spoke;
  }
  /// With a leader whose state is `apart_m` to the north of its own.
  int led(int steps, double apart_m, bool leader_first = false) {
    int spoke = 0;
    for (int i = 0; i < steps; ++i) {
      advance();
      if (leader_first) replica.heard(state("a", apart_m), false, now_ns);
      spoke += replica.own(state("b", 0.0), now_ns) ? 1 : 0;
      if (!leader_first) replica.heard(state("a", apart_m), false, now_ns);
    }
    return spoke;
  }
  ReplicaStatus account(std::uint64_t missed, ReplicaPhase phase = ReplicaPhase::in_step) const {
    ReplicaStatus out;
    out.header.sensor = "a";
    out.phase = phase;
    out.missed = missed;
    return out;
  }
};

TEST(Replica, LeadsWhenNobodyElseIsHeard) {
  Scene scene;
  EXPECT_EQ(scene.alone(29), 0) << "it listens first";
  EXPECT_EQ(scene.replica.phase(), ReplicaPhase::listening);
  EXPECT_EQ(scene.alone(10), 10);
  EXPECT_TRUE(scene.replica.leads());
  EXPECT_EQ(scene.replica.times_unprepared(), 0U);
}

TEST(Replica, HoldsItsTongueWhileTheLeaderKnowsMore) {
  Scene scene;
  EXPECT_EQ(scene.led(500, 3.0), 0);
  EXPECT_EQ(scene.replica.phase(), ReplicaPhase::behind);
  EXPECT_TRUE(scene.replica.wants_state());
  EXPECT_EQ(scene.replica.leader(), Name("a"));

  scene.replica.caught_up(0);
  EXPECT_EQ(scene.led(Replica::kAlikeNeeded - 1, 0.0), 0) << "what it took is tried first";
  EXPECT_GT(scene.led(5, 0.0), 0);
  EXPECT_EQ(scene.replica.phase(), ReplicaPhase::in_step);
  EXPECT_FALSE(scene.replica.leads()) << "the other one is heard";
}

TEST(Replica, NeedsNoStateWhenItHasTheSame) {
  Scene scene;
  scene.led(Replica::kAlikeNeeded + 1, 0.0, true);
  EXPECT_EQ(scene.replica.phase(), ReplicaPhase::in_step);
  EXPECT_EQ(scene.replica.times_caught_up(), 0U);
}

TEST(Replica, TakesNoStateForTheSameBeforeThereIsAPosition) {
  Scene scene;
  NavState none;
  none.header.sensor = "a";
  for (int i = 0; i < 100; ++i) {
    scene.advance();
    none.header.stamp_ns = kStamp0 + scene.step * kPeriod;
    (void)scene.replica.own(none, scene.now_ns);
    scene.replica.heard(none, false, scene.now_ns);
  }
  EXPECT_EQ(scene.replica.phase(), ReplicaPhase::behind);
  scene.replica.caught_up(0);
  for (int i = 0; i < 20; ++i) {
    scene.advance();
    none.header.stamp_ns = kStamp0 + scene.step * kPeriod;
    (void)scene.replica.own(none, scene.now_ns);
    scene.replica.heard(none, false, scene.now_ns);
  }
  EXPECT_EQ(scene.replica.phase(), ReplicaPhase::in_step) << "now it is known to be the same";
}

TEST(Replica, DoesNotRepeatWhatTheLeaderHasSaid) {
  Scene scene;
  scene.led(20, 0.0);
  ASSERT_EQ(scene.replica.phase(), ReplicaPhase::in_step);
  EXPECT_EQ(scene.led(10, 0.0, true), 0);
  EXPECT_EQ(scene.led(10, 0.0), 10) << "it may be first, and the stronger one";
}

TEST(Replica, TakesOverFromALeaderThatFallsSilent) {
  Scene scene;
  scene.led(20, 0.0);
  ASSERT_EQ(scene.replica.phase(), ReplicaPhase::in_step);
  EXPECT_EQ(scene.alone(5), 5) << "it never stopped speaking: DDS hears it from now on";
  EXPECT_TRUE(scene.replica.leads());
  EXPECT_EQ(scene.replica.times_unprepared(), 0U);
}

TEST(Replica, SpeaksUnpreparedWhenThereIsNobodyElse) {
  Scene scene;
  scene.led(100, 5.0);
  EXPECT_EQ(scene.alone(20), 0) << "the leader may be only late";
  EXPECT_GT(scene.alone(5), 0);
  EXPECT_EQ(scene.replica.times_unprepared(), 1U);
  scene.led(1, 5.0);
  EXPECT_EQ(scene.replica.phase(), ReplicaPhase::behind) << "the leader was only late: it knows better";
}

TEST(Replica, LateMeasurementsMakeNoQuarrel) {
  Scene scene;
  scene.led(20, 0.0);
  for (int i = 0; i < 10; ++i) {
    scene.led(100, 0.5);
    ASSERT_EQ(scene.replica.phase(), ReplicaPhase::in_step)
        << "a second of difference is what a late measurement makes";
    scene.led(10, 0.0);
  }
  EXPECT_EQ(scene.replica.phase(), ReplicaPhase::in_step);
  scene.led(210, 0.5);
  EXPECT_EQ(scene.replica.phase(), ReplicaPhase::behind) << "this is none";
}

TEST(Replica, AStateThatItNeverHadCountsAsADifference) {
  Scene scene;
  scene.led(20, 0.0);
  for (int i = 0; i < 250; ++i) {
    scene.advance();
    scene.replica.heard(scene.state("a", 0.0), false, scene.now_ns);
    scene.advance();  // each second inertial sample only
    (void)scene.replica.own(scene.state("b", 0.0), scene.now_ns);
  }
  EXPECT_EQ(scene.replica.phase(), ReplicaPhase::behind);
}

TEST(Replica, ListensAfterASilenceInWhichAnotherOneMayHaveGoneOn) {
  Scene scene;
  scene.alone(50);
  scene.replica.others(1, scene.now_ns);
  scene.alone(5);
  scene.now_ns += 5 * kNsPerSecond;  // cut off
  scene.step += 500;
  scene.replica.missed(500, scene.now_ns);
  EXPECT_EQ(scene.alone(10), 0);
  EXPECT_EQ(scene.replica.phase(), ReplicaPhase::listening);
  scene.led(2, 1.0);
  EXPECT_EQ(scene.replica.phase(), ReplicaPhase::behind);
}

TEST(Replica, ListensAlsoWhenTheOtherOneWasLostInTheSilence) {
  Scene scene;
  scene.alone(50);
  scene.replica.others(1, scene.now_ns);
  scene.alone(5);
  scene.now_ns += 5 * kNsPerSecond;
  scene.replica.others(0, scene.now_ns);
  scene.now_ns += 5 * kNsPerSecond;
  scene.step += 1000;
  scene.replica.missed(1000, scene.now_ns);
  EXPECT_EQ(scene.alone(10), 0);
  EXPECT_EQ(scene.replica.phase(), ReplicaPhase::listening);
}

TEST(Replica, ASilenceOfTheInertialUnitIsNoReasonToListenWhereThereIsOnlyOneFusion) {
  Scene scene;
  scene.alone(50);
  scene.now_ns += 5 * kNsPerSecond;
  scene.step += 500;
  scene.replica.missed(500, scene.now_ns);
  EXPECT_EQ(scene.alone(10), 10);
}

TEST(Replica, ASilenceInWhichNothingWasLostIsNoReasonEither) {
  Scene scene;
  scene.alone(50);
  scene.replica.others(1, scene.now_ns);
  scene.now_ns += 5 * kNsPerSecond;  // the inertial unit was: its samples were numbered on
  scene.step += 500;
  EXPECT_EQ(scene.alone(10), 10);
}

TEST(Replica, SaysNothingOfThePast) {
  Scene scene;
  scene.alone(300);
  scene.replica.others(1, scene.now_ns);
  // Five seconds of samples come in half a second: the cable was pulled, the bridges kept what was not heard.
  scene.now_ns += 5 * kNsPerSecond;
  int spoke = 0;
  for (int i = 0; i < 500; ++i) {
    scene.now_ns += kNsPerMillisecond;
    ++scene.step;
    spoke += scene.replica.own(scene.state("b", 0.0), scene.now_ns) ? 1 : 0;
  }
  EXPECT_EQ(spoke, 0);
  EXPECT_GT(scene.alone(600), 0);
  EXPECT_EQ(scene.alone(100), 100);
}

TEST(Replica, SpeaksThoughLateWhenNobodyHasNewerStates) {
  Scene scene;
  scene.alone(300);
  scene.replica.others(1, scene.now_ns);
  scene.led(300, 0.0);
  // The machine is busy, and all that comes is 0.3 s late. The other one is in time, and is heard.
  scene.now_ns += 300 * kNsPerMillisecond;
  EXPECT_EQ(scene.led(100, 0.0), 0);
  // The other one dies.
  const int spoke = scene.alone(100);
  EXPECT_GE(spoke, 75) << "after 0.2 s";
  EXPECT_LE(spoke, 85);
}

TEST(Replica, SaysNothingOfThePastAlsoWhenItWasLateBefore) {
  Scene scene;
  scene.alone(300);
  scene.replica.others(1, scene.now_ns);
  scene.now_ns += 300 * kNsPerMillisecond;
  scene.alone(100);
  // It stands still for a second, and then takes in what waited before it hears anybody.
  scene.now_ns += kNsPerSecond;
  for (int i = 0; i < 100; ++i) {
    scene.now_ns += kNsPerMillisecond;
    ++scene.step;
    EXPECT_FALSE(scene.replica.own(scene.state("b", 0.0), scene.now_ns));
  }
}

TEST(Replica, AClockThatIsSetSilencesNobody) {
  for (const int hour : {-360'000, 360'000}) {
    Scene scene;
    scene.alone(300);
    scene.replica.others(1, scene.now_ns);
    scene.step += hour;
    EXPECT_EQ(scene.alone(500), 500);
  }
}

TEST(Replica, ALeaderThatLacksSamplesMakesRoomForOneThatHasThem) {
  Scene scene;
  scene.alone(50);
  scene.replica.missed(3, scene.now_ns);
  scene.replica.told(scene.account(0), scene.now_ns);
  EXPECT_TRUE(scene.replica.leads()) << "the other one may not have noticed yet";
  scene.alone(60);
  scene.replica.told(scene.account(3), scene.now_ns);
  EXPECT_TRUE(scene.replica.leads()) << "both lack them";
  scene.replica.told(scene.account(0, ReplicaPhase::behind), scene.now_ns);
  EXPECT_TRUE(scene.replica.leads()) << "who is behind knows less still";
  scene.replica.told(scene.account(0), scene.now_ns);
  EXPECT_EQ(scene.replica.phase(), ReplicaPhase::behind);
  EXPECT_NE(scene.replica.reason().find("lacks 3 samples"), std::string::npos) << scene.replica.reason();
  scene.replica.caught_up(0);
  scene.led(20, 0.0);
  EXPECT_EQ(scene.replica.phase(), ReplicaPhase::in_step);
  EXPECT_EQ(scene.replica.missed(), 0U) << "it lacks what the state lacks that it took";
}

TEST(Replica, OneThatFollowsAndLacksMoreCatchesUp) {
  Scene scene;
  scene.led(20, 0.0);
  scene.replica.missed(1, scene.now_ns);
  scene.led(60, 0.0);
  scene.replica.told(scene.account(0), scene.now_ns);
  EXPECT_EQ(scene.replica.phase(), ReplicaPhase::behind);
}

TEST(Replica, MakesRoomWhenItBeganAloneByMistake) {
  Scene scene;
  scene.alone(60);  // it was not heard: the network was slow to make them known
  ReplicaStatus peer = scene.account(0);
  peer.in_step_s = 0.5;
  scene.replica.told(peer, scene.now_ns);
  EXPECT_TRUE(scene.replica.leads()) << "they began together";
  peer.in_step_s = 500.0;
  scene.replica.told(peer, scene.now_ns);
  EXPECT_EQ(scene.replica.phase(), ReplicaPhase::behind);

  Scene later;
  later.alone(1100);
  later.replica.told(peer, later.now_ns);
  EXPECT_TRUE(later.replica.leads()) << "two that were under way apart: the stronger one is heard";
}

/// Hears the weaker one, "a", as long as it says nothing itself; each tells the other how it is.
int beside_a_weaker_one(Scene& scene, int steps, int pause_every = 0) {
  int spoke = 0;
  ReplicaStatus weaker = scene.account(0);
  weaker.ownership_strength = 5;
  for (int i = 0; i < steps; ++i) {
    scene.advance();
    if (i % 20 == 0) scene.replica.told(weaker, scene.now_ns);
    if (pause_every > 0 && i % pause_every < 5) {  // the scheduler kept it for five periods
      scene.replica.heard(scene.state("a", 0.0), false, scene.now_ns);
      continue;
    }
    const bool said = scene.replica.own(scene.state("b", 0.0), scene.now_ns);
    spoke += said ? 1 : 0;
    scene.replica.heard(scene.state(said ? "b" : "a", 0.0), said, scene.now_ns);
  }
  return spoke;
}

TEST(Replica, LeavesTheLeadToAWeakerOneUntilItKeepsItsTime) {
  Scene scene;
  scene.alone(100);
  scene.replica.others(1, scene.now_ns);
  EXPECT_EQ(beside_a_weaker_one(scene, 300), 300);
  // Paused once: the weaker one is heard for two seconds.
  EXPECT_EQ(beside_a_weaker_one(scene, 190, 1000), 0);
  EXPECT_FALSE(scene.replica.leads());
  EXPECT_GE(beside_a_weaker_one(scene, 300), 280);
  EXPECT_TRUE(scene.replica.leads());
  // Paused every half second, it stays away.
  EXPECT_EQ(beside_a_weaker_one(scene, 2000, 50), 0);
  EXPECT_GE(beside_a_weaker_one(scene, 300), 90);
}

TEST(Replica, SpeaksAtOnceWhenTheOneItLeftTheLeadToFallsSilent) {
  Scene scene;
  scene.alone(100);
  scene.replica.others(1, scene.now_ns);
  beside_a_weaker_one(scene, 100);
  ASSERT_EQ(beside_a_weaker_one(scene, 50, 1000), 0);
  EXPECT_GE(scene.alone(30), 20) << "after a tenth of a second";
}

TEST(Replica, TakesTheLeadFromAWeakerOneWhenItComesInStep) {
  Scene scene;
  ReplicaStatus weaker = scene.account(0);
  weaker.ownership_strength = 5;
  scene.replica.told(weaker, scene.now_ns);
  scene.led(20, 0.0);
  EXPECT_EQ(scene.replica.phase(), ReplicaPhase::in_step);
  EXPECT_EQ(beside_a_weaker_one(scene, 400), 400);
}

TEST(Replica, DoesNotFollowALeaderThatLacksMore) {
  Scene scene;
  scene.led(20, 0.0);
  for (int i = 0; i < 400; ++i) {
    if (i % 20 == 0) scene.replica.told(scene.account(7), scene.now_ns);
    scene.led(1, 2.0);
  }
  EXPECT_EQ(scene.replica.phase(), ReplicaPhase::in_step);
}

}  // namespace
}  // namespace fathom::fusion
