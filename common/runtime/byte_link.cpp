#include "runtime/byte_link.hpp"

#include <array>
#include <mutex>
#include <thread>
#include <utility>

#include <asio/executor_work_guard.hpp>
#include <asio/io_context.hpp>
#include <asio/ip/address.hpp>
#include <asio/ip/tcp.hpp>
#include <asio/ip/udp.hpp>
#include <asio/post.hpp>
#include <asio/serial_port.hpp>
#include <asio/steady_timer.hpp>

#include "base/clock.hpp"
#include "runtime/lane.hpp"
#include "runtime/refusal_log.hpp"
#include "runtime/reopening.hpp"
#include "runtime/serial/serial_line.hpp"

namespace fathom::runtime {
namespace {

using asio::ip::tcp;
using asio::ip::udp;

constexpr std::chrono::seconds kConnectTimeout{3};
constexpr std::size_t kPiece = 4096;
constexpr int kMostInKernel = 16 * 1024;

std::string describe(const ByteLinkConfig& config) {
  const std::string endpoint = config.address + ":" + std::to_string(config.port);
  switch (config.type) {
    case LinkType::udp:
      return "udp " + endpoint;
    case LinkType::tcp_client:
      return "tcp " + endpoint;
    case LinkType::serial:
      break;
  }
  return "serial " + config.path;
}

}  // namespace

/// Everything but send(), status() and the ends of its life runs on the thread.
struct ByteLink::Impl {
  Impl(ByteLinkConfig config_in, BytesHandler on_bytes_in, Say say_in)
      : config(std::move(config_in)), on_bytes(std::move(on_bytes_in)), say(std::move(say_in)) {}
  ~Impl() {
    if (!thread.joinable()) return;
    asio::post(io, [this] {
      stopping = true;
      timer.cancel();
      port.stop();
      close();
      io.stop();
    });
    thread.join();
  }

  void start() {
    asio::post(io, [this] { open(); });
    thread = std::thread([this] { io.run(); });
  }

  void open() {
    try {
      switch (config.type) {
        case LinkType::udp:
          return open_udp();
        case LinkType::tcp_client:
          return connect();
        case LinkType::serial:
          return open_serial();
      }
    } catch (const std::exception& error) {
      fail(error.what());
    }
  }

  void open_udp() {
    const auto address = asio::ip::make_address(config.address);
    target = udp::endpoint(address, static_cast<asio::ip::port_type>(config.port));
    datagrams.open(target.protocol());
    datagrams.bind(udp::endpoint(target.protocol(), static_cast<asio::ip::port_type>(config.bind_port)));
    datagrams.non_blocking(true);
    well();
    receive();
  }
  /// Only from whom we speak to.
  void receive() {
    datagrams.async_receive_from(asio::buffer(piece), from,
                                 [this](const asio::error_code& error, std::size_t size) {
                                   if (error == asio::error::operation_aborted) return;
                                   if (error) return fail(error.message());
                                   if (from.address() == target.address()) {
                                     take(size);
                                   } else {
                                     refuse_stranger();
                                   }
                                   receive();
                                 });
  }

  void refuse_stranger() {
    const std::string line = port.name() + ": a datagram from " + from.address().to_string() +
                             " is not heard, expected from " + config.address + " alone";
    if (const auto now = refusals.add("stranger", line, SystemClock().monotonic_ns())) say(true, *now);
  }

  void connect() {
    auto socket = std::make_shared<tcp::socket>(io);
    timer.expires_after(kConnectTimeout);
    timer.async_wait([socket](const asio::error_code& error) {
      asio::error_code ignored;
      if (!error) socket->close(ignored);
    });
    const tcp::endpoint there(asio::ip::make_address(config.address),
                              static_cast<asio::ip::port_type>(config.port));
    socket->async_connect(there, [this, socket](const asio::error_code& error) {
      timer.cancel();
      if (stopping) return;
      if (error) return fail(error == asio::error::operation_aborted ? "no answer" : error.message());
      asio::error_code ignored;
      socket->set_option(tcp::no_delay(true), ignored);
      socket->set_option(asio::socket_base::keep_alive(true), ignored);
      socket->set_option(asio::socket_base::send_buffer_size(kMostInKernel), ignored);
      stream = std::make_shared<Lane<tcp::socket>>(std::move(*socket), flow,
                                                   [this](const std::string& why) { ended(why); });
      well();
      read(stream);
    });
  }

