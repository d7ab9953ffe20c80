#include "console/site.hpp"

#include <filesystem>
#include <fstream>
#include <map>
#include <stdexcept>

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "console/assets.hpp"

namespace fathom::console {
namespace {

constexpr const char* kOperatorToken = "0123456789abcdef";
constexpr const char* kViewer = "fedcba9876543210";
constexpr const char* kUnknown = "0000000000000000";

/// A site over a folder of tiles in which there is the one that the table of routes names.
class SiteTest : public ::testing::Test {
 protected:
  void SetUp() override {
    tiles = std::filesystem::temp_directory_path() / ("fathom-site-" + std::to_string(getpid()));
    std::filesystem::create_directories(tiles / "12/3456");
    std::ofstream(tiles / "12/3456/789.png") << "PNG";
    std::ofstream(tiles.string() + ".png") << "outside";
  }
  void TearDown() override {
    std::filesystem::remove_all(tiles);
    std::filesystem::remove(tiles.string() + ".png");
  }

  Answer ask(const std::string& method, const std::string& path, const std::string& token = "",
             const std::string& peer = "10.0.0.1") {
    Request request;
    request.method = method;
    request.path = path;
    if (!token.empty()) request.authorization = "Bearer " + token;
    request.if_none_match = if_none_match;
    request.body = R"({"kind": "realign"})";
    return site().answer(request, peer);
  }
  Site site() {
    Site::Options options;
    options.title = "auv";
    options.orders_enabled = true;
    options.view_needs_token = view_needs_token;
    options.tiles_dir = tiles.string();
    options.waypoints_json = "[]";
    options.tokens = TokenBook::parse(
        std::string(R"({"tokens": [{"name": "bridge", "role": "operator", "token": ")") + kOperatorToken +
        R"("}, {"name": "guest", "role": "viewer", "token": ")" + kViewer + R"("}]})");
    return {options,
            {[] { return std::string("{}"); },
             [](const std::string& body, const Identity& who, const std::string&) {
               return judge_order(body, who, true);
             },
             [this](const Refusal& refusal, const std::string&) { ++refused[refusal.reason]; }},
            events};
  }

  bool view_needs_token = true;
  std::string if_none_match;
  std::filesystem::path tiles;
  std::map<std::string, int> refused;
  FanOut events{{3, 10, 4}};
};

TEST_F(SiteTest, EveryRouteObeysItsNeed) {
  for (const Site::Route& route : Site::routes()) {
    const std::string method(route.method);
    const std::string path(route.example);
    const auto status = [&](const char* token) { return ask(method, path, token).status; };
    EXPECT_EQ(status(kOperatorToken), 200) << path;
    view_needs_token = false;
    EXPECT_EQ(status(""), route.need == Site::Need::order ? 401 : 200) << path;
    EXPECT_EQ(status(kUnknown), route.need == Site::Need::nothing ? 200 : 401) << path;
    view_needs_token = true;
    EXPECT_EQ(status(""), route.need == Site::Need::nothing ? 200 : 401) << path;
    EXPECT_EQ(status(kUnknown), route.need == Site::Need::nothing ? 200 : 401) << path;
    EXPECT_EQ(status(kViewer), route.need == Site::Need::order ? 403 : 200) << path;
    if (route.method != "GET") continue;
    EXPECT_EQ(ask("HEAD", path).status, status("")) << path << ": asking for less needs no less";
  }
  EXPECT_GT(refused["no_token"], 0);
  EXPECT_GT(refused["wrong_token"], 0);
}

TEST_F(SiteTest, WithoutATokenNothingIsReachedButTheFilesCompiledIn) {
  for (const Site::Route& route : Site::routes()) {
    EXPECT_TRUE(route.need != Site::Need::nothing || route.path == "/") << route.path;
  }
  for (const Asset& asset : assets()) EXPECT_EQ(ask("GET", std::string(asset.path)).asset, asset.bytes);
  EXPECT_EQ(ask("GET", "/").asset, find_asset("/index.html")->bytes);
  for (const char* path :
       {"/api/session", "/api/live", "/tiles/12/3456/789.png", "/tiles/1/1/1.png", "/tiles/", "/tiles/x"}) {
    EXPECT_EQ(ask("GET", path).status, 401) << path;
  }
  for (const char* path : {"/nothing", "/api/", "/api/order", "/tiles"})
    EXPECT_EQ(ask("GET", path).status, 404) << path;
  for (const char* path : {"/", "/api/live", "/api/session", "/tiles/12/3456/789.png"})
    EXPECT_EQ(ask("POST", path, kOperatorToken).status, 404) << path;
}

TEST_F(SiteTest, ATileThatIsAPipeIsNotWaitedFor) {
  ASSERT_EQ(mkfifo((tiles / "12/3456/790.png").c_str(), 0600), 0);
  EXPECT_EQ(ask("GET", "/tiles/12/3456/790.png", kViewer).status, 404);
}

