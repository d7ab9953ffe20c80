#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace fathom::console {

inline constexpr std::size_t kMostHeadBytes = std::size_t{16} * 1024;
inline constexpr std::size_t kMostBodyBytes = std::size_t{64} * 1024;

/// Why a request is not answered as it hoped.
struct Refusal {
  int status = 400;
  std::string reason;  ///< a word for counting and the log, e.g. "foreign_origin"
};

/// What the console uses of a request: nothing else of it goes any further.
struct Request {
  std::string method;  ///< GET, HEAD or POST
  std::string path;    ///< plain: letters, digits, '.', '_', '-', '/'; no segment begins with a dot
  bool keep_alive = false;
  std::string authorization;  ///< header of that name; empty: none
  std::string if_none_match;  ///< header of that name; empty: none
  std::string body;           ///< of a POST

  /// What stands after "Authorization: Bearer "; empty when nothing does.
  [[nodiscard]] std::string_view bearer() const;
};

/// Under which names this console may be called, e.g. "127.0.0.1:8420": a page of another site that has its
/// name resolved to this host does not know them.
using HostNames = std::vector<std::string>;
[[nodiscard]] HostNames host_names(const std::string& address, int port,
                                   const std::vector<std::string>& names);

/// Reads one HTTP/1.x request from bytes as they come, by Boost.Beast's parser, and judges its head before
/// any of its body is taken. Whatever two programs could read in two ways (folded or repeated headers, a
/// Transfer-Encoding beside a Content-Length, control characters) is refused rather than understood. An order
/// (POST) must come from the console's own page: by https where the console itself has TLS (`secure`), by
/// either where a proxy may have it. Pure: no sockets, no time.
class RequestReader {
 public:
  enum class State { needs_more, complete, refused };

  /// `hosts` must outlive it.
  RequestReader(const HostNames& hosts, bool secure);
  ~RequestReader();
  RequestReader(const RequestReader&) = delete;
  RequestReader& operator=(const RequestReader&) = delete;

  /// Takes what belongs to this request off the front of `bytes`. What is left after `complete` begins the
  /// next one. The bytes of a head stay until it is whole: at most kMostHeadBytes and what came with them.
  State take(std::string& bytes);
  /// From now on the body is awaited.
  [[nodiscard]] bool head_is_whole() const;
  /// After `refused`.
  [[nodiscard]] const Refusal& refusal() const;
  /// After `complete`, once.
  [[nodiscard]] Request request();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace fathom::console
