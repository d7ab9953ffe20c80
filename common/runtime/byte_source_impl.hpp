#pragma once

// Private to runtime/byte_*.cpp: the only code that includes Asio.

#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <thread>
#include <utility>

#define ASIO_STANDALONE 1
#include <asio/awaitable.hpp>
#include <asio/io_context.hpp>
#include <asio/steady_timer.hpp>

#include "runtime/backoff.hpp"
#include "runtime/byte_share.hpp"
#include "runtime/byte_source.hpp"

namespace fathom::runtime {

struct ByteSource::Impl {
  Impl(ByteSourceConfig config_in, const Clock& clock_in, BytesHandler on_bytes_in, EventHandler on_event_in);

  // The transports. Each returns when its connection has ended in an orderly way and throws when it broke.
  asio::awaitable<void> serve_serial();
  asio::awaitable<void> serve_tcp_client();
  asio::awaitable<void> serve_tcp_server();
  asio::awaitable<void> serve_udp();
  asio::awaitable<void> serve_file();

  asio::awaitable<void> serve();  ///< by the transport that is configured
  asio::awaitable<void>
  serve_shared();  ///< opens the port for others as well, or reads what another hands on
  asio::awaitable<void> follow(asio::posix::stream_descriptor& link);

  asio::awaitable<void> run();    ///< serves and reconnects for ever
  asio::awaitable<void> watch();  ///< notices silence
  asio::awaitable<void> wait(double vehicle_s);

  template <class Stream>
  asio::awaitable<void> read_all(Stream& stream);

  void deliver(std::span<const std::uint8_t> bytes);
  void deliver(std::span<const std::uint8_t> bytes, const Arrival& arrival);
  void change(SourceState state, std::string detail);
  void fail(const std::string& reason);

  const ByteSourceConfig config;
  const Clock& clock;
  const BytesHandler on_bytes;
  const EventHandler on_event;

  asio::io_context io{1};
  std::shared_ptr<PortShare> share;  ///< while this process reads a port for others
  std::thread thread;
  Backoff backoff;
  TimeNs last_byte_ns = 0;  ///< monotonic
  /// Set by a transport that can be broken from outside: watch() calls it when the device has gone unnoticed.
  std::function<bool()> still_there;
  std::function<void()> break_connection;
  /// watch() calls it while nothing comes: a device that was switched off and on waits to be asked again.
  std::function<void()> greet_again;

  mutable std::mutex mutex;  ///< guards status and stopping
  std::condition_variable stop_signal;
  bool stopping = false;
  SourceStatus status;
  bool reported = false;  ///< a state has been reported at all
};

}  // namespace fathom::runtime
