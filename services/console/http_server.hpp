#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "console/connection.hpp"
#include "console/request.hpp"
#include "console/tls.hpp"

namespace fathom::console {

/// Accepts connections and lets only sound requests through: everything has a deadline and a size, and the
/// number of connections is limited overall and per peer. What is refused is answered, counted and reported.
class HttpServer {
 public:
  struct Options {
    std::string address = "127.0.0.1";
    int port = 8420;
    std::vector<std::string> names;  ///< besides the address, of this host
    std::optional<TlsIdentity> tls;  ///< none: in clear; else by nothing but TLS
    std::size_t most_connections = 128;
    std::size_t most_per_peer = 96;
    /// A browser opens connections ahead of its requests, and keeps them for the next.
    std::chrono::milliseconds idle_deadline{30000};
    std::chrono::milliseconds head_deadline{5000};  ///< from its first byte; the handshake of TLS as well
    std::chrono::milliseconds request_deadline{10000};
  };
  struct Counters {
    std::uint64_t requests = 0;
    std::uint64_t refused = 0;
  };
  /// Answers one judged request through the connection. False: the connection ends with it.
  using Serve = std::function<bool(const RequestHead& head, const std::string& body, const std::string& peer,
                                   Connection& connection)>;
  /// A request was refused: for the log. Any thread.
  using Refused = std::function<void(const Refusal& refusal, const std::string& peer)>;

  HttpServer(Options options, Serve serve, Refused refused);
  /// Ends every connection. What `serve` waits for must have been woken before.
  ~HttpServer();
  HttpServer(const HttpServer&) = delete;
  HttpServer& operator=(const HttpServer&) = delete;

  /// Empty when it listens now, else one sentence why it does not; to be tried again later.
  [[nodiscard]] std::string start();
  [[nodiscard]] bool running() const;
  [[nodiscard]] Counters counters() const;
  [[nodiscard]] std::size_t connections() const;
  /// Counts and reports what was refused behind the head's judgement.
  void refuse(const Refusal& refusal, const std::string& peer);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// A whole answer to a request that is not served, with the headers that every answer has. `secure`: it goes
/// through TLS.
[[nodiscard]] std::string refusal_text(const Refusal& refusal, bool secure);

/// What every answer carries: nothing but the console's own files may run in or around the page.
inline constexpr std::array<std::pair<const char*, const char*>, 5> kSecurityHeaders{{
    {"Content-Security-Policy",
     "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data: blob:; connect-src "
     "'self'; "
     "manifest-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"},
    {"X-Content-Type-Options", "nosniff"},
    {"X-Frame-Options", "DENY"},
    {"Referrer-Policy", "no-referrer"},
    {"Cross-Origin-Resource-Policy", "same-origin"},
}};

/// Besides, where there is TLS: browsers that have been here ask this host by https only, for thirty days.
inline constexpr std::pair<const char*, const char*> kStrictTransport{"Strict-Transport-Security",
                                                                      "max-age=2592000"};

}  // namespace fathom::console
