// The rows of a history, and what is asked of them, by hand and at random.

#include <algorithm>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "cli/explain/read.hpp"
#include "explain/account.hpp"
#include "explain/sentence.hpp"
#include "explain/watch/silence.hpp"
#include "explain/watch/watches.hpp"

namespace fathom::test {
namespace {

using explain::Arrival;
using explain::History;

constexpr TimeNs kStart_ns = 1'700'000'000 * kNsPerSecond;

template <class T>
T at(double t_s, const char* sensor) {
  T out;
  out.header = {"auv", sensor, kStart_ns + from_seconds(t_s), kStart_ns + from_seconds(t_s), 1};
  return out;
}

Arrival arrival(double t_s, const std::string& writer = "w") {
  return {kStart_ns + from_seconds(t_s), writer, "010f00000000000000000001"};
}

NavState state(double t_s, double sigma_m) {
  auto out = at<NavState>(t_s, "fusion");
  out.mode = NavMode::gps_aided;
  out.alignment = AlignmentPhase::aligned;
  out.velocity_N_m_s = {1.0, 0.0, 0.0};
  out.rpy_rad = {0.0, 0.0, 0.0};
  out.position_covariance_N_m2.fill(0.0);
  out.position_covariance_N_m2[0] = out.position_covariance_N_m2[4] = 0.5 * sigma_m * sigma_m;
  return out;
}

Verdict verdict(double t_s, VerdictKind kind, bool is_final = true) {
  auto out = at<Verdict>(t_s, "gps");
  out.source = SourceKind::gps;
  out.model = "gps_position";
  out.kind = out.previous = kind;
  out.header.sequence = static_cast<std::uint64_t>(10.0 * t_s);
  out.is_final = is_final;
  return out;
}

TEST(History, ALaterVerdictReplacesTheFirst) {
  History history;
  history.add(verdict(1.0, VerdictKind::rejected, false), arrival(1.0));
  Verdict later = verdict(1.0, VerdictKind::used);
  later.revision = 1;
  later.previous = VerdictKind::rejected;
  history.add(later, arrival(1.5));
  ASSERT_EQ(history.verdicts().size(), 1U);
  EXPECT_EQ(history.verdicts().front().kind, VerdictKind::used);
}

TEST(History, AnotherVehicleIsNotHeard) {
  History history;
  history.add(state(1.0, 1.0), arrival(1.0));
  NavState other = state(1.1, 1.0);
  other.header.vehicle = "other";
  other.mode = NavMode::inertial;
  history.add(other, arrival(1.1));
  EXPECT_EQ(history.states().size(), 1U);
}

TEST(History, MemoryIsBoundedAndTold) {
  History history({.rows = 100});
  for (int i = 0; i < 5000; ++i) history.add(state(0.1 * i, 1.0), arrival(0.1 * i));
  // Lists are cut every few seconds.
  EXPECT_LE(history.states().size(), 200U);
  EXPECT_GT(history.forgotten(), 4000U);
  EXPECT_GT(history.from_ns(), kStart_ns + 400 * kNsPerSecond);
}

TEST(History, OnlyTheSpanIsKept) {
  History history({.span_ns = 60 * kNsPerSecond});
  for (int i = 0; i < 3000; ++i) history.add(state(0.1 * i, 1.0), arrival(0.1 * i));
  EXPECT_NEAR(to_seconds(history.to_ns() - history.from_ns()), 60.0, 6.0);
  EXPECT_EQ(history.forgotten(), 0U);
}

TEST(Findings, NothingIsFoundInNothing) {
  EXPECT_TRUE(explain::findings(History{}).empty());
}

/// The silences of a receiver that ends 10 s before the log, beside a compass that ends later by `later_s`.
std::vector<explain::Silence> silences_at_the_end(ServiceState last, double later_s) {
  History history;
  for (int i = 0; i <= 50 + static_cast<int>(later_s); ++i) {
    history.add(at<HeadingSample>(i, "heading"), arrival(i, "heading_bridge"));
    if (i > 50) continue;
    history.add(at<GpsSample>(i, "gps"), arrival(i, "gps_bridge"));
    auto sign = at<ServiceStatus>(i, "gps_bridge");
    sign.state = i < 50 ? ServiceState::healthy : last;
    history.add(sign, arrival(i));
  }
  history.add(state(60.0, 1.0), arrival(60.0));
  return explain::silences(history, history.streams()[1], 2 * kNsPerSecond);
}

TEST(Silences, WhoIsToldToStopIsNotMissedAtTheEndOfTheMission) {
  EXPECT_TRUE(silences_at_the_end(ServiceState::stopping, 3.0).empty());
  // But in the middle of it.
  const auto stopped = silences_at_the_end(ServiceState::stopping, 8.0);
  ASSERT_EQ(stopped.size(), 1U);
  EXPECT_NEAR(to_seconds(stopped[0].length_ns()), 8.0, 1e-9);
  const auto unheard = silences_at_the_end(ServiceState::healthy, 0.0);
  ASSERT_EQ(unheard.size(), 1U);
  EXPECT_TRUE(unheard[0].to_end);
  EXPECT_NEAR(to_seconds(unheard[0].length_ns()), 10.0, 1e-9);
}

/// How many second writers are found where each of these gives a fix ten times in a second, for so long.
std::size_t second_writers(const std::vector<std::pair<double, double>>& spans_s) {
  History history;
  std::size_t number = 0;
  std::vector<std::pair<double, std::string>> told;
  for (const auto& [from_s, to_s] : spans_s) {
    const std::string writer = "fathom_fix_" + std::to_string(++number);
    for (int i = 0; from_s + 0.1 * i < to_s; ++i) told.emplace_back(from_s + 0.1 * i, writer);
  }
  std::sort(told.begin(), told.end());
  for (const auto& [t_s, writer] : told)
    history.add(at<FixSample>(t_s, "operator"),
                {kStart_ns + from_seconds(t_s), writer, "010f0000000000000000" + writer.substr(11)});
  explain::Findings out;
  explain::watch_writers(history, out);
  return static_cast<std::size_t>(std::count_if(
      out.begin(), out.end(), [](const auto& one) { return one.kind == explain::Kind::second_writer; }));
}

TEST(Findings, WhoTellsAPositionByHandAgainAndAgainIsNoSecondWriter) {
  std::vector<std::pair<double, double>> orders;
  for (int i = 0; i < 12; ++i) orders.emplace_back(0.4 * i, 0.4 * i + 0.2);
  EXPECT_EQ(second_writers(orders), 0U);
  EXPECT_EQ(second_writers({{0.0, 20.0}, {5.0, 15.0}}), 1U);
}

TEST(Around, TellsWhatWasUsedInTheLastTenSeconds) {
  History history;
  for (int i = 0; i < 60; ++i) {
    const double t_s = i;
    history.add(state(t_s, 1.0), arrival(t_s));
    auto one = verdict(t_s, i < 30 ? VerdictKind::used : VerdictKind::no_fix);
    history.add(one, arrival(t_s));
  }
  const explain::Around then = explain::around(history, kStart_ns + 40 * kNsPerSecond);
  ASSERT_EQ(then.sources.size(), 1U);
  EXPECT_EQ(then.sources[0].used(), 0U);
  EXPECT_EQ(then.sources[0].main_reason(), VerdictKind::no_fix);
  EXPECT_NEAR(then.sources[0].last_used_s, 11.0, 1e-9);
  ASSERT_NE(then.state, nullptr);
  EXPECT_NEAR(then.state->sigma_m, 1.0, 1e-9);
}

TEST(Around, TheAlarmIsLedToByWhatConcernsIt) {
  History history;
  for (int i = 0; i < 60; ++i) {
    history.add(state(i, 1.0), arrival(i));
    history.add(verdict(i, i < 30 ? VerdictKind::used : VerdictKind::no_fix), arrival(i));
  }
  auto alarm = at<Alarm>(35.0, "monitor");
  alarm.alarm = "gps_outage";
  alarm.active = true;
  history.add(alarm, arrival(35.0));
  const explain::Answer answer = explain::answer(history, {.alarm = "gps_outage"});
  ASSERT_EQ(answer.alarms.size(), 1U);
  const auto cause = explain::behind(answer.findings, *answer.alarms.front());
  ASSERT_TRUE(cause.has_value());
  EXPECT_EQ(to_string(answer.findings[*cause].kind), "lost");
  EXPECT_EQ(answer.findings[*cause].word, "no_fix");
  const std::string text = explain::account(history, answer);
  EXPECT_TRUE(text.starts_with("Most likely: gps had no fix for 30.0 s")) << text;
  EXPECT_NE(text.find("gps_outage"), std::string::npos);
  const auto json = explain::to_json(history, answer);
  EXPECT_EQ(json["findings"][answer.roots.front()]["subject"], "gps");
  EXPECT_EQ(json["alarms"][0]["led_to_by"], *cause);
}

// Whatever stands in the fields, nothing crashes, and the answer can be printed.
TEST(Explain, GarbageIsSurvived) {
  std::mt19937_64 random(7);
  const auto any = [&]() -> double {
    static constexpr std::array<double, 8> kOdd{0.0,       -0.0,  kUnknown, HUGE_VAL,
                                                -HUGE_VAL, 1e308, -1e-308,  1.0};
    return random() % 3 == 0 ? kOdd[random() % kOdd.size()]
                             : std::uniform_real_distribution<double>(-100.0, 100.0)(random);
  };
  const auto any_time = [&] {
    return random() % 10 == 0 ? static_cast<TimeNs>(random())
                              : kStart_ns + static_cast<TimeNs>(random() % 300) * 100'000'000;
  };
  for (int round = 0; round < 50; ++round) {
    History history;
    for (int i = 0; i < 400; ++i) {
      const Arrival from{any_time(), random() % 2 == 0 ? "a" : "", random() % 2 == 0 ? "p" : ""};
      SampleHeader header{"auv", random() % 2 == 0 ? "gps" : "x", any_time(), any_time(), random() % 50};
      switch (random() % 7) {
        case 0: {
          NavState one;
          one.header = header;
          one.mode = static_cast<NavMode>(random() % 9);
          one.alignment = static_cast<AlignmentPhase>(random() % 9);
          for (double& v : one.velocity_N_m_s) v = any();
          for (double& v : one.rpy_rad) v = any();
          for (double& v : one.position_covariance_N_m2) v = any();
          one.reset_counter = static_cast<std::uint32_t>(random() % 5);
          history.add(one, from);
          break;
        }
        case 1: {
          Verdict one;
          one.header = header;
          one.source = static_cast<SourceKind>(random() % 12);
          one.kind = static_cast<VerdictKind>(random() % 14);
          one.dimensions = static_cast<std::uint32_t>(random() % 9);
          for (double& v : one.innovation) v = any();
          for (double& v : one.innovation_sigma) v = any();
          one.limit = any();
          one.revision = static_cast<std::uint32_t>(random() % 3);
          history.add(one, from);
          break;
        }
        case 2: {
          GpsSample one;
          one.header = header;
          one.fix = static_cast<GpsFix>(random() % 10);
          for (double& v : one.velocity_N_m_s) v = any();
          history.add(one, from);
          break;
        }
        case 3: {
          DvlSample one;
          one.header = header;
          for (double& v : one.velocity_D_m_s) v = any();
          history.add(one, from);
          break;
        }
        case 4: {
          ImuSample one;
          one.header = header;
          history.add(one, from);
          break;
        }
        case 5: {
          ServiceStatus one;
          one.header = header;
          one.pid = static_cast<std::uint32_t>(random() % 3);
          one.utc_offset_ns = static_cast<DurationNs>(random());
          history.add(one, from);
          break;
        }
        default: {
          Alarm one;
          one.header = header;
          one.alarm = random() % 2 == 0 ? "gps_outage" : "a:b";
          one.active = random() % 2 == 0;
          one.text = "\xff\xfe";
          history.add(one, from);
        }
      }
    }
    const explain::Answer all = explain::answer(history, {});
    for (const explain::Finding& one : all.findings) EXPECT_FALSE(explain::sentence(one).empty());
    EXPECT_FALSE(explain::account(history, all).empty());
    EXPECT_FALSE(explain::to_json(history, all)
                     .dump(-1, ' ', false, nlohmann::json::error_handler_t::replace)
                     .empty());
    (void)explain::answer(history, {.at_ns = any_time()});
  }
}

TEST(Explain, MessagesThatAreNoneOfTheirTopicAreRefused) {
  std::mt19937_64 random(11);
  History history;
  for (const std::string& topic : cli::explained_topics())
    for (std::size_t size = 0; size < 200; ++size) {
      std::vector<std::uint8_t> data(size);
      for (auto& byte : data) byte = static_cast<std::uint8_t>(random());
      (void)cli::add_message(history, topic, data, arrival(1.0));
    }
  EXPECT_FALSE(cli::add_message(history, "fathom/v1/imu", {}, arrival(1.0)));
  EXPECT_FALSE(cli::add_message(history, "fathom/v1/unheard_of", {}, arrival(1.0)));
}

}  // namespace
}  // namespace fathom::test
