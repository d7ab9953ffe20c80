// The console by https: what browsers do over it, and what is refused.
#include <csignal>
#include <memory>
#include <mutex>
#include <vector>

#include "bus/reader.hpp"
#include "console_fixture.hpp"
#include "support/paths.hpp"

namespace fathom::test {
namespace {

using nlohmann::json;

class TlsTest : public ConsoleTest {
 protected:
  /// The console's own life sign.
  void listen() {
    ear = std::make_unique<bus::Reader<ServiceStatus>>(
        network->participant(), [this](const ServiceStatus& status, const bus::SampleInfo&) {
          if (status.header.sensor != Name("console")) return;
          const std::lock_guard lock(mutex);
          last = status;
        });
  }
  ServiceStatus status() {
    const std::lock_guard lock(mutex);
    return last;
  }
  std::uint64_t counter(const char* name) {
    for (const ServiceCounter& one : status().counters) {
      if (one.name == Name(name)) return one.value;
    }
    return 0;
  }
  [[nodiscard]] bool logged(const std::string& text) const {
    return console->err().find(text) != std::string::npos;
  }
  void TearDown() override {
    ear.reset();
    ConsoleTest::TearDown();
  }
  std::mutex mutex;
  ServiceStatus last;
  std::unique_ptr<bus::Reader<ServiceStatus>> ear;
};

TEST_F(TlsTest, PageLiveStreamAndOrdersGoThroughIt) {
  const Certificate own;
  use(own);
  start_and_wait(21, {"access.orders=true", "access.view_needs_token=true"});
  EXPECT_TRUE(console->says("console at https://127.0.0.1:" + std::to_string(port) + "/")) << console->err();
  EXPECT_FALSE(logged("in clear")) << console->err();
  const HttpAnswer page = get("/");
  EXPECT_EQ(page.status, 200);
  EXPECT_NE(page.head.find("Strict-Transport-Security: max-age="), std::string::npos) << page.head;
  EXPECT_NE(page.head.find("Content-Security-Policy: "), std::string::npos);
  EXPECT_NE(get("/../x").head.find("Strict-Transport-Security: max-age="), std::string::npos)
      << "a refusal as well";

  EXPECT_EQ(get("/api/session").status, 401);
  const auto session =
      json::parse(get("/api/session", std::string("Authorization: Bearer ") + kOperatorToken + "\r\n").body);
  EXPECT_EQ(session["role"], "operator");

  keep_navigating(true);
  const auto live = peer();
  live->say("GET /api/live HTTP/1.1\r\nHost: " + host() + "\r\nAuthorization: Bearer " + kViewerToken +
            "\r\n\r\n");
  ASSERT_TRUE(live->event("snapshot").has_value());
  std::int64_t before = 0;
  for (int i = 0; i < 30; ++i) {
    const auto tick = live->event("tick");
    ASSERT_TRUE(tick.has_value() && tick->is_object()) << i;
    EXPECT_GT((*tick)["tick"].get<std::int64_t>(), before);
    before = (*tick)["tick"].get<std::int64_t>();
  }

  EXPECT_EQ(order({{"kind", "realign"}}, kViewerToken).status, 403);
  EXPECT_EQ(order({{"kind", "realign"}}, "wrong-0123456789012").status, 401);
  EXPECT_EQ(order({{"kind", "realign"}}, kOperatorToken).status, 200);
  EXPECT_TRUE(console->says("passed on an order of bridge (operator) from 127.0.0.1")) << console->err();
  const std::string forged = "POST /api/order HTTP/1.1\r\nHost: " + host() + "\r\nOrigin: http://" + host() +
                             "\r\nContent-Type: application/json\r\nAuthorization: Bearer " + kOperatorToken +
                             "\r\nContent-Length: 18\r\n\r\n{\"kind\":\"realign\"}";
  EXPECT_EQ(ask(forged).status, 403) << "a page that came in clear is not the console's";
}

TEST_F(TlsTest, ItsBrowsersKeepTheirConnection) {
  const Certificate own;
  use(own);
  start_and_wait(22);
  const auto kept = peer();
  const std::string request = "GET /api/session HTTP/1.1\r\nHost: " + host() + "\r\n\r\n";
  kept->say(request + request);  // both in one record: the second is there before the first is answered
  kept->say("GET /api/session HTTP/1.1\r\nHost: " + host() + "\r\nConnection: close\r\n\r\n");
  std::string all = kept->hear().body;
  std::size_t answers = 1;
  for (std::size_t at = all.find("HTTP/1.1 200"); at != std::string::npos;
       at = all.find("HTTP/1.1 200", at + 1)) {
    ++answers;
  }
  EXPECT_EQ(answers, 3U) << all;
}

TEST_F(TlsTest, OnlyModernVersionsAreSpoken) {
  const Certificate own;
  use(own);
  start_and_wait(23);
  const HttpPeer newest(port, {own.certificate(), TLS1_3_VERSION});
  EXPECT_TRUE(newest.connected());
  EXPECT_EQ(newest.version(), "TLSv1.3");
  const HttpPeer floor(port, {own.certificate(), TLS1_2_VERSION});
  EXPECT_TRUE(floor.connected());
  EXPECT_EQ(floor.version(), "TLSv1.2");
  const HttpPeer old(port, {own.certificate(), TLS1_1_VERSION});
  EXPECT_FALSE(old.connected());
  EXPECT_TRUE(console->says("tls_handshake (400)")) << console->err();
  const Certificate another;
  EXPECT_FALSE(HttpPeer(port, {another.certificate()}).connected()) << "the test would notice a wrong one";
}

TEST_F(TlsTest, PlainHttpAndGarbageAreRefusedLoggedAndCounted) {
  const Certificate own;
  use(own);
  start_and_wait(24);
  listen();
  ASSERT_TRUE(wait_until([&] { return status().pid != 0; }, kPatienceS));
  const HttpAnswer plain = HttpPeer(port).exchange("GET / HTTP/1.1\r\nHost: " + host() + "\r\n\r\n");
  EXPECT_EQ(plain.status, 400);
  EXPECT_NE(plain.body.find("https"), std::string::npos) << "a person is told what to do";
  EXPECT_EQ(plain.head.find("Strict-Transport-Security"), std::string::npos) << "not to be said in clear";
  EXPECT_EQ(plain.body.find("<html"), std::string::npos);
  EXPECT_TRUE(console->says("plain_http (400)")) << console->err();
  EXPECT_EQ(HttpPeer(port).exchange(std::string(100000, '\x80')).status, 400);
  // What begins like a handshake and is none.
  (void)HttpPeer(port).exchange("\x16\x03\x01\xff\xff" + std::string(70000, 'z'));
  EXPECT_TRUE(console->says("tls_handshake (400)")) << console->err();
  EXPECT_TRUE(wait_until([&] { return counter("requests_refused") >= 3; }, kPatienceS));
  EXPECT_EQ(get("/").status, 200);
}

TEST_F(TlsTest, StalledHandshakesAreGivenUpAndOccupyNothing) {
  const Certificate own;
  use(own);
  start_and_wait(25, {"http.most_connections=12", "http.most_connections_per_peer=8", "http.most_streams=4"});
  std::vector<std::unique_ptr<HttpPeer>> stalled;
  for (int i = 0; i < 6; ++i) {
    stalled.push_back(std::make_unique<HttpPeer>(port));
    stalled.back()->say(
        std::string("\x16\x03\x01\x02\x00\x01\x00\x01\xfc", 9));  // of 512 bytes the first four
  }
  EXPECT_EQ(get("/").status, 200) << "nobody waits for them";
  for (const auto& one : stalled) EXPECT_EQ(one->hear().status, 0) << "closed by the console";
  EXPECT_TRUE(console->says("tls_too_slow (408)")) << console->err();
  EXPECT_EQ(get("/").status, 200);
  // One that gets through the handshake and then drips its head is given up as it is in clear.
  const auto slow = peer();
  slow->say("GET / HTTP/1.1\r\nHost: ");
  EXPECT_EQ(slow->hear().status, 408);
}

TEST_F(TlsTest, OneThatNeverReadsHarmsNobodyAndOneThatLeavesNeither) {
  const Certificate own;
  use(own);
  start_and_wait(26);
  keep_navigating(true);
  const std::string live = "GET /api/live HTTP/1.1\r\nHost: " + host() + "\r\n\r\n";
  const auto deaf = peer();
  deaf->say(live);
  for (int i = 0; i < 5; ++i) peer()->say(live);  // gone at once: what is written to it meets a broken pipe
  const auto quick = peer();
  quick->say(live);
  for (int i = 0; i < 100; ++i) ASSERT_TRUE(quick->event("tick").has_value()) << i;
  EXPECT_EQ(get("/").status, 200);
}

TEST_F(TlsTest, ACertificateThatEndsSoonIsWarnedOf) {
  const Certificate own(-300, 12);
  use(own);
  start_and_wait(27);
  listen();
  ASSERT_TRUE(
      wait_until([&] { return status().text.find("The TLS certificate expires in 1") != std::string::npos; },
                 kPatienceS))
      << status().text;
  EXPECT_EQ(status().state, ServiceState::healthy);
  EXPECT_GE(counter("certificate_days_left"), 11U);
  EXPECT_LE(counter("certificate_days_left"), 12U);
  EXPECT_TRUE(console->says("The TLS certificate expires in 1")) << console->err();
}

TEST_F(TlsTest, AnExpiredOneIsShownAllTheSameAndSaid) {
  const Certificate own(-300, -2);
  start(28, {"tls.certificate_file=" + own.certificate(), "tls.key_file=" + own.key()});
  listen();
  ASSERT_TRUE(wait_until([&] { return status().state == ServiceState::degraded; }, kPatienceS))
      << console->err();
  EXPECT_NE(status().text.find("expired at"), std::string::npos) << status().text;
  EXPECT_TRUE(console->says("The TLS certificate expired at")) << console->err();
  EXPECT_FALSE(HttpPeer(port, {own.certificate()}).connected()) << "whoever checks refuses it";
}

TEST_F(TlsTest, TokensInClearAreWarnedOf) {
  start(29, {"http.address=0.0.0.0", "access.orders=true"});
  EXPECT_TRUE(console->says("tokens pass over the network in clear"));
  EXPECT_TRUE(console->says("Set tls.certificate_file")) << console->err();
  listen();
  EXPECT_TRUE(wait_until(
      [&] { return status().text.find("tokens pass over the network") != std::string::npos; }, kPatienceS))
      << status().text;
}

/// `fathom-console --check` with these settings.
struct Check {
  explicit Check(const std::vector<std::string>& sets) {
    std::vector<std::string> arguments{"--check", "--config", source_dir() + "/deploy/config/console.json"};
    for (const std::string& set : sets) {
      arguments.emplace_back("--set");
      arguments.push_back(set);
    }
    Process process("fathom-console", arguments);
    code = process.wait();
    err = process.err();
  }
  int code = 0;
  std::string err;
};

TEST(TlsCheck, AcceptsWhatWillWork) {
  const Certificate own;
  const Check good({"tls.certificate_file=" + own.certificate(), "tls.key_file=" + own.key()});
  EXPECT_EQ(good.code, 0) << good.err;
  const Check plain({});
  EXPECT_EQ(plain.code, 0) << plain.err;
}

TEST(TlsCheck, RefusesWhatWillNotInOneLineThatSaysWhy) {
  const Certificate own;
  const Certificate other;
  const Certificate expired(-300, -2);
  const Certificate early(2, 300);
  struct Case {
    std::vector<std::string> sets;
    const char* key;
    const char* says;
  };
  const auto pair = [](const std::string& certificate, const std::string& key) {
    return std::vector<std::string>{"tls.certificate_file=" + certificate, "tls.key_file=" + key};
  };
  const std::vector<Case> cases{
      {pair("/nonexistent.pem", own.key()), "tls.certificate_file", "No such file"},
      {pair(own.certificate(), "/nonexistent.pem"), "tls.key_file", "No such file"},
      {pair(own.key(), own.key()), "tls.certificate_file", "expected a certificate"},
      {pair(own.certificate(), own.certificate()), "tls.key_file", "expected"},
      {pair(own.certificate(), other.key()), "tls.key_file", "is not the key of"},
      {pair(expired.certificate(), expired.key()), "tls.certificate_file", "expired at"},
      {pair(early.certificate(), early.key()), "tls.certificate_file", "not valid before"},
      {{"tls.certificate_file=" + own.certificate()}, "tls.key_file", "expected a file"},
      {{"tls.key_file=" + own.key()}, "tls.certificate_file", "expected a file"},
      {{"tls.cypher=none"}, "tls.cypher", "expected"},
      {{"access.token_file=/nonexistent"}, "access.token_file", "expected a token file"},
  };
  for (const Case& item : cases) {
    const Check check(item.sets);
    EXPECT_EQ(check.code, 2) << check.err;
    EXPECT_EQ(check.err.find("fathom-console: "), 0U) << check.err;
    EXPECT_NE(check.err.find("console.json"), std::string::npos) << check.err;
    EXPECT_NE(check.err.find(item.key), std::string::npos) << check.err;
    EXPECT_NE(check.err.find(item.says), std::string::npos) << check.err;
    EXPECT_EQ(check.err.find('\n'), check.err.size() - 1) << "one line: " << check.err;
  }
}

}  // namespace
}  // namespace fathom::test
