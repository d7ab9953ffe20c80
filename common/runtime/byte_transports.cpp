#include <chrono>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <system_error>
#include <vector>

#include <asio/buffer.hpp>
#include <asio/co_spawn.hpp>
#include <asio/detached.hpp>
#include <asio/ip/address.hpp>
#include <asio/ip/multicast.hpp>
#include <asio/ip/tcp.hpp>
#include <asio/ip/udp.hpp>
#include <asio/serial_port.hpp>
#include <asio/use_awaitable.hpp>
#include <asio/write.hpp>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <termios.h>
#include <unistd.h>

#include "runtime/byte_source_impl.hpp"
#include "runtime/serial/serial_holders.hpp"
#include "runtime/serial/serial_line.hpp"

namespace fathom::runtime {
namespace {

using asio::ip::tcp;
using asio::ip::udp;

constexpr double kConnectTimeout_s = 3.0;
constexpr std::size_t kStreamPiece = 4096;
constexpr std::size_t kLongestDatagram = 65'536;

// A peer that lost power sends no FIN: without this a read would wait for hours.
void keep_alive(tcp::socket& socket) {
  socket.set_option(asio::socket_base::keep_alive(true));
  const auto set = [&](int option, int value) {
    if (setsockopt(socket.native_handle(), IPPROTO_TCP, option, &value, sizeof value) != 0) {
      throw std::system_error(errno, std::generic_category(), "keep-alive");
    }
  };
  set(TCP_KEEPIDLE, 5);
  set(TCP_KEEPINTVL, 2);
  set(TCP_KEEPCNT, 3);
}

// A line of its own for this process. What the system says of it is put in words.
asio::serial_port open_line(asio::io_context& io, const std::string& path, int baud) {
  try {
    return open_serial_line(io, path, baud);
  } catch (const std::system_error& error) {
    throw std::runtime_error(serial_trouble(path, error.code()));
  }
}

// Another than 8N1.
void set_framing(asio::serial_port& port, Framing framing) {
  using asio::serial_port;
  const bool seven = framing == Framing::e7_1 || framing == Framing::o7_1;
  const bool even = framing == Framing::e7_1 || framing == Framing::e8_1;
  const auto parity = even ? serial_port::parity::even : serial_port::parity::odd;
  // A terminal without a line behind it has no parity and no seven bits. Then the eighth bit is taken off
  // here.
  asio::error_code error;
  port.set_option(serial_port::character_size(seven ? 7 : 8), error);
  if (!error) port.set_option(serial_port::parity(parity), error);
  if (!seven && error) throw std::system_error(error, std::string(to_string(framing)) + " is not to be had");
  if (!seven) return;
  termios mode{};
  if (tcgetattr(port.native_handle(), &mode) != 0)
    throw std::system_error(errno, std::generic_category(), "tcgetattr");
  mode.c_iflag |= ISTRIP;
  if (tcsetattr(port.native_handle(), TCSANOW, &mode) != 0)
    throw std::system_error(errno, std::generic_category(), "tcsetattr");
}

// Now or not at all: a line that takes no bytes must not hold up those that come. That it is broken is
// noticed where it is read.
void say_at_once(asio::serial_port& port, const std::string& text) {
  pollfd ready{port.native_handle(), POLLOUT, 0};
  if (text.empty() || poll(&ready, 1, 0) != 1 || (ready.revents & POLLOUT) == 0) return;
  [[maybe_unused]] const auto size = write(port.native_handle(), text.data(), text.size());
}
void say_at_once(tcp::socket& socket, const std::string& text) {
  if (text.empty()) return;
  [[maybe_unused]] const auto size =
      send(socket.native_handle(), text.data(), text.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
}

}  // namespace

template <class Stream>
asio::awaitable<void> ByteSource::Impl::read_all(Stream& stream) {
  std::vector<std::uint8_t> buffer(kStreamPiece);
  for (;;) {
    const std::size_t size = co_await stream.async_read_some(asio::buffer(buffer), asio::use_awaitable);
    deliver(std::span(buffer).first(size));
  }
}

asio::awaitable<void> ByteSource::Impl::serve_serial() {
  asio::serial_port port = open_line(io, config.path, config.baud);
  SerialClaim claim(port.native_handle(), config.path);
  if (config.framing != Framing::n8_1) set_framing(port, config.framing);
  tcflush(port.native_handle(), TCIFLUSH);
  still_there = [this, &port] {
    struct stat at_path {};
    struct stat opened {};
    return stat(config.path.c_str(), &at_path) == 0 && fstat(port.native_handle(), &opened) == 0 &&
           at_path.st_rdev == opened.st_rdev;
  };
  break_connection = [&port, &claim] {
    claim.release();
    port.close();
  };
  greet_again = [this, &port] { say_at_once(port, config.greeting); };
  last_byte_ns = clock.monotonic_ns();
  change(SourceState::connected, describe_source(config) + ": open");
  greet_again();
  co_await read_all(port);
}

asio::awaitable<void> ByteSource::Impl::serve_tcp_client() {
  const auto socket = std::make_shared<tcp::socket>(io);
  const tcp::endpoint device(asio::ip::make_address(config.address),
                             static_cast<asio::ip::port_type>(config.port));
  // An address that nobody answers for would hold the attempt for minutes.
  asio::steady_timer timeout(io, std::chrono::nanoseconds(from_seconds(kConnectTimeout_s)));
  const auto late = std::make_shared<bool>(false);
  timeout.async_wait(
      [socket, late](const asio::error_code& error) {  // it may run after an attempt that failed
        asio::error_code ignored;
        if (error) return;
        *late = true;
        socket->close(ignored);
      });
  try {
    co_await socket->async_connect(device, asio::use_awaitable);
  } catch (const asio::system_error&) {
    if (*late) throw std::runtime_error("no answer");
    throw;
  }
  timeout.cancel();
  keep_alive(*socket);
  last_byte_ns = clock.monotonic_ns();
  change(SourceState::connected, describe_source(config) + ": connected");
  if (!config.greeting.empty())
    co_await asio::async_write(*socket, asio::buffer(config.greeting), asio::use_awaitable);
  greet_again = [this, &socket] { say_at_once(*socket, config.greeting); };
  co_await read_all(*socket);
}

asio::awaitable<void> ByteSource::Impl::serve_tcp_server() {
  tcp::acceptor acceptor(io, tcp::endpoint(asio::ip::make_address(config.address),
                                           static_cast<asio::ip::port_type>(config.port)));
  auto current = std::make_shared<std::shared_ptr<tcp::socket>>();
  change(SourceState::lost, describe_source(config) + ": waiting for the device to connect");
  for (;;) {
    auto peer = std::make_shared<tcp::socket>(co_await acceptor.async_accept(asio::use_awaitable));
    if (*current) {
      asio::error_code ignored;
      (*current)->close(ignored);
      change(SourceState::lost, describe_source(config) + ": replaced by a new connection");
    }
    *current = peer;
    last_byte_ns = clock.monotonic_ns();
    change(SourceState::connected, describe_source(config) + ": the device connected");
    asio::co_spawn(
        io,
        [](Impl& self, std::shared_ptr<tcp::socket> socket,
           std::shared_ptr<std::shared_ptr<tcp::socket>> shown) -> asio::awaitable<void> {
          std::string reason;
          try {
            keep_alive(*socket);
            std::vector<std::uint8_t> buffer(kStreamPiece);
            for (;;) {
              const std::size_t size =
                  co_await socket->async_read_some(asio::buffer(buffer), asio::use_awaitable);
              if (*shown != socket) co_return;
              self.deliver(std::span(buffer).first(size));
            }
          } catch (const asio::system_error& error) {
            reason = error.code().message();
          } catch (const std::exception& error) {
            reason = error.what();
          }
          if (*shown != socket) co_return;  // replaced: the newcomer's state counts
          shown->reset();
          self.fail(reason);
        }(*this, peer, current),
        asio::detached);
  }
}

asio::awaitable<void> ByteSource::Impl::serve_udp() {
  const auto address = asio::ip::make_address(config.address);
  const auto port = static_cast<asio::ip::port_type>(config.port);
  udp::socket socket(io);
  if (config.multicast.empty()) {
    const udp::endpoint local(address, port);
    socket.open(local.protocol());
    socket.bind(local);
  } else {
    // A socket bound to an interface's address receives no group traffic: bind to the group, join on the
    // interface.
    const auto group = asio::ip::make_address(config.multicast);
    const udp::endpoint local(group, port);
    socket.open(local.protocol());
    socket.set_option(asio::socket_base::reuse_address(true));
    socket.bind(local);
    if (group.is_v4()) {
      socket.set_option(asio::ip::multicast::join_group(group.to_v4(), address.to_v4()));
    } else {
      socket.set_option(asio::ip::multicast::join_group(group));
    }
  }
  last_byte_ns = clock.monotonic_ns();
  change(SourceState::connected, describe_source(config) + ": bound");
  std::vector<std::uint8_t> buffer(kLongestDatagram);
  for (;;) {
    const std::size_t size = co_await socket.async_receive(asio::buffer(buffer), asio::use_awaitable);
    if (size > 0) deliver(std::span(buffer).first(size));
  }
}

asio::awaitable<void> ByteSource::Impl::serve_file() {
  // A directory opens as a stream, too, and reads as empty.
  if (std::filesystem::is_directory(config.path)) throw std::runtime_error("is a folder");
  std::ifstream file(config.path, std::ios::binary);
  if (!file) throw std::system_error(errno, std::generic_category());
  last_byte_ns = clock.monotonic_ns();
  change(SourceState::connected, describe_source(config) + ": open");
  // Small pieces, so that a piece holds about one frame and its samples do not share one arrival.
  std::vector<std::uint8_t> buffer(config.pace == Pace::fastest ? kStreamPiece : 64);
  const TimeNs start_ns = clock.monotonic_ns();
  double sent = 0.0;
  for (;;) {
    file.read(reinterpret_cast<char*>(buffer.data()), static_cast<std::streamsize>(buffer.size()));
    const auto size = static_cast<std::size_t>(file.gcount());
    if (size == 0) break;
    deliver(std::span(buffer).first(size));
    sent += static_cast<double>(size);
    double ahead_s = 0.0;
    if (config.pace == Pace::rate) {
      ahead_s = sent / config.bytes_per_s - to_seconds(clock.monotonic_ns() - start_ns);
    }
    // Even when there is nothing to wait for: stopping works between two pieces.
    co_await wait(std::max(0.0, ahead_s));
  }
}

}  // namespace fathom::runtime
