#pragma once

#include <csignal>
#include <cstdlib>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <nlohmann/json.hpp>
#include <openssl/ssl.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

namespace fathom::test {

struct HttpAnswer {
  int status = 0;  ///< 0: none came
  std::string head;
  std::string body;
};

/// A socket that says whatever it is told, as no browser would, in clear or by TLS.
class HttpPeer {
 public:
  struct Tls {
    std::string trusted;  ///< PEM file of the certificate that the console has to show
    int newest = TLS1_3_VERSION;
  };

  /// `from`: of the last byte of 127.0.0.x, the address that it calls from.
  explicit HttpPeer(int port, int receive_buffer = 0, std::uint32_t from = 1)
      : socket_(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in own{};
    own.sin_family = AF_INET;
    own.sin_addr.s_addr = htonl(INADDR_LOOPBACK - 1 + from);
    bound_ = bind(socket_, reinterpret_cast<const sockaddr*>(&own), sizeof own) == 0;
    if (receive_buffer > 0)
      setsockopt(socket_, SOL_SOCKET, SO_RCVBUF, &receive_buffer, sizeof receive_buffer);
    const timeval patience{120, 0};
    setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
    setsockopt(socket_, SOL_SOCKET, SO_SNDTIMEO, &patience, sizeof patience);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    connected_ = bound_ && connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
  }
  HttpPeer(int port, const Tls& options) : HttpPeer(port) {
    context_.reset(SSL_CTX_new(TLS_client_method()));
    SSL_CTX_load_verify_locations(context_.get(), options.trusted.c_str(), nullptr);
    SSL_CTX_set_verify(context_.get(), SSL_VERIFY_PEER, nullptr);
    SSL_CTX_set_security_level(context_.get(), 0);  // whatever the version: refusing is the console's part
    SSL_CTX_set_min_proto_version(context_.get(), TLS1_VERSION);
    SSL_CTX_set_max_proto_version(context_.get(), options.newest);
    tls_.reset(SSL_new(context_.get()));
    X509_VERIFY_PARAM_set1_ip_asc(SSL_get0_param(tls_.get()), "127.0.0.1");
    SSL_set_fd(tls_.get(), socket_);
    sigset_t pipe;  // the library writes without MSG_NOSIGNAL
    sigemptyset(&pipe);
    sigaddset(&pipe, SIGPIPE);
    pthread_sigmask(SIG_BLOCK, &pipe, nullptr);
    connected_ = connected_ && SSL_connect(tls_.get()) == 1;
  }
  ~HttpPeer() { close(socket_); }
  HttpPeer(const HttpPeer&) = delete;
  HttpPeer& operator=(const HttpPeer&) = delete;

  /// By TLS: the console showed the certificate that is trusted, for this address.
  [[nodiscard]] bool connected() const { return connected_; }
  [[nodiscard]] std::string version() const { return tls_ ? SSL_get_version(tls_.get()) : ""; }
  /// What the other side closed meanwhile takes no more; the answer tells.
  void say(std::string_view bytes) {
    while (!bytes.empty()) {
      const ssize_t sent = tls_ ? SSL_write(tls_.get(), bytes.data(), static_cast<int>(bytes.size()))
                                : send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
      if (sent <= 0) return;
      bytes.remove_prefix(static_cast<std::size_t>(sent));
    }
  }
  /// Everything until the other side closes.
  [[nodiscard]] HttpAnswer hear() {
    while (receive()) {
    }
    HttpAnswer answer;
    const std::size_t end = heard_.find("\r\n\r\n");
    if (!heard_.starts_with("HTTP/1.1 ") || end == std::string::npos) return answer;
    answer.status = std::atoi(heard_.c_str() + 9);
    answer.head = heard_.substr(0, end + 2);
    answer.body = heard_.substr(end + 4);
    return answer;
  }
  [[nodiscard]] HttpAnswer exchange(std::string_view request) {
    say(request);
    return hear();
  }
  /// Of a live stream: the next event of a kind. Nothing when the stream ended.
  [[nodiscard]] std::optional<nlohmann::json> event(const std::string& kind) {
    const std::string mark = "event: " + kind + "\ndata: ";
    while (true) {
      const std::size_t begin = heard_.find(mark);
      const std::size_t end = begin == std::string::npos ? begin : heard_.find("\n\n", begin);
      if (end != std::string::npos) {
        const std::size_t from = begin + mark.size();
        auto value = nlohmann::json::parse(heard_.substr(from, end - from), nullptr, false);
        heard_.erase(0, end + 2);
        return value;
      }
      if (!receive()) return std::nullopt;
    }
  }

 private:
  bool receive() {
    char chunk[65536];
    const ssize_t got =
        tls_ ? SSL_read(tls_.get(), chunk, sizeof chunk) : recv(socket_, chunk, sizeof chunk, 0);
    if (got <= 0) return false;
    heard_.append(chunk, static_cast<std::size_t>(got));
    return true;
  }

  int socket_;
  bool bound_ = false;
  bool connected_ = false;
  std::unique_ptr<SSL_CTX, decltype(&SSL_CTX_free)> context_{nullptr, SSL_CTX_free};
  std::unique_ptr<SSL, decltype(&SSL_free)> tls_{nullptr, SSL_free};
  std::string heard_;
};

}  // namespace fathom::test
