#include "console/connection.hpp"

#include <algorithm>
#include <array>
#include <cerrno>

#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

namespace fathom::console {
namespace {

using namespace std::chrono_literals;
constexpr std::size_t kMostSwallowed = 1'000'000;

/// False when `events` did not come before the deadline.
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

Connection::~Connection() {
  close(socket_);
}

Connection::Outcome Connection::receive(SteadyTime deadline) {
  std::array<char, 4096> chunk{};
  while (true) {
    // The deadline counts also for a peer that always has another byte ready.
    if (!wait_for(socket_, POLLIN, deadline)) return Outcome::timed_out;
    const ssize_t got = recv(socket_, chunk.data(), chunk.size(), 0);
    if (got > 0) {
      buffer_.append(chunk.data(), static_cast<std::size_t>(got));
      return Outcome::complete;
    }
    if (got < 0 && (errno == EINTR || errno == EAGAIN)) continue;
    return Outcome::closed;
  }
}

bool Connection::wait_for_request(SteadyTime deadline) {
  return has_started() || receive(deadline) == Outcome::complete;
}

Connection::Outcome Connection::read_head(std::string& head, std::size_t most, SteadyTime deadline) {
  while (true) {
    const std::size_t end = buffer_.find("\r\n\r\n");
    if (end != std::string::npos && end + 4 <= most) {
      head = buffer_.substr(0, end + 4);
      buffer_.erase(0, end + 4);
      return Outcome::complete;
    }
    if (end != std::string::npos || buffer_.size() > most) return Outcome::oversized;
    if (const Outcome outcome = receive(deadline); outcome != Outcome::complete) return outcome;
  }
}

Connection::Outcome Connection::read_body(std::string& body, std::size_t length, SteadyTime deadline) {
  while (buffer_.size() < length) {
    if (const Outcome outcome = receive(deadline); outcome != Outcome::complete) return outcome;
  }
  body = buffer_.substr(0, length);
  buffer_.erase(0, length);
  return Outcome::complete;
}

bool Connection::write(std::string_view bytes, std::chrono::milliseconds patience) {
  while (!bytes.empty()) {
    const ssize_t sent = send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (sent > 0) {
      bytes.remove_prefix(static_cast<std::size_t>(sent));
      continue;
    }
    if (sent < 0 && errno == EINTR) continue;
    if (sent < 0 && errno != EAGAIN) return false;
    if (!wait_for(socket_, POLLOUT, std::chrono::steady_clock::now() + patience)) return false;
  }
  return true;
}

void Connection::linger() {
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
