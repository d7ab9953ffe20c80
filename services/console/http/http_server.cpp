#include "console/http/http_server.hpp"

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <list>
#include <mutex>
#include <thread>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include "console/http/connection.hpp"

namespace fathom::console {
namespace {

using Clock = std::chrono::steady_clock;
using namespace std::chrono_literals;
constexpr auto kWritePatience = 10s;
// Who takes nothing for this long is given up; a browser asks again when it is back.
constexpr auto kReadPatience = 15s;
constexpr auto kEventPatience = 1s;
constexpr auto kComplete = Connection::Outcome::complete;
constexpr unsigned char kTlsHandshake = 22;  // what every TLS connection begins with, and no HTTP request

/// A peer that left must not end the process: the TLS library writes without MSG_NOSIGNAL. On this thread.
void ignore_broken_pipes() {
  sigset_t pipe;
  sigemptyset(&pipe);
  sigaddset(&pipe, SIGPIPE);
  pthread_sigmask(SIG_BLOCK, &pipe, nullptr);
}

/// The whole of an answer that ends its connection.
std::string refusal_text(const Refusal& refusal, bool secure) {
  const Answer answer = answer_to(refusal);
  return head_of(answer, false, secure) + answer.body;
}

}  // namespace

struct HttpServer::Impl {
  Impl(Options options_in, Serve serve_in, Refused refused_in)
      : options(std::move(options_in)),
        serve(std::move(serve_in)),
        refused(std::move(refused_in)),
        hosts(host_names(options.address, options.port, options.names)),
        wake(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {}
  ~Impl() {
    if (listener >= 0) close(listener);
    close(wake);
  }

  /// One accepted connection with its thread. Its socket is shut down to end it from outside, and closed
  /// when its thread is over.
  struct Session {
    std::thread thread;
    int socket = -1;
    std::string peer;
    std::atomic<bool> done{false};
  };

  void refuse(const Refusal& refusal, const std::string& peer) {
    ++refusals;
    refused(refusal, peer);
  }

  void accept_loop() {
    bool exhausted = false;  // then who connects waits until another one has left
    while (!stopping) {
      pollfd watched[2]{{wake, POLLIN, 0}, {listener, POLLIN, 0}};
      poll(watched, exhausted ? 1 : 2, exhausted ? 100 : 1000);
      reap();
      exhausted = false;
      if (stopping || (watched[1].revents & POLLIN) == 0) continue;
      sockaddr_in from{};
      socklen_t size = sizeof from;
      const int socket =
          accept4(listener, reinterpret_cast<sockaddr*>(&from), &size, SOCK_NONBLOCK | SOCK_CLOEXEC);
      if (socket < 0) {
        exhausted = errno == EMFILE || errno == ENFILE || errno == ENOBUFS || errno == ENOMEM;
        if (exhausted) refused({503, "no_descriptors"}, "a client that waits");
        continue;
      }
      const int on = 1;
      setsockopt(socket, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
      std::array<char, INET_ADDRSTRLEN> text{};
      inet_ntop(AF_INET, &from.sin_addr, text.data(), text.size());
      take(socket, text.data());
    }
  }

  void take(int socket, const std::string& peer) {
    const std::lock_guard lock(mutex);
    std::size_t of_peer = 0;
    for (const Session& session : sessions) of_peer += session.peer == peer ? 1 : 0;
    if (sessions.size() >= options.most_connections || of_peer >= options.most_per_peer) {
      const Refusal refusal{503, "too_many_connections"};
      if (!options.tls) {  // where there is TLS nothing can be said before a handshake, and that is work
        const std::string text = refusal_text(refusal, false);
        (void)send(socket, text.data(), text.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
      }
      close(socket);
      refuse(refusal, peer);
      return;
    }
    Session& session = sessions.emplace_back();
    session.socket = socket;
    session.peer = peer;
    try {
      session.thread = std::thread([this, &session] {
        ignore_broken_pipes();
        {
          Connection connection(session.socket);
          converse(connection, session.peer);
        }
        shutdown(session.socket, SHUT_RDWR);
        session.done = true;
        const std::uint64_t one = 1;
        (void)!::write(wake, &one, sizeof one);
      });
    } catch (const std::system_error&) {  // no more threads on this machine
      close(socket);
      sessions.pop_back();
    }
  }

  /// The handshake, within the same time as the head of a request. False when the connection is over.
  bool secure(Connection& connection, const std::string& peer) {
    const auto first = connection.peek(Clock::now() + options.idle_deadline);
    if (!first) return false;
    if (*first != kTlsHandshake) {
      refuse({400, kPlainHttp}, peer);
      if (connection.write(refusal_text({400, kPlainHttp}, false), kWritePatience)) connection.linger();
      return false;
    }
    const auto outcome = connection.secure(*options.tls, Clock::now() + options.head_deadline);
    if (outcome == Connection::Outcome::timed_out) refuse({408, "tls_too_slow"}, peer);
    if (outcome == Connection::Outcome::closed) refuse({400, "tls_handshake"}, peer);
    return outcome == Connection::Outcome::complete;
  }

  void converse(Connection& connection, const std::string& peer) {
    if (options.tls && !secure(connection, peer)) return;
    std::string bytes;  // of the next request, and what came behind it
    while (!stopping) {
      if (bytes.empty() && connection.receive(bytes, Clock::now() + options.idle_deadline) != kComplete)
        return;
      RequestReader reader(hosts, options.tls.has_value());
      const auto outcome = read(connection, reader, bytes);
      if (outcome == Connection::Outcome::timed_out) return answer(connection, {408, "too_slow"}, peer);
      if (outcome == Connection::Outcome::closed) return;
      if (outcome == std::nullopt) return answer(connection, reader.refusal(), peer);
      ++requests;
      if (!deliver(reader.request(), peer, connection)) return connection.linger();
    }
  }

  /// Until the request is whole. Nothing when it was refused.
  std::optional<Connection::Outcome> read(Connection& connection, RequestReader& reader,
                                          std::string& bytes) const {
    const auto began = Clock::now();
    while (true) {
      const auto state = reader.take(bytes);
      if (state == RequestReader::State::refused) return std::nullopt;
      if (state == RequestReader::State::complete) return kComplete;
      const auto deadline =
          began + (reader.head_is_whole() ? options.request_deadline : options.head_deadline);
      const auto outcome = connection.receive(bytes, deadline);
      if (outcome != kComplete) return outcome;
    }
  }

  /// False: the connection ends with it.
  bool deliver(const Request& request, const std::string& peer, Connection& connection) const {
    std::shared_ptr<FanOut::Client> stream;
    {
      // A snapshot is large: it is let go before its stream begins.
      const Answer answer = serve(request, peer);
      std::string text = head_of(answer, request.keep_alive, options.tls.has_value());
      if (request.method != "HEAD") text += answer.content();
      if (!connection.write(text, kReadPatience)) return false;
      stream = answer.stream;
    }
    if (!stream) return request.keep_alive;
    while (!stream->closed()) {
      const Event event = stream->wait(kEventPatience);
      if (event && !connection.write(*event, kReadPatience)) return false;
    }
    return false;
  }

  void answer(Connection& connection, const Refusal& refusal, const std::string& peer) {
    refuse(refusal, peer);
    const std::string text = refusal_text(refusal, options.tls.has_value());
    if (connection.write(text, kWritePatience)) connection.linger();
  }

  void reap() {
    std::uint64_t ignored = 0;
    (void)!::read(wake, &ignored, sizeof ignored);
    const std::lock_guard lock(mutex);
    for (auto session = sessions.begin(); session != sessions.end();) {
      if (!session->done) {
        ++session;
        continue;
      }
      session->thread.join();
      close(session->socket);
      session = sessions.erase(session);
    }
  }

  Options options;
  Serve serve;
  Refused refused;
  HostNames hosts;
  int listener = -1;
  int wake;
  std::atomic<bool> stopping{false};
  std::atomic<std::uint64_t> requests{0};
  std::atomic<std::uint64_t> refusals{0};
  mutable std::mutex mutex;  ///< of the sessions
  std::list<Session> sessions;
  std::thread acceptor;
};

HttpServer::HttpServer(Options options, Serve serve, Refused refused)
    : impl_(std::make_unique<Impl>(std::move(options), std::move(serve), std::move(refused))) {}

HttpServer::~HttpServer() {
  impl_->stopping = true;
  const std::uint64_t one = 1;
  (void)!::write(impl_->wake, &one, sizeof one);
  if (impl_->acceptor.joinable()) impl_->acceptor.join();
  for (auto& session : impl_->sessions) shutdown(session.socket, SHUT_RDWR);
  for (auto& session : impl_->sessions) {
    session.thread.join();
    close(session.socket);
  }
}

std::string HttpServer::start() {
  Impl& impl = *impl_;
  const std::string where = impl.options.address + ":" + std::to_string(impl.options.port);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(impl.options.port));
  if (inet_pton(AF_INET, impl.options.address.c_str(), &address.sin_addr) != 1) {
    return "cannot listen at " + where + ": expected an IPv4 address";
  }
  const int listener = socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  const int on = 1;
  setsockopt(listener, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
  if (listener < 0 || bind(listener, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 ||
      listen(listener, 64) != 0) {
    const int error = errno;
    if (listener >= 0) close(listener);
    return "cannot listen at " + where + ": " + std::strerror(error);
  }
  impl.listener = listener;
  impl.acceptor = std::thread([&impl] { impl.accept_loop(); });
  return {};
}

bool HttpServer::running() const {
  return impl_->listener >= 0;
}

HttpServer::Counters HttpServer::counters() const {
  return {impl_->requests, impl_->refusals};
}

std::size_t HttpServer::connections() const {
  const std::lock_guard lock(impl_->mutex);
  return impl_->sessions.size();
}

void HttpServer::refuse(const Refusal& refusal, const std::string& peer) {
  impl_->refuse(refusal, peer);
}

}  // namespace fathom::console
