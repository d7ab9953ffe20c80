#include "console/view/history.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "console/view/vehicle_view.hpp"
#include "console/view/vehicle_view_json.hpp"

namespace fathom::console {
namespace {

constexpr TimeNs kBegin = 1'700'000'000 * kNsPerSecond;

NavState nav_at(TimeNs stamp_ns) {
  NavState state;
  state.header.vehicle = "auv";
  state.header.stamp_ns = stamp_ns;
  state.latitude_rad = 0.6;
  state.longitude_rad = 2.2;
  state.position_covariance_N_m2 = {4, 0, 0, 0, 4, 0, 0, 0, 9};
  return state;
}

Verdict verdict_at(TimeNs stamp_ns, const Name& sensor, VerdictKind kind = VerdictKind::used) {
  Verdict verdict;
  verdict.header.vehicle = "auv";
  verdict.header.sensor = sensor;
  verdict.header.stamp_ns = stamp_ns;
  verdict.header.received_ns = stamp_ns + 30 * kNsPerMillisecond;
  verdict.source = SourceKind::dvl;
  verdict.model = "dvl_velocity";
  verdict.kind = kind;
  verdict.dimensions = 3;
  return verdict;
}

TEST(Ring, KeepsTheNewestInOrder) {
  Ring<int> ring(3);
  for (int i = 0; i < 5; ++i) ring.push(i);
  EXPECT_EQ(ring.size(), 3U);
  EXPECT_EQ(ring[0], 2);
  EXPECT_EQ(ring.back(), 4);
}

TEST(History, TwelveHoursAtFullRateTakeNoMoreThanTenMinutes) {
  History history;
  const std::size_t nav_capacity = history.nav().capacity();
  const TimeNs step = kNsPerSecond / 400;
  std::size_t rows_after_ten_minutes = 0;
  NavState nav = nav_at(kBegin);
  Verdict dvl = verdict_at(kBegin, "dvl");
  NavDetail detail;
  detail.count = 2;
  detail.states[0].name = "gyro_bias_x_rad_s";
  for (std::int64_t i = 0; i < 12LL * 3600 * 400; ++i) {
    nav.header.stamp_ns = kBegin + i * step;
    history.add(nav);
    if (i % 80 == 0) {
      dvl.header.stamp_ns = nav.header.stamp_ns;
      history.add(dvl);
      detail.header.stamp_ns = nav.header.stamp_ns;
      history.add(detail);
    }
    if (i % 40 == 0) (void)history.commit();
    if (i == 700LL * 400) rows_after_ten_minutes = history.nav().size();
  }
  EXPECT_EQ(history.nav().size(), rows_after_ten_minutes);
  EXPECT_EQ(history.nav().size(), nav_capacity);
  EXPECT_EQ(history.nav().capacity(), nav_capacity);
  ASSERT_EQ(history.verdicts().size(), 1U);
  EXPECT_EQ(history.verdicts()[0].rows.size(), VerdictSeries::kRows);
  EXPECT_EQ(history.detail().size(), history.detail().capacity());
  const double kept_s = to_seconds(history.nav().back().utc_ns - history.nav()[0].utc_ns);
  EXPECT_NEAR(kept_s, kHistoryS, 1.0);
}

TEST(History, NamesFromTheNetworkAreLimited) {
  History history;
  for (int i = 0; i < 1000; ++i) {
    history.add(verdict_at(kBegin + i, std::string_view("sensor" + std::to_string(i))));
  }
  EXPECT_EQ(history.verdicts().size(), History::kMaxSeries);
  EXPECT_EQ(history.verdicts_left_out(), 1000 - History::kMaxSeries);
}

TEST(History, RefusalsAreKeptMoreDenselyThanWhatWasUsed) {
  History history;
  for (int i = 0; i < 100; ++i) {
    history.add(verdict_at(kBegin + i * 100 * kNsPerMillisecond, "used"));
    history.add(verdict_at(kBegin + i * 100 * kNsPerMillisecond, "refused", VerdictKind::rejected));
  }
  (void)history.commit();
  EXPECT_EQ(history.verdicts()[0].rows.size(), 25U);
  EXPECT_EQ(history.verdicts()[1].rows.size(), 100U);
}

TEST(History, EveryFixThatIsToldIsKeptAndOfOthersWhatTheSpacingLeaves) {
  History history;
  FixRow fix;
  for (const SourceKind source : {SourceKind::gps, SourceKind::fix}) {
    fix.source = source;
    fix.sensor = source == SourceKind::fix ? "operator" : "gps";
    for (int i = 0; i < 10; ++i) {
      fix.utc_ns = kBegin + i * 100 * kNsPerMillisecond;
      history.add(fix);
    }
  }
  const auto fixes = history.commit().fixes;
  const auto of = [&](SourceKind source) {
    return std::count_if(fixes.begin(), fixes.end(), [&](const FixRow& row) { return row.source == source; });
  };
  EXPECT_EQ(of(SourceKind::gps), 2);
  EXPECT_EQ(of(SourceKind::fix), 10);
}

TEST(History, AClockThatWentBackIsNoReasonToStop) {
  History history;
  history.add(nav_at(kBegin));
  history.add(nav_at(kBegin - 3600 * kNsPerSecond));
  EXPECT_EQ(history.commit().nav.size(), 2U);
}

TEST(History, OtherStatesBeginAnew) {
  History history;
  NavDetail detail;
  detail.count = 1;
  detail.states[0].name = "gyro_bias_x_rad_s";
  detail.header.stamp_ns = kBegin;
  history.add(detail);
  EXPECT_TRUE(history.commit().detail_renamed);
  detail.header.stamp_ns += 3 * kNsPerSecond;
  history.add(detail);
  EXPECT_FALSE(history.commit().detail_renamed);
  EXPECT_EQ(history.detail().size(), 2U);
  detail.header.stamp_ns += 3 * kNsPerSecond;
  detail.states[0].name = "accel_bias_x_m_s2";
  history.add(detail);
  EXPECT_TRUE(history.commit().detail_renamed);
  EXPECT_EQ(history.detail().size(), 1U);
}

TEST(History, AnIncrementHoldsExactlyWhatTheSnapshotBeforeItDidNot) {
  History history;
  history.add(nav_at(kBegin));
  (void)history.commit();
  history.add(nav_at(kBegin + kNsPerSecond));
  EXPECT_EQ(history.nav().size(), 1U) << "not yet said, so not yet in a snapshot";
  EXPECT_EQ(history.commit().nav.size(), 1U);
  EXPECT_EQ(history.nav().size(), 2U);
}

}  // namespace
}  // namespace fathom::console
