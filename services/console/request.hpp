#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace fathom::console {

inline constexpr std::size_t kMostHeadBytes = std::size_t{16} * 1024;
inline constexpr std::size_t kMostBodyBytes = std::size_t{64} * 1024;

/// Why a request is not answered as it hoped.
struct Refusal {
  int status = 400;
  std::string reason;  ///< a word for counting and the log, e.g. "foreign_origin"
};

/// The head of an HTTP/1.x request, its syntax checked.
struct RequestHead {
  std::string method;
  std::string path;  ///< plain: letters, digits, '.', '_', '-', '/'; no segment begins with a dot
  bool keep_alive = true;
  std::size_t content_length = 0;
  std::vector<std::pair<std::string, std::string>> headers;  ///< names in lower case

  /// Empty when there is none.
  [[nodiscard]] std::string_view header(std::string_view lower_case_name) const;
  /// What stands after "Authorization: Bearer "; empty when nothing does.
  [[nodiscard]] std::string_view bearer() const;
};

/// Parses everything up to and including the empty line. Whatever two programs could read in two ways (folded
/// or repeated headers, both lengths, control characters) is refused rather than understood.
[[nodiscard]] std::variant<RequestHead, Refusal> parse_head(std::string_view bytes);

/// Under which names this console may be called, e.g. "127.0.0.1:8420": a page of another site that has its
/// name resolved to this host does not know them.
using HostNames = std::vector<std::string>;
[[nodiscard]] HostNames host_names(const std::string& address, int port,
                                   const std::vector<std::string>& names);

/// Method, host and origin. An order (POST) must come from the console's own page: by https where the console
/// itself has TLS (`secure`), by either where a proxy may have it.
[[nodiscard]] std::optional<Refusal> judge_request(const RequestHead& head, const HostNames& hosts,
                                                   bool secure);

}  // namespace fathom::console
