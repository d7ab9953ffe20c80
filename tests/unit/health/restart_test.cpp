// A monitor that is killed and started again goes on where it was; receivers that fusion does not take do not
// count.
#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "health/vehicle_health.hpp"
#include "support/sanitized.hpp"
#include "timeline.hpp"

namespace fathom::health {
namespace {

constexpr double kLimit_s = 5.0;
constexpr double kEnd_s = 400.0;
constexpr unsigned kSeeds = test::kSanitized ? 2 : 20;

struct Span {
  double from_s = 0.0;
  double to_s = 0.0;
};

HealthConfig with_gps_alone() {
  HealthConfig out;
  out.sensors = {{"gps", SourceKind::gps, 2.0, 0.0, Severity::warning}};
  out.gps.outage.limit_s = kLimit_s;
  return out;
}

/// The books of each whole second of a monitor's life.
using Books = std::vector<std::vector<GpsOutageBook>>;

/// GPS at 2 Hz that is away in spans, navigation at 10 Hz unless fusion is dead, and a monitor.
class World {
 public:
  World(std::vector<Span> outages, bool fusion_alive)
      : outages_(std::move(outages)), fusion_alive_(fusion_alive) {}

  /// A monitor's life from the beginning to the end. `watched` is called at 10 Hz.
  template <class Watch>
  Books live(const Watch& watched) const {
    Books books{{}};
    VehicleHealth monitor(with_gps_alone(), at(0.0));
    go_on(monitor, 0.0, watched, &books);
    return books;
  }

  /// The life of one that starts at `from_s` with those books.
  template <class Watch>
  void live_on(const std::vector<GpsOutageBook>& books, double from_s, const Watch& watched) const {
    VehicleHealth monitor(with_gps_alone(), at(from_s));
    monitor.resume(books, at(from_s));
    go_on(monitor, from_s, watched, nullptr);
  }

 private:
  template <class Watch>
  void go_on(VehicleHealth& monitor, double from_s, const Watch& watched, Books* books) const {
    double last_fix_s = 0.0;
    for (int tick = 1; tick <= std::lround(kEnd_s * 10.0); ++tick) {
      const double t = 0.1 * tick;
      const bool fix = has_fix(t);
      if (tick % 5 == 0 && fix) last_fix_s = t;
      if (t < from_s) continue;
      const Instant now = at(t);
      NavState state = nav(t, fix ? NavMode::gps_aided : NavMode::dead_reckoning);
      state.gps_outage_s = t - last_fix_s;
      if (fusion_alive_) monitor.add(state, now);
      if (tick % 5 == 0) monitor.add(gps(t, fix), now);
      monitor.evaluate(now);
      if (books != nullptr && tick % 10 == 0) books->push_back(monitor.books(now));
      watched(t, monitor.status(now), t - last_fix_s);
      if (::testing::Test::HasFatalFailure()) return;
    }
  }
  [[nodiscard]] bool has_fix(double t) const {
    return std::none_of(outages_.begin(), outages_.end(),
                        [t](const Span& one) { return t >= one.from_s && t < one.to_s; });
  }

