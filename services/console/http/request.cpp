#include "console/http/request.hpp"

#include <algorithm>
#include <array>

#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/string_body.hpp>

namespace fathom::console {
namespace {

namespace http = boost::beast::http;
using Parser = http::request_parser<http::string_body>;
using Fields = http::fields;

constexpr std::ptrdiff_t kMostHeaders = 64;
constexpr std::size_t kLongestPath = 256;

template <class Text>
std::string_view view(const Text& text) {
  return {text.data(), text.size()};
}

std::string lower(std::string_view text) {
  std::string out(text);
  for (char& c : out) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return out;
}

bool letter_or_digit(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
}

/// Nothing that the console serves has a name that needs more than this; what does is an attempt at
/// something.
bool plain_path(std::string_view path) {
  if (path.empty() || path.front() != '/') return false;
  char before = 'x';
  for (const char c : path) {
    const bool plain = letter_or_digit(c) || c == '.' || c == '_' || c == '-' || c == '/';
    if (!plain || (before == '/' && (c == '.' || c == '/'))) return false;
    before = c;
  }
  return true;
}

/// In the words of the console what the parser found. `head`: what came so far.
Refusal refusal_of(const boost::system::error_code& error, std::string_view head) {
  if (error == http::error::header_limit) return {431, "oversized_head"};
  if (error == http::error::body_limit) return {413, "oversized"};
  if (error == http::error::bad_version) {
    // Method, target and what could be a version; with more words in the line something else is wrong.
    const std::string_view line = head.substr(0, head.find("\r\n"));
    if (std::count(line.begin(), line.end(), ' ') == 2) return {505, "version"};
  }
  return {400, "malformed"};
}

std::optional<Refusal> judge_syntax(const Fields& fields, std::string_view head) {
  // The parser joins folded lines; the next program on the way may not.
  if (head.find("\r\n ") != std::string_view::npos || head.find("\r\n\t") != std::string_view::npos)
    return Refusal{400, "malformed"};
  if (std::distance(fields.begin(), fields.end()) > kMostHeaders) return Refusal{431, "oversized_head"};
  // Lists may be repeated; of what decides about the request there is one or the request is void.
  static constexpr std::array kOnce{http::field::host, http::field::content_length, http::field::origin,
                                    http::field::authorization, http::field::transfer_encoding};
  for (const http::field name : kOnce) {
    if (fields.count(name) > 1) return Refusal{400, "malformed"};
  }
  return std::nullopt;
}

/// How long the body is has to be said in one way only.
std::optional<Refusal> judge_length(const Fields& fields) {
  const auto encoding = fields.find(http::field::transfer_encoding);
  const auto length = fields.find(http::field::content_length);
  if (encoding != fields.end()) {
    const bool alone = length == fields.end() && !encoding->value().empty();
    return alone ? Refusal{411, "no_length"} : Refusal{400, "malformed"};
  }
  if (fields.count(http::field::expect) > 0) return Refusal{417, "expectation"};
  if (length == fields.end()) return std::nullopt;
  const std::string_view digits = view(length->value());  // the parser takes a list of equal ones as well
  if (digits.find_first_not_of("0123456789") != std::string_view::npos) return Refusal{400, "malformed"};
  return std::nullopt;
}

std::optional<Refusal> judge_path(std::string_view path) {
  if (path.size() > kLongestPath) return Refusal{414, "long_path"};
  if (!plain_path(path)) return Refusal{400, "path"};
  return std::nullopt;
}

std::optional<Refusal> judge_order(const Fields& fields, const std::string& host, bool secure) {
  const std::string origin = lower(view(fields[http::field::origin]));
  const bool ours = origin == "https://" + host || (!secure && origin == "http://" + host);
  const std::string_view site = view(fields["Sec-Fetch-Site"]);
  if (!ours || (!site.empty() && site != "same-origin")) return Refusal{403, "foreign_origin"};
  if (lower(view(fields[http::field::content_type])).substr(0, 16) != "application/json")
    return Refusal{415, "content_type"};
  return std::nullopt;
}

std::string_view path_of(std::string_view target) {
  return target.substr(0, target.find('?'));  // no page of the console takes a query
}

}  // namespace

std::string_view Request::bearer() const {
  static constexpr std::string_view kScheme = "bearer ";
  if (authorization.size() <= kScheme.size() || lower(authorization.substr(0, kScheme.size())) != kScheme)
    return {};
  std::string_view token = std::string_view(authorization).substr(kScheme.size());
  while (!token.empty() && token.front() == ' ') token.remove_prefix(1);
  return token;
}

HostNames host_names(const std::string& address, int port, const std::vector<std::string>& names) {
  const std::string suffix = ":" + std::to_string(port);
  HostNames out{"127.0.0.1" + suffix, "localhost" + suffix, "[::1]" + suffix};
  if (address != "0.0.0.0") out.push_back(lower(address) + suffix);
  if (port == 80 || port == 443) {  // browsers leave out the usual port
    for (std::size_t i = 0, count = out.size(); i < count; ++i) {
      out.push_back(out[i].substr(0, out[i].size() - suffix.size()));
    }
  }
  for (const std::string& name : names) {
    out.push_back(lower(name));  // behind a proxy on the usual port
    out.push_back(lower(name) + suffix);
  }
  return out;
}

struct RequestReader::Impl {
  Impl(const HostNames& hosts_in, bool secure_in) : hosts(hosts_in), secure(secure_in) {
    parser.header_limit(kMostHeadBytes);
    parser.body_limit(kMostBodyBytes);
  }

