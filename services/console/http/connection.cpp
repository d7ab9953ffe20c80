#include "console/http/connection.hpp"

#include <algorithm>
#include <array>
#include <cerrno>

#include <openssl/err.h>
#include <openssl/ssl.h>
#include <poll.h>
#include <sys/socket.h>

#include "console/http/tls.hpp"

namespace fathom::console {
namespace {

using namespace std::chrono_literals;
constexpr std::size_t kMostSwallowed = 1'000'000;
constexpr std::size_t kMostPerRecord = 16384;

/// False when none of `events` came before the deadline.
bool wait_for(int socket, short events, SteadyTime deadline) {
  while (true) {
    const auto left =
        std::chrono::ceil<std::chrono::milliseconds>(deadline - std::chrono::steady_clock::now());
    if (left.count() <= 0) return false;
    pollfd watched{socket, events, 0};
    const int ready =
        poll(&watched, 1, static_cast<int>(std::min<std::chrono::milliseconds::rep>(left.count(), 60000)));
    if (ready > 0) return true;
    if (ready < 0 && errno != EINTR) return false;
  }
}

}  // namespace

void Connection::FreeTls::operator()(ssl_st* tls) const {
  SSL_free(tls);
}

std::optional<unsigned char> Connection::peek(SteadyTime deadline) const {
  unsigned char first = 0;
  while (wait_for(socket_, POLLIN, deadline)) {
    const ssize_t got = recv(socket_, &first, 1, MSG_PEEK);
    if (got > 0) return first;
    if (got == 0 || (errno != EINTR && errno != EAGAIN)) break;
  }
  return std::nullopt;
}

Connection::Outcome Connection::secure(const TlsIdentity& identity, SteadyTime deadline) {
  tls_.reset(SSL_new(identity.context()));
  if (!tls_ || SSL_set_fd(tls_.get(), socket_) != 1) return Outcome::closed;
  while (true) {
    ERR_clear_error();
    const int result = SSL_accept(tls_.get());
    if (result == 1) return Outcome::complete;
    const Step step = tls_step(result);
    if (step.events == 0) return Outcome::closed;
    if (wait_for(socket_, step.events, deadline)) continue;
    tls_broken_ = true;
    return Outcome::timed_out;
  }
}

Connection::Step Connection::tls_step(int result) {
  switch (SSL_get_error(tls_.get(), result)) {
    case SSL_ERROR_WANT_READ:
      return {0, POLLIN};
    case SSL_ERROR_WANT_WRITE:
      return {0, POLLOUT};
    case SSL_ERROR_ZERO_RETURN:
      return {};
    default:
      tls_broken_ = true;
      return {};
  }
}

Connection::Step Connection::try_receive(char* to, std::size_t size) {
  if (tls_) {
    if (tls_broken_) return {};
    ERR_clear_error();
    const int got = SSL_read(tls_.get(), to, static_cast<int>(size));
    return got > 0 ? Step{static_cast<std::size_t>(got), 0} : tls_step(got);
  }
  const ssize_t got = recv(socket_, to, size, 0);
  if (got > 0) return {static_cast<std::size_t>(got), 0};
  return got < 0 && (errno == EINTR || errno == EAGAIN) ? Step{0, POLLIN} : Step{};
}

Connection::Step Connection::try_send(std::string_view bytes) {
  if (tls_) {
    if (tls_broken_) return {};
    ERR_clear_error();
    const int sent =
        SSL_write(tls_.get(), bytes.data(), static_cast<int>(std::min(bytes.size(), kMostPerRecord)));
    return sent > 0 ? Step{static_cast<std::size_t>(sent), 0} : tls_step(sent);
  }
  const ssize_t sent = send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
  if (sent > 0) return {static_cast<std::size_t>(sent), 0};
  return sent < 0 && (errno == EINTR || errno == EAGAIN) ? Step{0, POLLOUT} : Step{};
}

Connection::Outcome Connection::receive(std::string& to, SteadyTime deadline) {
  std::array<char, 4096> chunk{};
  short events = POLLIN;
  while (true) {
    // The deadline counts also for a peer that always has another byte ready. What TLS has decrypted already
    // does not show on the socket.
    const bool decrypted = tls_ && SSL_pending(tls_.get()) > 0;
    if (!decrypted && !wait_for(socket_, events, deadline)) return Outcome::timed_out;
    const Step step = try_receive(chunk.data(), chunk.size());
    if (step.bytes > 0) {
      to.append(chunk.data(), step.bytes);
      return Outcome::complete;
    }
    if (step.events == 0) return Outcome::closed;
    events = step.events;
  }
}

bool Connection::write(std::string_view bytes, std::chrono::milliseconds patience) {
  while (!bytes.empty()) {
    const Step step = try_send(bytes);
    bytes.remove_prefix(step.bytes);
    if (step.bytes > 0) continue;
    if (step.events == 0) return false;
    if (!wait_for(socket_, step.events, std::chrono::steady_clock::now() + patience)) {
      tls_broken_ = true;  // half of a record may be on its way
      return false;
    }
  }
  return true;
}

void Connection::linger() {
  if (tls_ && !tls_broken_) {
    ERR_clear_error();
    (void)SSL_shutdown(tls_.get());
  }
  shutdown(socket_, SHUT_WR);
  const auto deadline = std::chrono::steady_clock::now() + 1s;
  std::array<char, 4096> swallowed{};
  for (std::size_t total = 0; total < kMostSwallowed;) {
    if (!wait_for(socket_, POLLIN, deadline)) return;
    const ssize_t got = recv(socket_, swallowed.data(), swallowed.size(), 0);
    if (got <= 0) return;
    total += static_cast<std::size_t>(got);
  }
}

}  // namespace fathom::console