  std::vector<Span> outages_;
  bool fusion_alive_;
};

/// Outages of 8 to 90 s, drawn.
std::vector<Span> draw(std::mt19937& random) {
  const auto between = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(random() % 10000) / 10000.0;
  };
  std::vector<Span> out;
  for (double t = between(20.0, 60.0); t < kEnd_s - 120.0;) {
    const double length = between(8.0, 90.0);
    out.push_back({t, t + length});
    t += length + between(20.0, 60.0);
  }
  return out;
}

/// Whoever has been without GPS for longer than its limit, or knows nothing, is not healthy.
void expect_careful(double t, const MonitorStatus& status, double without_s) {
  if (without_s > kLimit_s + 0.11 || !status.known) {
    ASSERT_FALSE(status.healthy) << "at " << t;
  }
}

TEST(MonitorRestart, OutagesGoOnAtFortyInstantsOfTwentySeeds) {
  for (unsigned seed = 1; seed <= kSeeds; ++seed) {
    std::mt19937 random(seed);
    const std::vector<Span> outages = draw(random);
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::vector<MonitorStatus> uninterrupted(4001);
    const World with_fusion(outages, true);
    const Books with_books = with_fusion.live([&](double t, const MonitorStatus& status, double without_s) {
      uninterrupted[static_cast<std::size_t>(std::lround(t * 10.0))] = status;
      expect_careful(t, status, without_s);
    });
    const World without_fusion(outages, false);
    const Books without_books =
        without_fusion.live([&](double t, const MonitorStatus& status, double without_s) {
          expect_careful(t, status, without_s);
        });
    for (int instant = 0; instant < 40; ++instant) {
      // Around the edges of the outages and anywhere else.
      const Span& near = outages[static_cast<std::size_t>(instant) % outages.size()];
      const double offset = 0.1 * static_cast<double>(random() % 150) - 5.0;
      const double kill_s = instant % 3 == 0   ? near.from_s + offset
                            : instant % 3 == 1 ? near.to_s + offset
                                               : 0.1 * static_cast<double>(10 + random() % 3800);
      const double down_s = 0.5 + 0.1 * static_cast<double>(random() % 40);
      const bool fusion_alive = instant % 2 == 0;
      SCOPED_TRACE("killed at " + std::to_string(kill_s) + " for " + std::to_string(down_s) + " s, fusion " +
                   (fusion_alive ? "alive" : "dead"));
      // Its books are those of the last whole second before it was killed.
      const auto whole_s = static_cast<std::size_t>(std::max(0, static_cast<int>(std::ceil(kill_s)) - 1));
      const World& world = fusion_alive ? with_fusion : without_fusion;
      const Books& books = fusion_alive ? with_books : without_books;
      world.live_on(
          books.at(whole_s), kill_s + down_s, [&](double t, const MonitorStatus& status, double without_s) {
            const MonitorStatus& before = uninterrupted[static_cast<std::size_t>(std::lround(t * 10.0))];
            expect_careful(t, status, without_s);
            const bool settled = t > kill_s + down_s + kLimit_s + 0.2;
            if (!settled) return;
            ASSERT_TRUE(!fusion_alive || status.known) << "at " << t;
            // Where fusion is dead as well nobody can tell an outage that ended soon after the restart from
            // none.
            const bool unheard = !fusion_alive && status.gps_outage_count + 1 == before.gps_outage_count;
            if (unheard) return;
            ASSERT_EQ(status.gps_outage_active, before.gps_outage_active) << "at " << t;
            // Where fusion is dead as well nobody heard the fixes of the pause.
            const double unheard_s = fusion_alive ? 0.0 : down_s;
            ASSERT_NEAR(status.gps_outage_s, before.gps_outage_s, 1.0 + unheard_s) << "at " << t;
            ASSERT_EQ(status.gps_outage_count, before.gps_outage_count) << "at " << t;
            ASSERT_NEAR(status.gps_outage_total_s, before.gps_outage_total_s, down_s + 2.0) << "at " << t;
          });
      if (::testing::Test::HasFatalFailure()) return;
    }
  }
}

TEST(MonitorRestart, WithoutBooksFusionsWordCountsAndUntilThenNothingIsKnown) {
  VehicleHealth monitor(with_gps_alone(), at(0.0));
  monitor.evaluate(at(0.1));
  EXPECT_FALSE(monitor.status(at(0.1)).known);
  EXPECT_FALSE(monitor.status(at(0.1)).healthy);
  NavState state = nav(0.2, NavMode::dead_reckoning);
  state.gps_outage_s = 300.0;
  monitor.add(state, at(0.2));
  monitor.add(gps(0.2, false), at(0.2));
  monitor.evaluate(at(0.2));
  const MonitorStatus status = monitor.status(at(0.2));
  EXPECT_TRUE(status.gps_outage_active);
  EXPECT_NEAR(status.gps_outage_s, 300.0, 0.1);
  EXPECT_FALSE(status.healthy);
}

/// 2 Hz of fixes of two receivers for `seconds`, each with fusion's verdict where there is one.
struct Feed {
  Name receiver;
  std::optional<VerdictKind> verdict;
};
void feed(VehicleHealth& monitor, double from_s, double to_s, const std::vector<Feed>& feeds) {
  for (double t = from_s; t < to_s; t += 0.5) {
    monitor.add(nav(t), at(t));
    for (const Feed& one : feeds) {
      monitor.add(gps(t, true, one.receiver), at(t));
      monitor.evaluate(at(t));
      if (one.verdict) monitor.add(verdict(SourceKind::gps, *one.verdict, t, one.receiver), at(t + 0.1));
    }
    monitor.evaluate(at(t + 0.2));
  }
}

TEST(Receivers, AStrayOneDoesNotHideTheOutageOfTheVehicle) {
  VehicleHealth monitor(with_gps_alone(), at(0.0));
  feed(monitor, 0.0, 20.0, {{"gps", VerdictKind::used}});
  EXPECT_FALSE(monitor.status(at(20.0)).gps_outage_active);
  feed(monitor, 20.0, 320.0, {{"stray", std::nullopt}});
  const MonitorStatus status = monitor.status(at(320.0));
  EXPECT_TRUE(status.gps_outage_active);
  EXPECT_NEAR(status.gps_outage_s, 300.0, 1.5);
  EXPECT_FALSE(status.healthy);
}

TEST(Receivers, OneThatFusionDoesNotTakeIsNone) {
  for (const VerdictKind kind : {VerdictKind::source_disabled, VerdictKind::rejected, VerdictKind::frozen}) {
    HealthConfig any = with_gps_alone();
    any.sensors.clear();  // nobody said which receivers to expect
    VehicleHealth monitor(any, at(0.0));
    feed(monitor, 0.0, 20.0, {{"gps", VerdictKind::used}});
    feed(monitor, 20.0, 60.0, {{"gps", kind}});
    const MonitorStatus status = monitor.status(at(60.0));
    EXPECT_TRUE(status.gps_outage_active) << to_string(kind);
    EXPECT_NEAR(status.gps_outage_s, 40.0, 1.5) << to_string(kind);
    feed(monitor, 60.0, 65.0, {{"gps", VerdictKind::used}});
    EXPECT_FALSE(monitor.status(at(65.0)).gps_outage_active) << to_string(kind);
    // Fusion dead: the receiver's own word counts again.
    feed(monitor, 65.0, 90.0, {{"gps", std::nullopt}});
    EXPECT_FALSE(monitor.status(at(90.0)).gps_outage_active) << to_string(kind);
  }
}

TEST(Receivers, AFixOfKilometresIsNone) {
  GpsSample fix = gps(1.0);
  EXPECT_TRUE(is_usable(fix));
  fix.hdop = 1.2;
  fix.position_sigma_N_m = {3.0, 3.0, 5.0};
  EXPECT_TRUE(is_usable(fix));
  fix.position_sigma_N_m = {5000.0, 5000.0, 5000.0};
  EXPECT_FALSE(is_usable(fix));
  fix.position_sigma_N_m = {kUnknown, kUnknown, kUnknown};
  fix.hdop = 99.0;
  EXPECT_FALSE(is_usable(fix));
}

}  // namespace
}  // namespace fathom::health