  State refuse(const Refusal& why) {
    refusal = why;
    return State::refused;
  }

  State take_head(std::string& bytes) {
    const std::string_view known = std::string_view(bytes).substr(0, kMostHeadBytes);
    boost::system::error_code error;
    while (!error && !parser.is_header_done() && parsed < known.size()) {
      parsed += parser.put({known.data() + parsed, known.size() - parsed}, error);
    }
    if (error && error != http::error::need_more) return refuse(refusal_of(error, known));
    if (!parser.is_header_done()) {
      // The parser's own limit starts anew with every line that comes alone.
      return known.size() < kMostHeadBytes ? State::needs_more : refuse({431, "oversized_head"});
    }
    if (const auto why = judge(known.substr(0, parsed))) return refuse(*why);
    bytes.erase(0, parsed);
    return State::complete;
  }

  State take_body(std::string& bytes) {
    while (!parser.is_done() && !bytes.empty()) {
      boost::system::error_code error;
      const std::size_t taken = parser.put({bytes.data(), bytes.size()}, error);
      bytes.erase(0, taken);
      if (error && error != http::error::need_more) return refuse(refusal_of(error, {}));
      if (taken == 0) break;
    }
    return parser.is_done() ? State::complete : State::needs_more;
  }

  /// Method, host and origin, once the head is whole.
  [[nodiscard]] std::optional<Refusal> judge(std::string_view head) const {
    const auto& message = parser.get();
    const std::string_view path = path_of(view(message.target()));
    for (const auto& why : {judge_syntax(message, head), judge_path(path), judge_length(message)}) {
      if (why) return why;
    }
    const http::verb method = message.method();
    if (method != http::verb::get && method != http::verb::head && method != http::verb::post)
      return Refusal{405, "method"};
    const std::string host = lower(view(message[http::field::host]));
    if (host.empty()) return Refusal{400, "malformed"};
    if (std::find(hosts.begin(), hosts.end(), host) == hosts.end()) return Refusal{421, "foreign_host"};
    if (method == http::verb::post) return judge_order(message, host, secure);
    if (path.starts_with("/api/") && view(message["Sec-Fetch-Site"]) == "cross-site")
      return Refusal{403, "foreign_origin"};
    if (!parser.is_done()) return Refusal{400, "malformed"};  // a body where none belongs
    return std::nullopt;
  }

  const HostNames& hosts;
  bool secure;
  Parser parser;
  std::size_t parsed = 0;  ///< bytes of the head that the parser has seen and does not want again
  Refusal refusal;
};

RequestReader::RequestReader(const HostNames& hosts, bool secure)
    : impl_(std::make_unique<Impl>(hosts, secure)) {}

RequestReader::~RequestReader() = default;

RequestReader::State RequestReader::take(std::string& bytes) {
  if (!impl_->parser.is_header_done()) {
    if (const State head = impl_->take_head(bytes); head != State::complete) return head;
  }
  return impl_->take_body(bytes);
}

bool RequestReader::head_is_whole() const {
  return impl_->parser.is_header_done();
}

const Refusal& RequestReader::refusal() const {
  return impl_->refusal;
}

Request RequestReader::request() {
  auto message = impl_->parser.release();
  Request out;
  out.method = view(message.method_string());
  out.path = path_of(view(message.target()));
  out.keep_alive = message.version() == 11 && message.keep_alive();
  out.authorization = view(message[http::field::authorization]);
  out.if_none_match = view(message[http::field::if_none_match]);
  out.body = std::move(message.body());
  return out;
}

}  // namespace fathom::console
