#include "console/request.hpp"

#include <algorithm>

#include <gtest/gtest.h>

namespace fathom::console {
namespace {

const HostNames kHosts = host_names("127.0.0.1", 8420, {"Console.Ship"});

/// 0: it would be served.
int judged(const std::string& bytes, bool secure = false) {
  const auto parsed = parse_head(bytes);
  if (const auto* refusal = std::get_if<Refusal>(&parsed)) return refusal->status;
  const auto refusal = judge_request(std::get<RequestHead>(parsed), kHosts, secure);
  return refusal ? refusal->status : 0;
}

std::string get(const std::string& target, const std::string& more = "") {
  return "GET " + target + " HTTP/1.1\r\nHost: 127.0.0.1:8420\r\n" + more + "\r\n";
}

std::string post(const std::string& more) {
  return "POST /api/order HTTP/1.1\r\nHost: localhost:8420\r\nContent-Type: application/json\r\n" + more +
         "\r\n";
}

TEST(Request, WhatABrowserSendsIsServed) {
  EXPECT_EQ(judged(get("/")), 0);
  EXPECT_EQ(judged(get("/js/main.js?v=1", "Accept: */*\r\nAccept: text/html\r\nUser-Agent: a (b; c)\r\n")),
            0);
  EXPECT_EQ(judged(get("/tiles/12/3456/789.png")), 0);
  EXPECT_EQ(judged("GET / HTTP/1.0\r\nHost: console.ship\r\n\r\n"), 0);
  EXPECT_EQ(judged("HEAD / HTTP/1.1\r\nhost:CONSOLE.SHIP:8420\r\n\r\n"), 0);
  EXPECT_EQ(
      judged(post("Origin: http://localhost:8420\r\nSec-Fetch-Site: same-origin\r\nContent-Length: 10\r\n")),
      0);
}

TEST(Request, WhereThereIsTlsAnOrderComesByIt) {
  const std::string body = "Content-Length: 10\r\n";
  EXPECT_EQ(judged(post("Origin: https://localhost:8420\r\n" + body), true), 0);
  EXPECT_EQ(judged(post("Origin: http://localhost:8420\r\n" + body), true), 403)
      << "a page that somebody on the way made up";
  EXPECT_EQ(judged(post("Origin: https://localhost:8420\r\n" + body), false), 0) << "behind a proxy with TLS";
}

TEST(Request, OnTheUsualPortBrowsersLeaveItOut) {
  const auto has = [](const HostNames& names, const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  EXPECT_TRUE(has(host_names("192.168.2.5", 443, {}), "192.168.2.5"));
  EXPECT_TRUE(has(host_names("192.168.2.5", 443, {}), "192.168.2.5:443"));
  EXPECT_TRUE(has(host_names("127.0.0.1", 80, {}), "localhost"));
  EXPECT_FALSE(has(host_names("127.0.0.1", 8420, {}), "localhost"));
}

TEST(Request, TheHeadIsReadAsItIs) {
  const auto parsed =
      parse_head(post("Content-Length: 12\r\nConnection: close\r\nAuthorization: bearer  abc \r\n"));
  const auto& head = std::get<RequestHead>(parsed);
  EXPECT_EQ(head.method, "POST");
  EXPECT_EQ(head.path, "/api/order");
  EXPECT_EQ(head.content_length, 12U);
  EXPECT_FALSE(head.keep_alive);
  EXPECT_EQ(head.bearer(), "abc");
  EXPECT_EQ(head.header("host"), "localhost:8420");
}

TEST(Request, AwkwardPathsLeadNowhere) {
  for (const char* path : {"/../etc/passwd", "/js/../../etc/passwd", "/%2e%2e/etc/passwd", "/..%2fetc",
                           "//etc/passwd", "/.git/config", "/a\\b", "/js/.", "http://other/", "*", "/a b"}) {
    EXPECT_EQ(judged(get(path)), 400) << path;
  }
  EXPECT_EQ(judged(get("/" + std::string(300, 'a'))), 414);
}

TEST(Request, MalformedOnesAreRefusedRatherThanUnderstood) {
  for (const char* bytes :
       {"", "\r\n\r\n", "GET\r\n\r\n", "GET /\r\n\r\n", "GET  HTTP/1.1\r\n\r\n", "G\x01T / HTTP/1.1\r\n\r\n",
        "GET / HTTP/1.1\r\nHost: a\r\n folded\r\n\r\n", "GET / HTTP/1.1\r\nno colon\r\n\r\n",
        "GET / HTTP/1.1\r\n: empty\r\n\r\n", "GET / HTTP/1.1\r\nHost : a\r\n\r\n",
        "GET / HTTP/1.1\r\nHost: a\r\nHost: b\r\n\r\n", "GET / HTTP/1.1\r\nX: a\x01\r\n\r\n",
        "GET / HTTP/1.1\r\n\r\n"}) {
    EXPECT_EQ(judged(bytes), 400) << bytes;
  }
  EXPECT_EQ(judged("GET / HTTP/2.0\r\nHost: a\r\n\r\n"), 505);
  EXPECT_EQ(judged(get("/", "Expect: 100-continue\r\n")), 417);
  std::string many;
  for (int i = 0; i < 100; ++i) many += "X-" + std::to_string(i) + ": 1\r\n";
  EXPECT_EQ(judged(get("/", many)), 431);
}

TEST(Request, LengthsThatCannotBeAreRefused) {
  const std::string own = "Origin: http://localhost:8420\r\n";
  EXPECT_EQ(judged(post(own + "Content-Length: 65537\r\n")), 413);
  EXPECT_EQ(judged(post(own + "Content-Length: 99999999999999999999999\r\n")), 413);
  EXPECT_EQ(judged(post(own + "Content-Length: -1\r\n")), 400);
  EXPECT_EQ(judged(post(own + "Content-Length: 12x\r\n")), 400);
  EXPECT_EQ(judged(post(own + "Content-Length: 1\r\nContent-Length: 2\r\n")), 400);
  EXPECT_EQ(judged(post(own + "Transfer-Encoding: chunked\r\n")), 411);
  EXPECT_EQ(judged(get("/", "Content-Length: 5\r\n")), 400);
}

TEST(Request, OtherSitesAreKeptOut) {
  EXPECT_EQ(judged("GET / HTTP/1.1\r\nHost: evil.example\r\n\r\n"), 421);
  EXPECT_EQ(judged("GET / HTTP/1.1\r\nHost: 127.0.0.1:9999\r\n\r\n"), 421);
  EXPECT_EQ(judged(post("")), 403) << "no origin";
  EXPECT_EQ(judged(post("Origin: http://evil.example\r\n")), 403);
  EXPECT_EQ(judged(post("Origin: null\r\n")), 403);
  EXPECT_EQ(judged(post("Origin: http://127.0.0.1:8420\r\n")), 403) << "not the host that was asked";
  EXPECT_EQ(judged(post("Origin: http://localhost:8420\r\nSec-Fetch-Site: cross-site\r\n")), 403);
  EXPECT_EQ(judged(get("/api/live", "Sec-Fetch-Site: cross-site\r\n")), 403);
  EXPECT_EQ(judged("POST / HTTP/1.1\r\nHost: localhost:8420\r\nOrigin: "
                   "http://localhost:8420\r\nContent-Type: text/plain\r\n\r\n"),
            415);
  EXPECT_EQ(judged("DELETE / HTTP/1.1\r\nHost: localhost:8420\r\n\r\n"), 405);
}

}  // namespace
}  // namespace fathom::console
