#include "console/http/request.hpp"

#include <algorithm>

#include <gtest/gtest.h>

namespace fathom::console {
namespace {

const HostNames kHosts = host_names("127.0.0.1", 8420, {"Console.Ship"});

constexpr int kServed = 0;
constexpr int kIncomplete = -1;

struct Judged {
  int status = kServed;
  std::string reason;
  Request request;
  std::string rest;  ///< of the bytes, behind the request
};

/// `piece`: as many bytes at a time.
Judged judge(const std::string& bytes, bool secure, std::size_t piece) {
  RequestReader reader(kHosts, secure);
  Judged out;
  auto state = RequestReader::State::needs_more;
  std::size_t at = 0;
  for (; at < bytes.size() && state == RequestReader::State::needs_more; at += piece) {
    out.rest += bytes.substr(at, piece);
    state = reader.take(out.rest);
  }
  if (at < bytes.size()) out.rest += bytes.substr(at);
  if (state == RequestReader::State::needs_more) out.status = kIncomplete;
  if (state == RequestReader::State::refused) out.status = reader.refusal().status;
  if (state == RequestReader::State::refused) out.reason = reader.refusal().reason;
  if (state == RequestReader::State::complete) out.request = reader.request();
  return out;
}

/// However it comes, a request is judged the same.
int judged(const std::string& bytes, bool secure = false) {
  const int whole = judge(bytes, secure, bytes.size() + 1).status;
  for (const std::size_t piece : {1, 2, 3, 7, 64}) {
    EXPECT_EQ(judge(bytes, secure, piece).status, whole) << "in pieces of " << piece << ": " << bytes;
  }
  return whole;
}

std::string get(const std::string& target, const std::string& more = "") {
  return "GET " + target + " HTTP/1.1\r\nHost: 127.0.0.1:8420\r\n" + more + "\r\n";
}

std::string post(const std::string& more) {
  return "POST /api/order HTTP/1.1\r\nHost: localhost:8420\r\nContent-Type: application/json\r\n" + more +
         "\r\n";
}

const std::string kTen = "0123456789";

TEST(Request, WhatABrowserSendsIsServed) {
  EXPECT_EQ(judged(get("/")), 0);
  EXPECT_EQ(judged(get("/js/main.js?v=1", "Accept: */*\r\nAccept: text/html\r\nUser-Agent: a (b; c)\r\n")),
            0);
  EXPECT_EQ(judged(get("/tiles/12/3456/789.png")), 0);
  EXPECT_EQ(judged("GET / HTTP/1.0\r\nHost: console.ship\r\n\r\n"), 0);
  EXPECT_EQ(judged("HEAD / HTTP/1.1\r\nhost:CONSOLE.SHIP:8420\r\n\r\n"), 0);
  EXPECT_EQ(judged(post("Origin: http://localhost:8420\r\nSec-Fetch-Site: same-origin\r\nContent-Length: "
                        "10\r\n") +
                   kTen),
            0);
}

TEST(Request, WhereThereIsTlsAnOrderComesByIt) {
  const std::string body = "Content-Length: 10\r\n";
  EXPECT_EQ(judged(post("Origin: https://localhost:8420\r\n" + body) + kTen, true), 0);
  EXPECT_EQ(judged(post("Origin: http://localhost:8420\r\n" + body) + kTen, true), 403)
      << "a page that somebody on the way made up";
  EXPECT_EQ(judged(post("Origin: https://localhost:8420\r\n" + body) + kTen, false), 0)
      << "behind a proxy with TLS";
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

TEST(Request, IsReadAsItIs) {
  const std::string bytes = post(
                                "Origin: http://localhost:8420\r\nContent-Length: 12\r\nConnection: close\r\n"
                                "If-None-Match: \"a\"\r\nAuthorization: bearer  abc \r\n") +
                            "{\"kind\": 12}GET / HT";
  for (const std::size_t piece : {1, 5, 1000}) {
    const auto [status, reason, request, rest] = judge(bytes, false, piece);
    EXPECT_EQ(status, kServed) << reason;
    EXPECT_EQ(request.method, "POST");
    EXPECT_EQ(request.path, "/api/order");
    EXPECT_EQ(request.body, "{\"kind\": 12}");
    EXPECT_FALSE(request.keep_alive);
    EXPECT_EQ(request.bearer(), "abc");
    EXPECT_EQ(request.if_none_match, "\"a\"");
    EXPECT_EQ(rest, "GET / HT") << "belongs to the next one";
  }
  EXPECT_TRUE(judge(get("/a?b=c"), false, 1000).request.keep_alive);
  EXPECT_EQ(judge(get("/a?b=c"), false, 1000).request.path, "/a");
  EXPECT_FALSE(judge("GET / HTTP/1.0\r\nHost: console.ship\r\nConnection: keep-alive\r\n\r\n", false, 1000)
                   .request.keep_alive);
}

TEST(Request, IsAwaitedUntilItIsWhole) {
  for (const char* bytes : {"", "GET", "GET / HTTP/1.1\r\n", "GET / HTTP/1.1\r\nHost: 127.0.0.1:8420\r\n"}) {
    EXPECT_EQ(judged(bytes), kIncomplete) << bytes;
  }
  EXPECT_EQ(judged(post("Origin: http://localhost:8420\r\nContent-Length: 3\r\n") + "{}"), kIncomplete);
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
       {"\r\n\r\n", "GET\r\n\r\n", "GET /\r\n\r\n", "GET  HTTP/1.1\r\n\r\n", "G\x01T / HTTP/1.1\r\n\r\n",
        "GET / HTTP/1.1\r\nHost: a\r\n folded\r\n\r\n", "GET / HTTP/1.1\r\nno colon\r\n\r\n",
        "GET / HTTP/1.1\r\n: empty\r\n\r\n", "GET / HTTP/1.1\r\nHost : a\r\n\r\n",
        "GET / HTTP/1.1\r\nHost: a\r\nHost: b\r\n\r\n", "GET / HTTP/1.1\r\nX: a\x01\r\n\r\n",
        "GET / HTTP/1.1\r\n\r\n", "GET / HTTP/1.1\nHost: a\n\r\n\r\n",
        "GET / HTTP/1.1\r\nHost: a\rX: b\r\n\r\n"}) {
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
  EXPECT_EQ(judged(post(own + "Content-Length: 99999999999999999999999\r\n")), 400);
  EXPECT_EQ(judged(post(own + "Content-Length: -1\r\n")), 400);
  EXPECT_EQ(judged(post(own + "Content-Length: 12x\r\n")), 400);
  EXPECT_EQ(judged(post(own + "Content-Length: 1\r\nContent-Length: 2\r\n")), 400);
  EXPECT_EQ(judged(post(own + "Transfer-Encoding: chunked\r\n")), 411);
  EXPECT_EQ(judged(get("/", "Content-Length: 5\r\n")), 400);
  EXPECT_EQ(judged(get("/", "Transfer-Encoding: chunked\r\n")), 411);
}

TEST(Request, ASecondWayToSayTheLengthIsRefused) {
  const std::string own = "Origin: http://localhost:8420\r\n";
  const std::string length = "Content-Length: 10\r\n";
  for (const char* encoding : {"", "chunked", "identity", "gzip", "x", "chunked, identity", ",", "\t"}) {
    const std::string line = std::string("Transfer-Encoding: ") + encoding + "\r\n";
    EXPECT_EQ(judged(post(own + line + length) + kTen), 400) << encoding;
    EXPECT_EQ(judged(post(own + length + line) + kTen), 400) << encoding;
    EXPECT_EQ(judged(post(own + line + line + length) + kTen), 400) << encoding;
    EXPECT_EQ(judged(post(own + line + line) + kTen), 400) << encoding;
    EXPECT_EQ(judged(get("/", line + length)), 400) << encoding;
  }
  EXPECT_EQ(judged(post(own + "Transfer-Encoding: \r\n") + kTen), 400);
  EXPECT_EQ(judged(post(own + "Transfer-Encoding:\r\n chunked\r\n" + length) + kTen), 400);
  for (const char* second : {"10", "2", "0", "", "10, 10", "+10", "0x0a", "1 0"}) {
    const std::string line = std::string("Content-Length: ") + second + "\r\n";
    EXPECT_EQ(judged(post(own + length + line) + kTen), 400) << second;
    EXPECT_EQ(judged(post(own + line + length) + kTen), 400) << second;
  }
  for (const char* only : {"10, 10", "10,2", "+10", "0x0a", "1 0", "10;"}) {
    EXPECT_EQ(judged(post(own + "Content-Length: " + only + "\r\n") + kTen), 400) << only;
  }
}

TEST(Request, AHeadThatNeverEndsIsRefusedWhereverItIsCut) {
  // Line by line as well: the limit is of the whole head.
  const std::string line = "X: " + std::string(95, 'x') + "\r\n";
  for (const std::size_t piece : {std::size_t{1}, line.size(), std::size_t{4096}, std::size_t{100000}}) {
    RequestReader reader(kHosts, false);
    std::string bytes;
    auto state = RequestReader::State::needs_more;
    std::string endless = "GET / HTTP/1.1\r\n";
    while (endless.size() < 3 * kMostHeadBytes) endless += line;
    std::size_t at = 0;
    for (; at < endless.size() && state == RequestReader::State::needs_more; at += piece) {
      bytes += endless.substr(at, piece);
      state = reader.take(bytes);
      ASSERT_LE(bytes.size(), kMostHeadBytes + piece);
    }
    EXPECT_EQ(state, RequestReader::State::refused) << piece;
    EXPECT_EQ(reader.refusal().status, 431) << piece;
    EXPECT_LE(at, kMostHeadBytes + piece);
  }
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
