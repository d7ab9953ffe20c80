// What browsers and others send, up to the answer: the reader of requests with its limits, the routes,
// orders.
#include <algorithm>
#include <cctype>
#include <cstdio>
#include <cstdlib>
#include <set>
#include <string>
#include <vector>

#include "console/http/request.hpp"
#include "console/orders/orders.hpp"
#include "console/site.hpp"
#include "driver.hpp"

namespace fathom::console {
namespace {

constexpr const char* kToken = "0123456789abcdef";
constexpr std::size_t kMostRequests = 32;  // of one input

void expect(bool holds, const char* what) {
  if (holds) return;
  (void)std::fprintf(stderr, "http: %s\n", what);
  std::abort();
}

/// What became of one connection: each request that was served, and why it ended.
struct Conversation {
  std::vector<Request> requests;
  std::vector<std::string> raw;  ///< the bytes of each, when they came at once
  int refused = 0;               ///< status; 0: it was not
  std::string rest;
};

/// `piece`: bytes that come at a time.
Conversation converse(const std::string& bytes, std::size_t piece, bool secure) {
  static const HostNames kHosts = host_names("127.0.0.1", 8420, {"console.ship"});
  Conversation out;
  std::size_t at = 0;
  while (out.requests.size() < kMostRequests) {
    RequestReader reader(kHosts, secure);
    auto state = RequestReader::State::needs_more;
    const std::string before = out.rest.empty() ? bytes : out.rest;
    if (!out.rest.empty()) state = reader.take(out.rest);
    while (state == RequestReader::State::needs_more && at < bytes.size()) {
      out.rest.append(bytes, at, piece);
      at += piece;
      state = reader.take(out.rest);
      expect(out.rest.size() <= kMostHeadBytes + piece, "more is kept than a head may have");
    }
    if (state == RequestReader::State::needs_more) return out;
    if (state == RequestReader::State::refused) {
      out.refused = reader.refusal().status;
      static const std::set<int> kKnown{400, 403, 405, 411, 413, 414, 415, 417, 421, 431, 505};
      expect(kKnown.count(out.refused) == 1, "a status that is none of a refusal");
      expect(!answer_to(reader.refusal()).body.empty(), "a refusal without words");
      return out;
    }
    out.requests.push_back(reader.request());
    out.raw.push_back(before.substr(0, before.size() - std::min(before.size(), out.rest.size())));
  }
  return out;
}

/// What a request that is let through may look like.
void expect_sound(const Request& request) {
  const std::string& method = request.method;
  expect(method == "GET" || method == "HEAD" || method == "POST", "another method");
  expect(request.path.starts_with('/') && request.path.size() <= 256, "another path");
  expect(request.path.find("/.") == std::string::npos && request.path.find("//") == std::string::npos,
         "a path that may lead elsewhere");
  expect(request.body.size() <= kMostBodyBytes, "a body beyond its limit");
  expect(method == "POST" || request.body.empty(), "a body where none belongs");
}

/// Nobody on the way can have read it in another way. `raw`: its bytes.
void expect_one_length(const std::string& raw) {
  std::string head = raw.substr(0, raw.find("\r\n\r\n"));
  for (char& c : head) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  expect(head.find("\r\ntransfer-encoding:") == std::string::npos, "a transfer encoding");
  const std::size_t length = head.find("\r\ncontent-length:");
  expect(length == std::string::npos || head.find("\r\ncontent-length:", length + 1) == std::string::npos,
         "two lengths");
  expect(head.find("\r\n ") == std::string::npos && head.find("\r\n\t") == std::string::npos,
         "a folded line");
}

void expect_judged(const Request& request) {
  static FanOut events({4, 4, 2});
  static const TokenBook kTokens = TokenBook::parse(
      std::string(R"({"tokens": [{"name": "bridge", "role": "operator", "token": ")") + kToken + R"("}]})");
  static const Site kSite({"auv", true, true, "/nonexistent", "[]", kTokens},
                          {[] { return std::string("{}"); },
                           [](const std::string& body, const Identity& who, const std::string&) {
                             expect(who.role == Role::operator_ || !judge_order(body, who, true).order,
                                    "an order of a stranger");
                             return judge_order(body, who, true);
                           },
                           [](const Refusal&, const std::string&) {}},
                          events);
  const Answer answer = kSite.answer(request, "127.0.0.1");
  static const std::set<int> kKnown{200, 304, 400, 401, 404};
  expect(kKnown.count(answer.status) == 1, "a status that is none of an answer");
  const bool known = request.bearer() == kToken;
  const bool inside = request.path.starts_with("/api/") || request.path.starts_with("/tiles/");
  expect(known || !inside || answer.status >= 400, "the vehicle is shown to a stranger");
  const std::string head = head_of(answer, request.keep_alive, true);
  expect(head.find("\r\n\r\n") == head.size() - 4, "a head that ends elsewhere");
}

}  // namespace
}  // namespace fathom::console

std::string_view fathom::fuzz::target_name() {
  return "http";
}

std::vector<std::uint8_t> fathom::fuzz::target_seed() {
  const std::string to_us = " HTTP/1.1\r\nHost: 127.0.0.1:8420\r\n";
  const std::string known = std::string("Authorization: Bearer ") + console::kToken + "\r\n";
  const std::string order =
      R"({"kind": "set_position", "lat_deg": 36.4, "lon_deg": 1, "depth_m": 5, "sigma_m": 10})";
  const std::string all =
      "GET /" + to_us + "Accept: */*\r\nIf-None-Match: \"a\"\r\n\r\n" +  //
      "GET /api/session" + to_us + known + "Sec-Fetch-Site: same-origin\r\n\r\n" +
      "GET /tiles/12/3456/789.png?v=1" + to_us + known + "\r\n" +  //
      "POST /api/order" + to_us + known +
      "Origin: https://127.0.0.1:8420\r\nContent-Type: application/json\r\nContent-Length: " +
      std::to_string(order.size()) + "\r\n\r\n" + order +  //
      "GET /api/live" + to_us + known + "\r\n" +           //
      "POST /api/order" + to_us + "Origin: https://127.0.0.1:8420\r\nContent-Type: application/json\r\n" +
      "Transfer-Encoding: chunked\r\nContent-Length: 7\r\nConnection: close\r\n\r\n2\r\n{}\r\n0\r\n\r\n";
  return {all.begin(), all.end()};
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace fathom::console;
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  const bool secure = size % 2 == 0;
  const Conversation whole = converse(bytes, std::max<std::size_t>(size, 1), secure);
  for (const Request& request : whole.requests) {
    expect_sound(request);
    expect_judged(request);
  }
  for (const std::string& raw : whole.raw) expect_one_length(raw);
  // However the bytes are cut on the way, the same requests come of them.
  const Conversation cut = converse(bytes, 1 + size % 40, secure);
  expect(cut.requests.size() == whole.requests.size(), "in pieces it is another number of requests");
  for (std::size_t i = 0; i < cut.requests.size(); ++i) {
    expect(cut.requests[i].path == whole.requests[i].path && cut.requests[i].body == whole.requests[i].body &&
               cut.requests[i].authorization == whole.requests[i].authorization,
           "in pieces it is another request");
  }
  return 0;
}
