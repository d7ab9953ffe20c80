#include "console/request.hpp"

#include <algorithm>
#include <charconv>
#include <set>

namespace fathom::console {
namespace {

constexpr std::size_t kMostHeaders = 64;
constexpr std::size_t kLongestPath = 256;

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

bool token(std::string_view text) {
  static constexpr std::string_view kMarks = "!#$%&'*+-.^_`|~";
  return !text.empty() && std::all_of(text.begin(), text.end(), [](char c) {
    return letter_or_digit(c) || kMarks.find(c) != std::string_view::npos;
  });
}

bool no_controls(std::string_view text) {
  return std::all_of(text.begin(), text.end(), [](char c) { return c == '\t' || (c >= ' ' && c != '\x7f'); });
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
  return text;
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

std::optional<Refusal> parse_request_line(std::string_view line, RequestHead& head) {
  const std::size_t first = line.find(' ');
  const std::size_t last = line.rfind(' ');
  if (first == std::string_view::npos || first == last) return Refusal{400, "malformed"};
  const std::string_view target = line.substr(first + 1, last - first - 1);
  const std::string_view version = line.substr(last + 1);
  head.method = line.substr(0, first);
  if (!token(head.method) || !no_controls(target) || target.find(' ') != std::string_view::npos) {
    return Refusal{400, "malformed"};
  }
  if (version != "HTTP/1.1" && version != "HTTP/1.0") return Refusal{505, "version"};
  head.keep_alive = version == "HTTP/1.1";
  head.path = target.substr(0, target.find('?'));  // no page of the console takes a query
  if (head.path.size() > kLongestPath) return Refusal{414, "long_path"};
  if (!plain_path(head.path)) return Refusal{400, "path"};
  return std::nullopt;
}

std::optional<Refusal> parse_length(RequestHead& head) {
  if (!head.header("transfer-encoding").empty()) return Refusal{411, "no_length"};
  if (!head.header("expect").empty()) return Refusal{417, "expectation"};
  const std::string_view text = head.header("content-length");
  if (text.empty()) return std::nullopt;
  const auto end = std::from_chars(text.data(), text.data() + text.size(), head.content_length);
  if (text.front() == '+' || text.front() == '-' || end.ptr != text.data() + text.size())
    return Refusal{400, "malformed"};
  if (end.ec == std::errc::result_out_of_range || head.content_length > kMostBodyBytes)
    return Refusal{413, "oversized"};
  return std::nullopt;
}

}  // namespace

std::string_view RequestHead::header(std::string_view lower_case_name) const {
  const auto at = std::find_if(headers.begin(), headers.end(),
                               [&](const auto& one) { return one.first == lower_case_name; });
  return at == headers.end() ? std::string_view() : std::string_view(at->second);
}

std::string_view RequestHead::bearer() const {
  static constexpr std::string_view kScheme = "bearer ";
  const std::string_view value = header("authorization");
  if (value.size() <= kScheme.size() || lower(value.substr(0, kScheme.size())) != kScheme) return {};
  return trimmed(value.substr(kScheme.size()));
}

std::variant<RequestHead, Refusal> parse_head(std::string_view bytes) {
  RequestHead head;
  std::set<std::string> once;
  bool first = true;
  while (!bytes.empty()) {
    const std::size_t end = bytes.find("\r\n");
    if (end == std::string_view::npos) return Refusal{400, "malformed"};
    const std::string_view line = bytes.substr(0, end);
    bytes.remove_prefix(end + 2);
    if (first) {
      if (auto refusal = parse_request_line(line, head)) return *refusal;
      first = false;
      continue;
    }
    if (line.empty()) break;
    const std::size_t colon = line.find(':');
    if (colon == std::string_view::npos || !token(line.substr(0, colon)) || !no_controls(line)) {
      return Refusal{400, "malformed"};
    }
    if (head.headers.size() >= kMostHeaders) return Refusal{431, "oversized_head"};
    std::string name = lower(line.substr(0, colon));
    // Lists may be repeated; of what decides about the request there is one or the request is void.
    if (!once.insert(name).second && (name == "host" || name == "content-length" || name == "origin" ||
                                      name == "authorization" || name == "transfer-encoding")) {
      return Refusal{400, "malformed"};
    }
    head.headers.emplace_back(std::move(name), std::string(trimmed(line.substr(colon + 1))));
  }
  if (first) return Refusal{400, "malformed"};
  if (auto refusal = parse_length(head)) return *refusal;
  const std::string connection = lower(head.header("connection"));
  if (connection == "close") head.keep_alive = false;
  return head;
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

std::optional<Refusal> judge_request(const RequestHead& head, const HostNames& hosts, bool secure) {
  if (head.method != "GET" && head.method != "HEAD" && head.method != "POST") return Refusal{405, "method"};
  const std::string host = lower(head.header("host"));
  if (host.empty()) return Refusal{400, "malformed"};
  if (std::find(hosts.begin(), hosts.end(), host) == hosts.end()) return Refusal{421, "foreign_host"};
  if (head.method == "POST") {
    const std::string origin = lower(head.header("origin"));
    const bool ours = origin == "https://" + host || (!secure && origin == "http://" + host);
    if (!ours) return Refusal{403, "foreign_origin"};
    if (!head.header("sec-fetch-site").empty() && head.header("sec-fetch-site") != "same-origin") {
      return Refusal{403, "foreign_origin"};
    }
    if (lower(head.header("content-type")).substr(0, 16) != "application/json")
      return Refusal{415, "content_type"};
  } else if (head.path.starts_with("/api/") && head.header("sec-fetch-site") == "cross-site") {
    return Refusal{403, "foreign_origin"};
  }
  if (head.method != "POST" && head.content_length > 0) return Refusal{400, "malformed"};
  return std::nullopt;
}

}  // namespace fathom::console
