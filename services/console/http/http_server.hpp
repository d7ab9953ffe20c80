#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "console/http/answer.hpp"
#include "console/http/request.hpp"
#include "console/http/tls.hpp"

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
  /// Answers one judged request. Events of a stream are sent until it is closed. Any thread.
  using Serve = std::function<Answer(const Request& request, const std::string& peer)>;
  /// A request was refused: for the log. Any thread.
  using Refused = std::function<void(const Refusal& refusal, const std::string& peer)>;

  HttpServer(Options options, Serve serve, Refused refused);
  /// Ends every connection. Streams that it sends must have been closed before.
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

}  // namespace fathom::console
