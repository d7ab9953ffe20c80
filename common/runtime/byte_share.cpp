#include "runtime/byte_share.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <system_error>
#include <utility>

#include <asio/co_spawn.hpp>
#include <asio/detached.hpp>
#include <asio/redirect_error.hpp>
#include <asio/steady_timer.hpp>
#include <asio/use_awaitable.hpp>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include "base/bytes/little_endian.hpp"

namespace fathom::runtime {
namespace {

constexpr std::size_t kHead = 9;  // kind and time
constexpr std::size_t kMostReaders = 16;
constexpr int kWaiting = 8;  // connections that nobody has taken in yet

// Where the share of a port is found: a name that begins with a zero byte and stands in no folder.
struct Place {
  explicit Place(const ByteSourceConfig& port) {
    std::string name = describe_source(port);
    if (port.type == SourceType::serial) {
      // The same line has several names below /dev/serial.
      char* const real = realpath(port.path.c_str(), nullptr);
      if (real != nullptr) name = std::string("serial ") + real;
      std::free(real);
      name += " " + std::to_string(port.baud) + " " + std::string(to_string(port.framing));
    }
    name = "fathom-port-1 " + name;
    address.sun_family = AF_UNIX;
    const std::size_t size = std::min(name.size(), sizeof address.sun_path - 1);
    // Of a long path the end tells more.
    std::memcpy(address.sun_path + 1, name.data() + (name.size() - size), size);
    length = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + size);
  }
  [[nodiscard]] const sockaddr* generic() const { return reinterpret_cast<const sockaddr*>(&address); }

  sockaddr_un address{};
  socklen_t length = 0;
};

std::system_error last_error(const char* what) {
  return {errno, std::generic_category(), what};
}

int new_socket() {
  const int descriptor = socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (descriptor < 0) throw last_error("socket of a shared port");
  return descriptor;
}

// The user at the other end.
uid_t user_behind(int descriptor) {
  ucred peer{};
  socklen_t size = sizeof peer;
  if (getsockopt(descriptor, SOL_SOCKET, SO_PEERCRED, &peer, &size) != 0) throw last_error("SO_PEERCRED");
  return peer.uid;
}

bool is_trusted(uid_t user) {
  return user == geteuid() || user == 0 || geteuid() == 0;
}

bool send_packet(int descriptor, std::span<const std::uint8_t> packet) {
  return ::send(descriptor, packet.data(), packet.size(), MSG_DONTWAIT | MSG_NOSIGNAL) ==
         static_cast<ssize_t>(packet.size());
}

}  // namespace

std::vector<std::uint8_t> pack(const ShareMessage& message) {
  std::vector<std::uint8_t> out;
  out.reserve(kHead + message.payload.size());
  out.push_back(static_cast<std::uint8_t>(message.kind));
  append_le<TimeNs>(out, message.host_monotonic_ns);
  out.insert(out.end(), message.payload.begin(), message.payload.end());
  return out;
}

std::optional<ShareMessage> unpack(std::span<const std::uint8_t> packet) {
  if (packet.size() < kHead) return std::nullopt;
  ShareMessage out;
  out.kind = static_cast<ShareMessage::Kind>(packet[0]);
  switch (out.kind) {
    case ShareMessage::Kind::bytes:
    case ShareMessage::Kind::connected:
    case ShareMessage::Kind::lost:
      break;
    default:
      return std::nullopt;
  }
  out.host_monotonic_ns = load_le<TimeNs>(packet, 1);
  out.payload = packet.subspan(kHead);
  return out;
}

std::shared_ptr<PortShare> PortShare::claim(asio::io_context& io, const ByteSourceConfig& port) {
  const Place place(port);
  const int descriptor = new_socket();
  if (bind(descriptor, place.generic(), place.length) == 0 && listen(descriptor, kWaiting) == 0)
    return std::make_shared<PortShare>(io, descriptor);
  const std::system_error error = last_error("shared port");
  ::close(descriptor);
  if (error.code().value() == EADDRINUSE) return nullptr;
  throw error;
}

std::unique_ptr<asio::posix::stream_descriptor> PortShare::join(asio::io_context& io,
                                                                const ByteSourceConfig& port) {
  const Place place(port);
  auto link = std::make_unique<asio::posix::stream_descriptor>(io, new_socket());
  if (connect(link->native_handle(), place.generic(), place.length) != 0) {
    // It is not listening yet or no more, or others are waiting: a moment later it is another matter.
    if (errno == ECONNREFUSED || errno == EAGAIN) return nullptr;
    throw last_error("shared port");
  }
  if (!is_trusted(user_behind(link->native_handle())))
    throw std::runtime_error("user " + std::to_string(user_behind(link->native_handle())) +
                             " hands this port on, expected this one or root");
  return link;
}

PortShare::PortShare(asio::io_context& io, int listening) : io_(io), listening_(io, listening) {}

void PortShare::start() {
  asio::co_spawn(
      io_, [self = shared_from_this()]() -> asio::awaitable<void> { co_await self->accept(); },
      asio::detached);
}

void PortShare::close() {
  asio::error_code ignored;
  listening_.close(ignored);
  readers_.clear();
}

asio::awaitable<void> PortShare::accept() {
  for (;;) {
    asio::error_code error;
    co_await listening_.async_wait(asio::posix::stream_descriptor::wait_read,
                                   asio::redirect_error(asio::use_awaitable, error));
    if (error || !listening_.is_open()) co_return;
    const int descriptor =
        accept4(listening_.native_handle(), nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK);
    if (descriptor >= 0) {
      take_in(descriptor);
    } else {  // who connects waits meanwhile, e.g. until there are descriptors again
      asio::steady_timer pause(io_, std::chrono::milliseconds(100));
      co_await pause.async_wait(asio::redirect_error(asio::use_awaitable, error));
    }
  }
}

void PortShare::take_in(int descriptor) {
  asio::posix::stream_descriptor reader(io_, descriptor);
  // Those that went without a word.
  std::erase_if(readers_, [](asio::posix::stream_descriptor& one) {
    std::uint8_t none = 0;
    return recv(one.native_handle(), &none, 1, MSG_PEEK | MSG_DONTWAIT) == 0;
  });
  if (readers_.size() >= kMostReaders || !is_trusted(user_behind(descriptor))) return;
  if (!state_.empty() && !send_packet(descriptor, state_)) return;
  readers_.push_back(std::move(reader));
}

void PortShare::tell(const ShareMessage& message) {
  if (readers_.empty() && message.kind == ShareMessage::Kind::bytes) return;
  std::vector<std::uint8_t> packet = pack(message);
  std::erase_if(readers_, [&packet](asio::posix::stream_descriptor& one) {
    return !send_packet(one.native_handle(), packet);
  });
  if (message.kind != ShareMessage::Kind::bytes) state_ = std::move(packet);
}

}  // namespace fathom::runtime
