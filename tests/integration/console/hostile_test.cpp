// Requests that no browser makes. Whatever they are, the console refuses them, counts them, and goes on.
#include <filesystem>
#include <memory>
#include <vector>

#include <sys/resource.h>

#include "bus/reader.hpp"
#include "console_fixture.hpp"
#include "support/process_usage.hpp"

namespace fathom::test {
namespace {

class HostileTest : public ConsoleTest {
 protected:
  /// Refusals as the console's own life sign counts them.
  std::uint64_t refused() {
    const std::lock_guard lock(mutex);
    return refused_;
  }
  void listen() {
    ear = std::make_unique<bus::Reader<ServiceStatus>>(
        network->participant(), [this](const ServiceStatus& status, const bus::SampleInfo&) {
          if (status.header.sensor != Name("console")) return;
          const std::lock_guard lock(mutex);
          for (const ServiceCounter& counter : status.counters) {
            if (counter.name == Name("requests_refused")) refused_ = counter.value;
          }
        });
  }
  void TearDown() override {
    ear.reset();
    ConsoleTest::TearDown();
  }
  std::mutex mutex;
  std::uint64_t refused_ = 0;
  std::unique_ptr<bus::Reader<ServiceStatus>> ear;
};

TEST_F(HostileTest, EachKindIsRefusedWithItsStatusLoggedAndCounted) {
  start_and_wait(17, {"access.orders=true"});
  listen();
  struct Attack {
    int status;
    const char* reason;
    std::string bytes;
  };
  const std::string to_us = "Host: " + host() + "\r\n";
  const std::string post = "POST /api/order HTTP/1.1\r\n" + to_us + "Content-Type: application/json\r\n";
  const std::string order =
      post + "Origin: http://" + host() + "\r\nAuthorization: Bearer " + kOperatorToken + "\r\n";
  const std::vector<Attack> attacks{
      {400, "path", "GET /../../etc/passwd HTTP/1.1\r\n" + to_us + "\r\n"},
      {400, "path", "GET /%2e%2e/%2e%2e/etc/passwd HTTP/1.1\r\n" + to_us + "\r\n"},
      {400, "path", "GET /tiles/1/2/..%2f..%2fetc.png HTTP/1.1\r\n" + to_us + "\r\n"},
      {414, "long_path", "GET /" + std::string(5000, 'a') + " HTTP/1.1\r\n" + to_us + "\r\n"},
      {431, "oversized_head", "GET / HTTP/1.1\r\n" + to_us + "X: " + std::string(40000, 'x') + "\r\n\r\n"},
      {431, "oversized_head", std::string(200000, 'z')},
      {413, "oversized",
       post + "Origin: http://" + host() + "\r\nContent-Length: 10000000\r\n\r\n" + std::string(300000, '{')},
      {411, "no_length", post + "Transfer-Encoding: chunked\r\n\r\nffffffff\r\n"},
      {400, "malformed", order + "Transfer-Encoding: \r\nContent-Length: 18\r\n\r\n{\"kind\":\"realign\"}"},
      {400, "malformed",
       order + "Transfer-Encoding: chunked\r\nContent-Length: 18\r\n\r\n{\"kind\":\"realign\"}"},
      {400, "malformed", order + "Content-Length: 18\r\nContent-Length: 2\r\n\r\n{\"kind\":\"realign\"}"},
      {400, "malformed", "\x16\x03\x01\x02\r\n\r\n"},
      {400, "malformed", "GET / HTTP/1.1\r\nHost: a\r\nHost: b\r\n\r\n"},
      {421, "foreign_host", "GET / HTTP/1.1\r\nHost: rebound.example\r\n\r\n"},
      {403, "foreign_origin", post + "Origin: http://evil.example\r\nContent-Length: 2\r\n\r\n{}"},
      {403, "foreign_origin", post + "Content-Length: 2\r\n\r\n{}"},
      {405, "method", "TRACE / HTTP/1.1\r\n" + to_us + "\r\n"},
      {401, "wrong_token",
       "GET /api/session HTTP/1.1\r\n" + to_us +
           "Connection: close\r\nAuthorization: Bearer wrong-0123456789012\r\n\r\n"},
  };
  for (const Attack& attack : attacks) {
    const HttpAnswer answer = ask(attack.bytes);
    EXPECT_EQ(answer.status, attack.status) << attack.reason << ": " << attack.bytes.substr(0, 100);
    EXPECT_NE(answer.head.find("nosniff"), std::string::npos);
    EXPECT_TRUE(console->says(std::string(": ") + attack.reason + " (")) << attack.reason << "\n"
                                                                         << console->err();
  }
  EXPECT_TRUE(wait_until([&] { return refused() >= attacks.size(); }, kPatienceS)) << refused();
  // Many more of one kind are one line a period, not one each.
  for (int i = 0; i < 200; ++i) EXPECT_EQ(ask(attacks[0].bytes).status, 400);
  EXPECT_EQ(get("/").status, 200);
  console->kill(SIGTERM);
  EXPECT_EQ(console->wait(), 0) << "and its log is complete";
  const std::string log = console->err();
  std::size_t lines = 0;
  for (std::size_t at = log.find(": path ("); at != std::string::npos; at = log.find(": path (", at + 1))
    ++lines;
  EXPECT_LT(lines, 100U);
}

TEST_F(HostileTest, SlowOnesAreGivenUp) {
  start_and_wait(18);
  HttpPeer silent(port);
  HttpPeer slow_head(port);
  slow_head.say("GET / HTTP/1.1\r\nHost: ");
  HttpPeer slow_body(port);
  slow_body.say("POST /api/order HTTP/1.1\r\nHost: " + host() + "\r\nOrigin: http://" + host() +
                "\r\nContent-Type: application/json\r\nContent-Length: 100\r\n\r\n{");
  EXPECT_EQ(get("/").status, 200) << "nobody waits for them";
  EXPECT_EQ(slow_head.hear().status, 408);
  EXPECT_EQ(slow_body.hear().status, 408);
  EXPECT_EQ(silent.hear().status, 0) << "closed without a word, as it came";
  EXPECT_TRUE(console->says("too_slow (408)")) << console->err();
}

TEST_F(HostileTest, TooManyConnectionsLeaveRoomLater) {
  start_and_wait(19, {"http.most_connections=12", "http.most_connections_per_peer=8", "http.most_streams=4"});
  std::vector<std::unique_ptr<HttpPeer>> crowd;
  for (int i = 0; i < 40; ++i) {
    crowd.push_back(std::make_unique<HttpPeer>(port));
    crowd.back()->say("GET /api/live HTTP/1.1\r\nHost: " + host() + "\r\n\r\n");
  }
  EXPECT_TRUE(console->says("too_many_connections (503)"));
  EXPECT_TRUE(console->says("too_many_clients (503)"));
  crowd.clear();
  EXPECT_TRUE(wait_until([&] { return get("/").status == 200; }, kPatienceS)) << console->err();
}

TEST_F(HostileTest, WithoutDescriptorsItWaitsForOneAtRest) {
  start_and_wait(33);
  const std::string descriptors = "/proc/" + std::to_string(console->pid()) + "/fd/";
  rlim_t free = 0;  // what it opens next
  while (std::filesystem::exists(std::filesystem::symlink_status(descriptors + std::to_string(free)))) ++free;
  const rlimit few{free + 4, free + 4};
  ASSERT_EQ(prlimit(console->pid(), RLIMIT_NOFILE, &few, nullptr), 0);
  std::vector<std::unique_ptr<HttpPeer>> silent;
  for (int i = 0; i < 40; ++i) silent.push_back(std::make_unique<HttpPeer>(port));
  ASSERT_TRUE(console->says("no_descriptors", kPatienceS)) << console->err();
  const double before_s = processor_s(console->pid());
  std::this_thread::sleep_for(std::chrono::seconds(2));  // a busy loop would take most of them
  EXPECT_LT(processor_s(console->pid()) - before_s, 0.8);
  silent.clear();
  EXPECT_TRUE(wait_until([&] { return get("/").status == 200; }, kPatienceS)) << console->err();
}

TEST_F(HostileTest, OneViewerLeavesStreamsToOthers) {
  start_and_wait(31, {"access.orders=true"});
  keep_navigating(true);
  const std::string live = "GET /api/live HTTP/1.1\r\nConnection: close\r\nHost: " + host() + "\r\n";
  std::vector<std::unique_ptr<HttpPeer>> crowd;
  for (int i = 0; i < 60; ++i) {
    crowd.push_back(std::make_unique<HttpPeer>(port));
    crowd.back()->say(live + "\r\n");
  }
  EXPECT_TRUE(console->says("too_many_streams_of_one (429)")) << console->err();
  HttpPeer elsewhere(port, 0, 2);
  elsewhere.say(live + "\r\n");
  EXPECT_TRUE(elsewhere.event("tick").has_value()) << "another address";
  // Whoever shows a token is counted by it: at the same address as the crowd, and from others as the same
  // one.
  std::vector<std::unique_ptr<HttpPeer>> signed_in;
  std::size_t served = 0;
  for (std::uint32_t i = 0; i < 20; ++i) {
    signed_in.push_back(std::make_unique<HttpPeer>(port, 0, 1 + i));
    signed_in.back()->say(live + "Authorization: Bearer " + kViewerToken + "\r\n\r\n");
    served += signed_in.back()->event("snapshot").has_value() ? 1 : 0;
  }
  EXPECT_EQ(served, 12U);
  HttpPeer operator_(port);
  operator_.say(live + "Authorization: Bearer " + kOperatorToken + "\r\n\r\n");
  EXPECT_TRUE(operator_.event("tick").has_value()) << "another token";
  // Who closes pages may open others.
  crowd.clear();
  EXPECT_TRUE(wait_until(
      [&] {
        HttpPeer again(port);
        again.say(live + "\r\n");
        return again.event("snapshot").has_value();
      },
      kPatienceS));
}

TEST_F(HostileTest, OneThatNeverReadsHarmsNobody) {
  start_and_wait(20);
  keep_navigating(true);
  HttpPeer deaf(port, 2048);
  HttpPeer quick(port);
  for (HttpPeer* peer : {&deaf, &quick}) peer->say("GET /api/live HTTP/1.1\r\nHost: " + host() + "\r\n\r\n");
  // Far more than fits into the deaf one's socket and queue.
  std::int64_t last = 0;
  for (int i = 0; i < 150; ++i) {
    const auto tick = quick.event("tick");
    ASSERT_TRUE(tick.has_value() && tick->is_object()) << i;
    EXPECT_GT((*tick)["tick"].get<std::int64_t>(), last);
    last = (*tick)["tick"].get<std::int64_t>();
  }
  EXPECT_EQ(get("/").status, 200);
}

}  // namespace
}  // namespace fathom::test