TEST_F(SiteTest, TilesComeFromTheirFolderOnly) {
  const Answer tile = ask("GET", "/tiles/12/3456/789.png", kViewer);
  EXPECT_EQ(tile.content(), "PNG");
  EXPECT_EQ(tile.type, "image/png");
  EXPECT_NE(tile.cache.find("private"), std::string::npos);
  view_needs_token = false;
  EXPECT_EQ(ask("GET", "/tiles/12/3456/789.png").cache.find("private"), std::string::npos);
  for (const char* path :
       {"/tiles/12/3456/789", "/tiles/12/3456.png", "/tiles/12/3456/.png", "/tiles/.png", "/tiles.png",
        "/tiles/123/3456/789.png", "/tiles/12/12345678/789.png", "/tiles/12/3456/789/.png",
        "/tiles/12/../12/3456/789.png", "/tiles/12/3456/1.png"}) {
    EXPECT_EQ(ask("GET", path).status, 404) << path;
  }
}

TEST_F(SiteTest, AFileThatTheBrowserHasIsNotSentAgain) {
  const Asset* page = find_asset("/");
  for (const std::string& known : {std::string(page->etag), "\"other\", W/" + std::string(page->etag)}) {
    if_none_match = known;
    const Answer answer = ask("GET", "/");
    EXPECT_EQ(answer.status, 304);
    EXPECT_EQ(answer.etag, page->etag);
    EXPECT_TRUE(answer.content().empty());
    EXPECT_EQ(head_of(answer, true, false).find("Content-Length"), std::string::npos);
  }
  if_none_match = "\"other\"";
  EXPECT_EQ(ask("GET", "/").status, 200);
}

TEST_F(SiteTest, StreamsAreCountedByTokenElseByAddress) {
  view_needs_token = false;
  std::vector<Answer> open;
  const auto more = [&](const char* token, const char* peer) {
    open.push_back(ask("GET", "/api/live", token, peer));
    return open.back().status;
  };
  EXPECT_EQ(ask("HEAD", "/api/live").stream, nullptr) << "takes none";
  for (int i = 0; i < 4; ++i) EXPECT_EQ(more("", "10.0.0.1"), 200);
  EXPECT_EQ(more("", "10.0.0.1"), 429);
  EXPECT_EQ(refused["too_many_streams_of_one"], 1);
  EXPECT_EQ(more("", "10.0.0.2"), 200) << "another address";
  for (const char* peer : {"10.0.0.1", "10.0.0.2", "10.0.0.3", "10.0.0.4"})
    EXPECT_EQ(more(kViewer, peer), 200);
  EXPECT_EQ(more(kViewer, "10.0.0.5"), 429) << "the token is the same wherever it comes from";
  EXPECT_EQ(more(kOperatorToken, "10.0.0.1"), 200) << "another token";
  EXPECT_EQ(more(kOperatorToken, "10.0.0.9"), 503) << "all are taken";
  EXPECT_EQ(open.front().content(), "event: snapshot\ndata: {}\n\n");
}

TEST_F(SiteTest, WhatFailsIsSaidAndCounted) {
  const Site broken(Site::Options{},
                    {[]() -> std::string { throw std::runtime_error("secret"); }, nullptr,
                     [this](const Refusal& refusal, const std::string&) { ++refused[refusal.reason]; }},
                    events);
  Request request;
  request.method = "GET";
  request.path = "/api/live";
  const Answer answer = broken.answer(request, "10.0.0.1");
  EXPECT_EQ(answer.status, 500);
  EXPECT_EQ(answer.body.find("secret"), std::string::npos);
  EXPECT_EQ(refused["failed"], 1);
  EXPECT_EQ(events.clients(), 0U);
}

TEST(Answer, CarriesTheGuardsInEveryHead) {
  Answer answer;
  answer.body = "{}";
  const std::string head = head_of(answer, true, false);
  EXPECT_TRUE(head.starts_with("HTTP/1.1 200 OK\r\n")) << head;
  EXPECT_TRUE(head.ends_with("\r\n\r\n")) << head;
  EXPECT_NE(head.find("Content-Length: 2\r\n"), std::string::npos) << head;
  EXPECT_EQ(head.find("Connection: close"), std::string::npos) << head;
  EXPECT_EQ(head.find("Strict-Transport-Security"), std::string::npos) << head;
  EXPECT_NE(head_of(answer, true, true).find("Strict-Transport-Security"), std::string::npos);
  EXPECT_NE(head_of(answer, false, false).find("Connection: close\r\n"), std::string::npos);
  const Answer refusal = answer_to({405, "method"});
  const std::string refused = head_of(refusal, false, false);
  EXPECT_NE(refused.find("Allow: GET, HEAD, POST\r\n"), std::string::npos) << refused;
  EXPECT_EQ(refusal.body, "Method Not Allowed: method\n");
  for (const std::string& text : {head, refused}) {
    for (const char* guard :
         {"Content-Security-Policy: default-src 'none'", "X-Content-Type-Options: nosniff",
          "X-Frame-Options: DENY", "Cache-Control: no-store"})
      EXPECT_NE(text.find(guard), std::string::npos) << text;
  }
}

}  // namespace
}  // namespace fathom::console