  void open_serial() {
    asio::serial_port port = open_serial_line(io, config.path, config.baud);
    line = std::make_shared<Lane<asio::serial_port>>(std::move(port), flow,
                                                     [this](const std::string& why) { ended(why); });
    well();
    read(line);
  }

  template <class Stream>
  void read(const std::shared_ptr<Lane<Stream>>& lane) {
    lane->stream().async_read_some(asio::buffer(piece),
                                   [this, lane](const asio::error_code& error, std::size_t size) {
                                     if (error == asio::error::operation_aborted) return;
                                     if (error) return lane->end(error.message());
                                     take(size);
                                     read(lane);
                                   });
  }
  void take(std::size_t size) {
    port.begin_anew();
    {
      const std::lock_guard lock(mutex);
      shown.bytes_received += size;
    }
    on_bytes(std::span(piece).first(size));
  }

  void send(const std::shared_ptr<const std::string>& text) {
    if (stream) {
      stream->send(text);
    } else if (line) {
      line->send(text);
    } else if (datagrams.is_open()) {
      asio::error_code error;
      datagrams.send_to(asio::buffer(*text), target, 0, error);
      (error ? flow.dropped : flow.bytes) += text->size();
      const bool passing = error == asio::error::would_block || error == asio::error::no_buffer_space ||
                           error == asio::error::connection_refused;
      if (error && !passing) fail(error.message());
    } else {
      flow.dropped += text->size();
    }
    const std::lock_guard lock(mutex);
    shown.bytes_sent = flow.bytes;
    shown.bytes_dropped = flow.dropped;
  }

  void ended(const std::string& why) {
    if (!why.empty()) fail(why);
  }
  void close() {
    asio::error_code ignored;
    datagrams.close(ignored);
    if (stream) std::exchange(stream, nullptr)->end("");
    if (line) std::exchange(line, nullptr)->end("");
  }
  void fail(const std::string& why) {
    close();
    port.fail(why, [this] { open(); });
  }
  void well() { port.well("open"); }

  const ByteLinkConfig config;
  const BytesHandler on_bytes;
  const Say say;
  asio::io_context io;
  asio::executor_work_guard<asio::io_context::executor_type> work{io.get_executor()};
  asio::steady_timer timer{io};
  Reopening port{io, describe(config), say};
  udp::socket datagrams{io};
  udp::endpoint target;
  udp::endpoint from;
  std::shared_ptr<Lane<tcp::socket>> stream;
  std::shared_ptr<Lane<asio::serial_port>> line;
  std::array<std::uint8_t, kPiece> piece{};
  Flow flow;
  RefusalLog refusals;
  bool stopping = false;
  mutable std::mutex mutex;
  LinkStatus shown;
  std::thread thread;
};

ByteLink::ByteLink(ByteLinkConfig config, BytesHandler on_bytes, Say say)
    : impl_(std::make_unique<Impl>(std::move(config), std::move(on_bytes), std::move(say))) {}
ByteLink::~ByteLink() = default;

void ByteLink::start() {
  impl_->start();
}

void ByteLink::send(std::vector<std::uint8_t> bytes) {
  asio::post(impl_->io, [impl = impl_.get(), text = std::make_shared<const std::string>(
                                                 bytes.begin(), bytes.end())] { impl->send(text); });
}

LinkStatus ByteLink::status() const {
  const std::lock_guard lock(impl_->mutex);
  LinkStatus out = impl_->shown;
  out.name = impl_->port.name();
  out.trouble = impl_->port.trouble();
  return out;
}

}  // namespace fathom::runtime
