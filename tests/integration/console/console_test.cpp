#include <cmath>
#include <set>

#include "base/units.hpp"
#include "bus/reader.hpp"
#include "bus/writer.hpp"
#include "console_fixture.hpp"
#include "samples/position/fix.hpp"
#include "samples/verdict.hpp"
#include "support/paths.hpp"

namespace fathom::test {
namespace {

using nlohmann::json;
const std::string kLive = "GET /api/live HTTP/1.1\r\nConnection: close\r\nHost: ";

TEST_F(ConsoleTest, ThePageComesWholeAndWithItsGuards) {
  start_and_wait(10);
  const HttpAnswer page = get("/");
  for (const char* header :
       {"Content-Security-Policy: default-src 'none'; script-src 'self'", "frame-ancestors 'none'",
        "X-Content-Type-Options: nosniff", "Referrer-Policy: no-referrer", "Cache-Control: no-cache",
        "Content-Type: text/html", "ETag: "}) {
    EXPECT_NE(page.head.find(header), std::string::npos) << header << "\n" << page.head;
  }
  // Every file that the page names is there.
  std::set<std::string> files;
  for (const char* mark : {"src=\"", "href=\"/"}) {
    for (std::size_t at = page.body.find(mark); at != std::string::npos; at = page.body.find(mark, at + 1)) {
      const std::size_t from = page.body.find('"', at) + 1;
      files.insert(page.body.substr(from, page.body.find('"', from) - from));
    }
  }
  EXPECT_GE(files.size(), 8U);
  for (const std::string& file : files) EXPECT_EQ(get(file).status, 200) << file;
  EXPECT_EQ(page.body.find("http://"), std::string::npos) << "nothing from elsewhere";

  const std::size_t etag = page.head.find("ETag: ") + 6;
  const std::string known = page.head.substr(etag, page.head.find("\r\n", etag) - etag);
  EXPECT_EQ(get("/", "If-None-Match: " + known + "\r\n").status, 304);
  EXPECT_EQ(get("/nothing.js").status, 404);
  EXPECT_NE(get("/nothing.js").head.find("nosniff"), std::string::npos);
}

TEST_F(ConsoleTest, ABrowserSeesWhatDdsSays) {
  start_and_wait(11);
  HttpPeer peer(port);
  peer.say(kLive + host() + "\r\n\r\n");
  const auto snapshot = peer.event("snapshot");
  ASSERT_TRUE(snapshot.has_value() && snapshot->is_object());
  keep_navigating(true);
  json tick;
  const auto next_until = [&](const std::function<bool()>& condition) {
    return wait_until(
        [&] {
          network->monitor(true);
          network->life_sign("fusion");
          const auto event = peer.event("tick");
          if (!event || !event->is_object()) return false;
          tick = *event;
          return condition();
        },
        kPatienceS);
  };
  ASSERT_TRUE(next_until([&] { return tick["trust"]["level"] == "good"; })) << tick.dump();
  EXPECT_NEAR(tick["status"]["navigation"]["lat_deg"].get<double>(), 0.6 / kRadPerDeg, 1e-9);
  EXPECT_NEAR(tick["status"]["navigation"]["lon_deg"].get<double>(), 2.2 / kRadPerDeg, 1e-9);
  EXPECT_GT(tick["tick"].get<std::int64_t>(), (*snapshot)["tick"].get<std::int64_t>());

  network->alarm("gps_outage", true);
  EXPECT_TRUE(next_until([&] { return tick["status"]["alarms"].size() == 1; }));
  EXPECT_TRUE(next_until([&] {
    network->gps(true);  // again and again: what is said before the two have found each other is lost
    return !tick["fixes"].empty();
  }));

  // The last state becomes older and older; nobody else has to say so.
  keep_navigating(false);
  EXPECT_TRUE(
      next_until([&] { return tick["trust"]["sentence"].get<std::string>().starts_with("No navigation"); }));
  const double age_s = tick["status"]["navigation"]["age_s"].get<double>();
  RecordProperty("no_navigation_after_s", std::to_string(age_s));

  // Somebody who comes now gets what was before.
  HttpPeer later(port);
  later.say(kLive + host() + "\r\n\r\n");
  const auto history = later.event("snapshot");
  ASSERT_TRUE(history.has_value());
  EXPECT_GE((*history)["nav"].size(), 1U);
  EXPECT_GE((*history)["fixes"].size(), 1U);
}

TEST_F(ConsoleTest, APositionFarAwayAsksForItsConfirmation) {
  start_and_wait(9, {"access.orders=true"});
  std::mutex mutex;
  std::vector<Command> heard;
  const bus::Reader<Command> ear(network->participant(), [&](const Command& command, const bus::SampleInfo&) {
    const std::lock_guard lock(mutex);
    heard.push_back(command);
  });
  ASSERT_TRUE(wait_until([&] { return ear.matched_writers() > 1; }, kPatienceS));
  json far = {{"kind", "set_position"}, {"lat_deg", -20}, {"lon_deg", 10}, {"depth_m", 0}, {"sigma_m", 1}};
  const auto asks = [&] {
    network->nav();
    const HttpAnswer answer = order(far, kOperatorToken);
    EXPECT_EQ(answer.status, 200) << answer.body;
    return json::parse(answer.body)["confirm"].get<bool>();
  };
  // That the reader knows the writer does not say that the writer knows the reader.
  const auto asks_and_is_heard = [&] {
    if (!asks()) return false;
    const std::lock_guard lock(mutex);
    return !heard.empty();
  };
  ASSERT_TRUE(wait_until(asks_and_is_heard, kPatienceS))
      << "as soon as the console knows where the vehicle is";
  far["confirmed"] = true;
  EXPECT_FALSE(asks()) << "it is confirmed";
  ASSERT_TRUE(wait_until(
      [&] {
        const std::lock_guard lock(mutex);
        return !heard.empty() && heard.back().confirmed;
      },
      kPatienceS));
  const std::lock_guard lock(mutex);
  EXPECT_FALSE(heard.front().confirmed);
}

TEST_F(ConsoleTest, OrdersNeedAnOperatorAndLeaveATrace) {
  start_and_wait(12, {"access.orders=true"});
  std::mutex mutex;
  std::vector<Command> heard;
  const bus::Reader<Command> ear(network->participant(), [&](const Command& command, const bus::SampleInfo&) {
    const std::lock_guard lock(mutex);
    heard.push_back(command);
  });
  ASSERT_TRUE(wait_until([&] { return ear.matched_writers() > 1; }, kPatienceS))
      << "the console's and the network's own";
  const json acknowledge = {{"kind", "acknowledge_alarm"}, {"target", "gps_outage"}};
  EXPECT_EQ(order(acknowledge, "").status, 401);
  EXPECT_EQ(order(acknowledge, "wrong-0123456789012").status, 401);
  EXPECT_EQ(order(acknowledge, kViewerToken).status, 403);
  EXPECT_EQ(order({{"kind", "self_destruct"}}, kOperatorToken).status, 400);
  // What is written before reader and writer have found each other is lost: an operator would press again.
  ASSERT_TRUE(wait_until(
      [&] {
        const HttpAnswer taken = order(acknowledge, kOperatorToken);
        EXPECT_EQ(taken.status, 200) << taken.body;
        const std::lock_guard lock(mutex);
        return !heard.empty();
      },
      kPatienceS));
  const std::lock_guard lock(mutex);
  for (const Command& command : heard)
    EXPECT_EQ(command.header.sensor, Name("console:bridge")) << "no refused one";
  EXPECT_EQ(heard[0].kind, CommandKind::acknowledge_alarm);
  EXPECT_EQ(heard[0].target, Name("gps_outage"));
  EXPECT_EQ(heard[0].header.sensor, Name("console:bridge"));
  EXPECT_EQ(heard[0].header.vehicle, Name("auv"));
  EXPECT_TRUE(
      console->says("passed on an order of bridge (operator) from 127.0.0.1: acknowledge_alarm gps_outage"))
      << console->err();
  EXPECT_TRUE(console->says("refused an order of guest (viewer)")) << console->err();
  const std::string log = console->err();
  for (const char* secret : {kOperatorToken, kViewerToken, "wrong-0123456789012"}) {
    EXPECT_EQ(log.find(secret), std::string::npos) << "tokens stay out of the log";
  }
}

TEST_F(ConsoleTest, WhoTellsAPositionHearsWhatNavigationSaysToIt) {
  start_and_wait(12, {"access.orders=true"});
  json fix = {{"kind", "fix"}, {"lat_deg", 34}, {"lon_deg", 126}, {"sigma_m", 20}, {"from", "nobody"}};
  EXPECT_EQ(order(fix, "").status, 401);
  const HttpAnswer unheard = order(fix, kOperatorToken);
  EXPECT_EQ(unheard.status, 202) << unheard.body;
  EXPECT_NE(unheard.body.find("Told by bridge: fix of nobody"), std::string::npos) << unheard.body;
  bus::Writer<Verdict> verdicts(network->participant());
  const bus::Reader<FixSample> navigation(network->participant(), [&](const FixSample& told,
                                                                      const bus::SampleInfo&) {
    Verdict verdict;
    verdict.header = told.header;
    verdict.source = SourceKind::fix;
    verdict.kind = told.header.sensor == Name("operator") ? VerdictKind::used : VerdictKind::source_disabled;
    verdicts.write(verdict);
  });
  HttpAnswer refused;
  ASSERT_TRUE(wait_until([&] { return (refused = order(fix, kOperatorToken)).status != 202; }, kPatienceS));
  EXPECT_EQ(refused.status, 409) << refused.body;
  EXPECT_EQ(json::parse(refused.body)["verdict"], "source_disabled");
  fix.erase("from");
  const HttpAnswer used = order(fix, kOperatorToken);
  EXPECT_EQ(used.status, 200) << used.body;
  EXPECT_EQ(json::parse(used.body)["verdict"], "used");
  EXPECT_TRUE(console->says("; navigation says used")) << console->err();
  EXPECT_TRUE(
      console->says("refused an order of bridge (operator) from 127.0.0.1: Told by bridge: fix of nobody"))
      << console->err();
}

TEST_F(ConsoleTest, OrdersAreOffUnlessSwitchedOn) {
  start_and_wait(13);
  EXPECT_EQ(order({{"kind", "realign"}}, kOperatorToken).status, 403);
  const auto session =
      json::parse(get("/api/session", std::string("Authorization: Bearer ") + kOperatorToken + "\r\n").body);
  EXPECT_EQ(session["role"], "operator");
  EXPECT_EQ(session["orders"], false);
}

TEST_F(ConsoleTest, SeeingMayNeedATokenAsWell) {
  const auto tiles = std::filesystem::temp_directory_path() / ("fathom-tiles-" + std::to_string(getpid()));
  std::filesystem::create_directories(tiles / "3/2");
  std::ofstream(tiles / "3/2/1.png") << "PNG";
  start_and_wait(14, {"access.view_needs_token=true", "map.tiles_dir=" + tiles.string()});
  const std::string viewer = std::string("Authorization: Bearer ") + kViewerToken + "\r\n";
  EXPECT_EQ(get("/tiles/3/2/1.png").status, 401) << "where the vehicle is, tiles say as well";
  const HttpAnswer tile = get("/tiles/3/2/1.png", viewer);
  EXPECT_EQ(tile.status, 200);
  EXPECT_EQ(tile.body, "PNG");
  EXPECT_NE(tile.head.find("private"), std::string::npos) << "not for caches on the way";
  EXPECT_EQ(get("/tiles/3/2/2.png", viewer).status, 404);
  std::filesystem::remove_all(tiles);
  EXPECT_EQ(get("/").status, 200) << "the page itself says nothing";
  EXPECT_EQ(get("/api/session").status, 401);
  EXPECT_EQ(get("/api/live").status, 401);
  EXPECT_EQ(get("/api/live", "Authorization: Bearer wrong-0123456789012\r\n").status, 401);
  HttpPeer peer(port);
  peer.say(kLive + host() + "\r\nAuthorization: Bearer " + kViewerToken + "\r\n\r\n");
  EXPECT_TRUE(peer.event("snapshot").has_value());
}

TEST_F(ConsoleTest, APortThatIsTakenIsTriedAgain) {
  start(15);
  console->kill(SIGTERM);
  (void)console->wait();
  const int taken = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  const int on = 1;
  setsockopt(taken, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  ASSERT_EQ(bind(taken, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  ASSERT_EQ(listen(taken, 1), 0);
  network.reset();
  std::filesystem::remove(token_file);
  start(15);
  EXPECT_TRUE(console->says("cannot listen at 127.0.0.1")) << console->err();
  close(taken);
  EXPECT_TRUE(wait_until([&] { return get("/").status == 200; }, kPatienceS)) << console->err();
}

TEST(Console, ATokenFileThatOthersMayReadEndsIt) {
  const auto file =
      std::filesystem::temp_directory_path() / ("fathom-console-open-" + std::to_string(getpid()));
  std::ofstream(file) << "{}";
  chmod(file.c_str(), 0644);
  setenv("FATHOM_DDS_DIR", (source_dir() + "/deploy/dds").c_str(), 1);
  Process console("fathom-console", {"--config", source_dir() + "/deploy/config/console.json", "--set",
                                     "bus.domain=16", "--set", "access.token_file=" + file.string()});
  EXPECT_EQ(console.wait(), 2);
  EXPECT_NE(console.err().find("expected mode 0600"), std::string::npos) << console.err();
  std::filesystem::remove(file);
}

}  // namespace
}  // namespace fathom::test
