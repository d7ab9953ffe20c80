#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "health/alarm_book.hpp"
#include "health/writers/service_watch.hpp"
#include "timeline.hpp"

namespace fathom::health {
namespace {

using testing::HasSubstr;

ServiceStatus sign(const std::string& service, std::uint32_t pid) {
  ServiceStatus status;
  status.header.sensor = std::string_view(service);
  status.state = ServiceState::healthy;
  status.host = "vm";
  status.pid = pid;
  status.started_ns = from_seconds(pid);
  return status;
}

class ServiceTwice : public testing::Test {
 protected:
  void step(double t_s) {
    watch.evaluate(at(t_s));
    watch.report(book, at(t_s));
    for (const AlarmTransition& one : book.take_transitions()) {
      if (one.event == AlarmEvent::raised) ++raised[one.alarm.alarm.str()];
    }
  }
  [[nodiscard]] bool alarmed(const char* key) const {
    const Alarm* found = book.find(key);
    return found != nullptr && found->active;
  }
  ServiceWatch watch{{{"fusion", Severity::critical}}, {}, 15.0, at(0.0)};
  AlarmBook book;
  std::map<std::string, int> raised;
};

TEST_F(ServiceTwice, TwoOfOneNameAreAnAlarmAsLongAsBothLiveAndNoRestarts) {
  double t_s = 0.0;
  const auto second = [&](bool one, bool other) {
    if (one) watch.add(sign("fusion", 100), at(t_s));
    step(t_s);
    if (other) watch.add(sign("fusion", 200), at(t_s + 0.5));
    step(t_s + 0.5);
    t_s += 1.0;
  };
  for (int i = 0; i < 10; ++i) second(true, false);
  EXPECT_FALSE(alarmed("service_twice:fusion"));
  for (int i = 0; i < 60; ++i) second(true, true);
  ASSERT_TRUE(alarmed("service_twice:fusion"));
  EXPECT_EQ(book.find("service_twice:fusion")->severity, Severity::critical);
  EXPECT_THAT(book.find("service_twice:fusion")->text,
              HasSubstr("process 100 on host vm and process 200 on host vm"));
  EXPECT_EQ(raised["service_twice:fusion"], 1);
  EXPECT_EQ(raised["service_restarted:fusion"], 1)
      << "the second one, before it was known that the first lives";
  for (int i = 0; i < 6; ++i) second(true, false);
  EXPECT_FALSE(alarmed("service_twice:fusion"));
}

TEST_F(ServiceTwice, OneThatIsHeardOnceMoreAfterItsSuccessorIsNoSecond) {
  watch.add(sign("fusion", 100), at(0.0));
  step(0.0);
  watch.add(sign("fusion", 200), at(1.0));
  watch.add(sign("fusion", 100), at(1.1));
  step(1.1);
  for (double t_s = 2.0; t_s < 20.0; t_s += 1.0) {
    watch.add(sign("fusion", 200), at(t_s));
    step(t_s);
    if (t_s < 3.0) continue;
    EXPECT_FALSE(alarmed("service_twice:fusion")) << t_s;
  }
  watch.add(sign("fusion", 300), at(100.0));
  step(100.0);
  EXPECT_EQ(raised["service_restarted:fusion"], 2);
}

TEST_F(ServiceTwice, OneThatFindsNoRoomIsAnAlarmAndTakesThePlaceOfOneThatIsGone) {
  const auto all = [&](int from, int until, double t_s) {
    for (int i = from; i < until; ++i) {
      ServiceStatus status = sign("service" + std::to_string(i), static_cast<std::uint32_t>(i + 1));
      status.state = i == 40 ? ServiceState::degraded : ServiceState::healthy;
      watch.add(status, at(t_s));
    }
    watch.add(sign("fusion", 100), at(t_s));
    step(t_s);
  };
  for (double t_s = 0.0; t_s < 10.0; t_s += 1.0) all(0, 31, t_s);  // with fusion there are 32
  EXPECT_FALSE(alarmed("services_unwatched"));
  for (double t_s = 10.0; t_s < 20.0; t_s += 1.0) all(10, 41, t_s);
  // Ten were gone, and ten came.
  EXPECT_FALSE(alarmed("services_unwatched"));
  EXPECT_TRUE(alarmed("service_unwell:service40"));
  EXPECT_EQ(watch.items(at(20.0)).size(), ServiceWatch::kMaxServices);
  for (double t_s = 20.0; t_s < 30.0; t_s += 1.0) all(10, 42, t_s);
  ASSERT_TRUE(alarmed("services_unwatched"));
  EXPECT_THAT(book.find("services_unwatched")->text, HasSubstr("service41"));
}

}  // namespace
}  // namespace fathom::health
