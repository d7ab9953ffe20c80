#include "monitor/metrics.hpp"

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <prometheus/text_serializer.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include "support/free_port.hpp"

namespace fathom::monitor {
namespace {

MetricsSnapshot snapshot() {
  MetricsSnapshot out;
  MonitorStatus& status = out.status;
  status.header.vehicle = "auv";
  status.known = true;
  status.healthy = true;
  status.mode = NavMode::dead_reckoning;
  status.alignment = AlignmentPhase::aligned;
  status.nav_state_age_s = 0.01;
  status.gps_outage_active = true;
  status.gps_outage_s = 12.5;
  status.gps_outage_longest_s = 30.0;
  status.gps_outage_total_s = 42.5;
  status.gps_outage_count = 2;
  status.receivers = {{"bow", true, Severity::notice, 1, 12.5, 30.0, 42.5, 2},
                      {"stern \"x\"\\", false, Severity::notice, 0, kUnknown, 0.0, 0.0, 0}};
  status.sensors = {{"imu", Presence::present, 0.01, 100.0},
                    {"actuator", Presence::missing, 9.0, kUnknown},
                    {"actuator", Presence::present, 0.1, 5.0}};
  status.services = {{"fusion", Presence::present, 0.5, 1.0}};
  status.alarms_unacknowledged = 1;
  Alarm alarm;
  alarm.alarm = "gps_outage";
  alarm.active = true;
  out.alarms = {alarm};
  out.forecast = {{"horizontal_100m", 100.0, 3.0, 40.0},
                  {"horizontal_1km", 1000.0, 3.0, std::numeric_limits<double>::infinity()}};
  out.horizontal_95_m = 3.2;
  out.verdicts["gps"] = {10, 1};
  out.raised = {1, 0, 0};
  return out;
}

std::string text_of(const MetricsSnapshot& now) {
  return prometheus::TextSerializer().Serialize(metric_families(now));
}

/// What promtool says of a text; its exit code.
int promtool(const std::string& text, std::string& said) {
  std::string pattern = (std::filesystem::temp_directory_path() / "fathom-metrics-XXXXXX").string();
  const std::filesystem::path folder = mkdtemp(pattern.data());
  std::ofstream(folder / "metrics") << text;
  const std::string command = "promtool check metrics < " + (folder / "metrics").string() + " 2>&1";
  FILE* pipe = popen(command.c_str(), "r");
  char buffer[512];
  while (std::fgets(buffer, sizeof buffer, pipe) != nullptr) said += buffer;
  const int status = pclose(pipe);
  std::filesystem::remove_all(folder);
  return WEXITSTATUS(status);
}

bool promtool_is_there() {
  return std::system("command -v promtool >/dev/null 2>&1") == 0;
}

/// A connection to this host; negative where nobody listens. Nobody waits for longer than a minute on it.
int connected(int port) {
  const int connection = socket(AF_INET, SOCK_STREAM, 0);
  const timeval patience{60, 0};
  (void)setsockopt(connection, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (connect(connection, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0) return connection;
  close(connection);
  return -1;
}

std::string get(int port, const std::string& path) {
  const int connection = connected(port);
  std::string answer;
  if (connection >= 0) {
    const std::string request = "GET " + path + " HTTP/1.0\r\nHost: localhost\r\n\r\n";
    (void)send(connection, request.data(), request.size(), 0);
    char buffer[4096];
    for (ssize_t got = 0; (got = recv(connection, buffer, sizeof buffer, 0)) > 0;) {
      answer.append(buffer, static_cast<std::size_t>(got));
    }
  }
  close(connection);
  return answer;
}

TEST(Metrics, SayWhatTheMonitorKnowsInBaseUnits) {
  const std::string text = text_of(snapshot());
  for (const char* line :
       {"fathom_gps_outage_seconds{vehicle=\"auv\"} 12.5\n", "fathom_gps_outages_total{vehicle=\"auv\"} 2\n",
        "# TYPE fathom_gps_outage_seconds_total counter\n",
        "fathom_navigation_mode{vehicle=\"auv\",mode=\"dead_reckoning\"} 1\n",
        "fathom_navigation_mode{vehicle=\"auv\",mode=\"gps_aided\"} 0\n",
        "fathom_sensor_rate_hertz{vehicle=\"auv\",sensor=\"imu\"} 100\n",
        "fathom_alarm_active{vehicle=\"auv\",alarm=\"gps_outage\",severity=\"notice\"} 1\n",
        "fathom_verdicts_total{vehicle=\"auv\",sensor=\"gps\",verdict=\"rejected\"} 1\n",
        "fathom_forecast_time_to_limit_seconds{vehicle=\"auv\",limit=\"horizontal_1km\"} +Inf\n"}) {
    EXPECT_NE(text.find(line), std::string::npos) << line << text;
  }
  EXPECT_EQ(text.find("stern"), text.find("stern \\\"x\\\"\\\\")) << "names come from the network: escaped";
}

TEST(Metrics, UnknownHasNoSeriesAndNoSeriesIsThereTwice) {
  const std::string text = text_of(snapshot());
  EXPECT_EQ(text.find("Nan"), std::string::npos);
  EXPECT_EQ(text.find("fathom_gps_receiver_outage_seconds{vehicle=\"auv\",receiver=\"stern"),
            std::string::npos);
  const std::string twice = "fathom_sensor_present{vehicle=\"auv\",sensor=\"actuator\"}";
  EXPECT_EQ(text.find(twice), text.rfind(twice));
}

TEST(Metrics, PromtoolHasNothingToSay) {
  if (!promtool_is_there()) GTEST_SKIP() << "promtool is not installed (Debian package prometheus)";
  std::string said;
  EXPECT_EQ(promtool(text_of(snapshot()), said), 0) << said;
  EXPECT_EQ(said, "");
  said.clear();
  EXPECT_NE(promtool("# TYPE a counter\na 1\n", said), 0) << "it does find what is wrong";
}

TEST(MetricsServer, AnswersScrapesThatPromtoolAccepts) {
  MetricsServer server([] { return snapshot(); });
  const int port = test::free_port(SOCK_STREAM);
  ASSERT_EQ(server.start("127.0.0.1", port), "");
  EXPECT_TRUE(server.running());
  const std::string answer = get(port, "/metrics");
  ASSERT_TRUE(answer.starts_with("HTTP/1.1 200")) << answer;
  EXPECT_NE(answer.find("fathom_healthy{vehicle=\"auv\"} 1\n"), std::string::npos);
  EXPECT_TRUE(get(port, "/etc/hostname").starts_with("HTTP/1.0 404")) << get(port, "/etc/hostname");
  if (!promtool_is_there()) GTEST_SKIP() << "promtool is not installed (Debian package prometheus)";
  std::string said;
  EXPECT_EQ(promtool(answer.substr(answer.find("\r\n\r\n") + 4), said), 0) << said;
  EXPECT_EQ(said, "");
}

TEST(MetricsServer, ConnectionsThatSayNothingHoldUpNoScrape) {
  MetricsServer server([] { return snapshot(); });
  const int port = test::free_port(SOCK_STREAM);
  ASSERT_EQ(server.start("127.0.0.1", port), "");
  std::vector<int> idle;
  for (int i = 0; i < 60; ++i) {
    idle.push_back(connected(port));
    ASSERT_GE(idle.back(), 0);
    if (i % 2 == 0) continue;
    ASSERT_EQ(send(idle.back(), "GET /met", 8, 0), 8) << "half a request is none";
  }
  ASSERT_TRUE(get(port, "/metrics").starts_with("HTTP/1.1 200")) << "no answer within a minute";
  for (const int one : idle) {
    char byte = 0;
    errno = 0;
    while (recv(one, &byte, 1, 0) > 0) continue;  // of the half requests one is told what it lacks
    ASSERT_NE(errno, EAGAIN) << "it was not let go within a minute";
    close(one);
  }
}

TEST(MetricsServer, ATakenPortIsSaidAndCanBeTriedAgain) {
  const int port = test::free_port(SOCK_STREAM);
  auto first = std::make_unique<MetricsServer>([] { return snapshot(); });
  ASSERT_EQ(first->start("127.0.0.1", port), "");
  MetricsServer second([] { return snapshot(); });
  const std::string trouble = second.start("127.0.0.1", port);
  EXPECT_NE(trouble.find("127.0.0.1:" + std::to_string(port)), std::string::npos) << trouble;
  EXPECT_FALSE(second.running());
  first.reset();
  EXPECT_EQ(second.start("127.0.0.1", port), "");
  EXPECT_NE(get(port, "/metrics").find("fathom_healthy"), std::string::npos);
  MetricsServer elsewhere([] { return snapshot(); });
  EXPECT_NE(elsewhere.start("203.0.113.1", port), "") << "not an address of this host";
}

}  // namespace
}  // namespace fathom::monitor
