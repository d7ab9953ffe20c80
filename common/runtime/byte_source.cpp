#include "runtime/byte_source.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <exception>
#include <stdexcept>
#include <utility>
#include <vector>

#include <arpa/inet.h>
#include <asio/buffer.hpp>
#include <asio/co_spawn.hpp>
#include <asio/detached.hpp>
#include <asio/redirect_error.hpp>
#include <asio/use_awaitable.hpp>

#include "runtime/byte_source_impl.hpp"

namespace fathom::runtime {

std::string_view to_string(Framing framing) {
  static constexpr std::array<std::string_view, 5> kWords{"8N1", "8E1", "8O1", "7E1", "7O1"};
  return kWords[static_cast<std::size_t>(framing)];
}

std::string_view to_string(SourceState state) {
  static constexpr std::array<std::string_view, 4> kWords{"lost", "connected", "silent", "finished"};
  const auto index = static_cast<std::size_t>(state);
  return index < kWords.size() ? kWords[index] : std::string_view("unknown");
}

std::string describe_source(const ByteSourceConfig& config) {
  const std::string endpoint = config.address + ":" + std::to_string(config.port);
  switch (config.type) {
    case SourceType::serial:
      return "serial " + config.path;
    case SourceType::tcp_client:
      return "tcp " + endpoint;
    case SourceType::tcp_server:
      return "tcp server " + endpoint;
    case SourceType::udp:
      return "udp " + endpoint + (config.multicast.empty() ? "" : " group " + config.multicast);
    case SourceType::file:
      break;
  }
  return "file " + config.path;
}

bool same_port(const ByteSourceConfig& one, const ByteSourceConfig& other) {
  return one.type == other.type && one.type != SourceType::file &&
         describe_source(one) == describe_source(other) &&
         (one.type != SourceType::serial || (one.baud == other.baud && one.framing == other.framing));
}

bool collide(const ByteSourceConfig& one, const ByteSourceConfig& other) {
  if (one.type != other.type || (one.shared && other.shared && same_port(one, other))) return false;
  if (one.type == SourceType::serial) return !one.path.empty() && one.path == other.path;
  if (one.type != SourceType::udp && one.type != SourceType::tcp_server) return false;
  if (one.port == 0 || one.port != other.port) return false;
  // Any number of readers may join one group.
  if (!one.multicast.empty() && !other.multicast.empty()) return false;
  const auto bound = [](const ByteSourceConfig& each) {
    return each.multicast.empty() ? each.address : each.multicast;
  };
  const auto is_any = [](const std::string& address) { return address == "0.0.0.0" || address == "::"; };
  return bound(one) == bound(other) || is_any(bound(one)) || is_any(bound(other));
}

bool is_multicast_address(const std::string& text) {
  in_addr four{};
  in6_addr six{};
  if (inet_pton(AF_INET, text.c_str(), &four) == 1) return IN_MULTICAST(ntohl(four.s_addr));
  return inet_pton(AF_INET6, text.c_str(), &six) == 1 && IN6_IS_ADDR_MULTICAST(&six);
}

bool is_numeric_address(const std::string& text) {
  std::array<unsigned char, sizeof(in6_addr)> out{};
  return inet_pton(AF_INET, text.c_str(), out.data()) == 1 ||
         inet_pton(AF_INET6, text.c_str(), out.data()) == 1;
}

ByteSource::Impl::Impl(ByteSourceConfig config_in, const Clock& clock_in, BytesHandler on_bytes_in,
                       EventHandler on_event_in)
    : config(std::move(config_in)),
      clock(clock_in),
      on_bytes(std::move(on_bytes_in)),
      on_event(std::move(on_event_in)),
      backoff(config.backoff_first_s, config.backoff_most_s) {}

void ByteSource::Impl::deliver(std::span<const std::uint8_t> bytes) {
  if (share) share->tell({ShareMessage::Kind::bytes, SystemClock().monotonic_ns(), bytes});
  deliver(bytes, {clock.utc_ns(), clock.monotonic_ns()});
}

void ByteSource::Impl::deliver(std::span<const std::uint8_t> bytes, const Arrival& arrival) {
  last_byte_ns = arrival.monotonic_ns;
  backoff.reset();
  bool was_silent = false;
  {
    const std::lock_guard lock(mutex);
    status.bytes += bytes.size();
    was_silent = status.state == SourceState::silent;
  }
  if (was_silent) change(SourceState::connected, describe_source(config) + ": bytes again");
  on_bytes(bytes, arrival);
}

void ByteSource::Impl::change(SourceState state, std::string detail) {
  if (share && (state == SourceState::connected || state == SourceState::lost)) {
    const auto kind = state == SourceState::lost ? ShareMessage::Kind::lost : ShareMessage::Kind::connected;
    share->tell({kind, 0, std::span(reinterpret_cast<const std::uint8_t*>(detail.data()), detail.size())});
  }
  {
    const std::lock_guard lock(mutex);
    const bool fresh = !reported || status.state != state;
    if (state == SourceState::connected && status.state != SourceState::silent) ++status.connects;
    status.state = state;
    status.detail = detail;
    reported = true;
    if (!fresh) return;
  }
  if (on_event) on_event(SourceEvent{state, std::move(detail)});
}

void ByteSource::Impl::fail(const std::string& reason) {
  {
    const std::lock_guard lock(mutex);
    ++status.errors;
  }
  change(SourceState::lost, describe_source(config) + ": " + reason);
}

asio::awaitable<void> ByteSource::Impl::wait(double vehicle_s) {
  asio::steady_timer timer(io);
  timer.expires_after(std::chrono::nanoseconds(from_seconds(vehicle_s / clock.rate())));
  co_await timer.async_wait(asio::use_awaitable);
}

asio::awaitable<void> ByteSource::Impl::serve() {
  switch (config.type) {
    case SourceType::serial:
      return serve_serial();
    case SourceType::tcp_client:
      return serve_tcp_client();
    case SourceType::tcp_server:
      return serve_tcp_server();
    case SourceType::udp:
      return serve_udp();
    case SourceType::file:
      break;
  }
  return serve_file();
}

asio::awaitable<void> ByteSource::Impl::serve_shared() {
  constexpr int kAttempts = 20;  // while the process that has the port begins or ends
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    share = PortShare::claim(io, config);
    if (share) {
      share->start();
      co_await serve();
      co_return;
    }
    if (const auto link = PortShare::join(io, config)) {
      co_await follow(*link);
      co_return;
    }
    co_await wait(0.05 * clock.rate());
  }
  throw std::runtime_error("another process has it and lets nobody read");
}

asio::awaitable<void> ByteSource::Impl::follow(asio::posix::stream_descriptor& link) {
  constexpr DurationNs kOldest = 10 * kNsPerSecond;
  std::vector<std::uint8_t> buffer(kLongestSharePacket);
  last_byte_ns = clock.monotonic_ns();
  std::string why = "the process that read it for others is gone";
  for (;;) {
    asio::error_code ended;
    const std::size_t size =
        co_await link.async_read_some(asio::buffer(buffer), asio::redirect_error(asio::use_awaitable, ended));
    if (ended || size == 0) throw std::runtime_error(why);
    const auto message = unpack(std::span(buffer).first(size));
    if (!message) throw std::runtime_error("the process that reads it speaks otherwise");
    const std::string detail(message->payload.begin(), message->payload.end());
    switch (message->kind) {
      case ShareMessage::Kind::connected:
        last_byte_ns = clock.monotonic_ns();
        change(SourceState::connected, detail + ", read by another process");
        break;
      case ShareMessage::Kind::lost:
        if (const std::string own = describe_source(config) + ": "; detail.starts_with(own))
          why = detail.substr(own.size());
        change(SourceState::lost, detail);
        break;
      case ShareMessage::Kind::bytes: {
        const DurationNs host_ns =
            std::clamp(SystemClock().monotonic_ns() - message->host_monotonic_ns, DurationNs{0}, kOldest);
        const auto age_ns = static_cast<DurationNs>(static_cast<double>(host_ns) * clock.rate());
        deliver(message->payload, {clock.utc_ns() - age_ns, clock.monotonic_ns() - age_ns});
        break;
      }
    }
  }
}

asio::awaitable<void> ByteSource::Impl::run() {
  for (;;) {
    std::string reason = "closed by the other side";
    try {
      if (config.type == SourceType::file) {
        co_await serve_file();
        change(SourceState::finished, describe_source(config) + ": end of file");
        co_return;
      }
      if (config.shared) {
        co_await serve_shared();
      } else {
        co_await serve();
      }
    } catch (const asio::system_error& error) {
      reason = error.code().message();
    } catch (const std::exception& error) {
      reason = error.what();
    }
    still_there = nullptr;
    break_connection = nullptr;
    greet_again = nullptr;
    fail(reason);
    if (share) std::exchange(share, nullptr)->close();
    co_await wait(backoff.next_s());
  }
}

asio::awaitable<void> ByteSource::Impl::watch() {
  // A file's gaps are those of the recording.
  if (config.type == SourceType::file || config.silence_s <= 0.0) co_return;
  for (;;) {
    co_await wait(std::clamp(config.silence_s / 4.0, 0.05, 1.0));
    SourceState state{};
    {
      const std::lock_guard lock(mutex);
      state = status.state;
    }
    if (state != SourceState::connected && state != SourceState::silent) continue;
    if (clock.monotonic_ns() - last_byte_ns < from_seconds(config.silence_s)) continue;
    // A USB adapter can vanish without an error on the open file.
    if (still_there && !still_there() && break_connection) {
      break_connection();
      continue;
    }
    if (state == SourceState::connected)
      change(SourceState::silent, describe_source(config) + ": connected, but no bytes");
    if (greet_again) greet_again();
  }
}

ByteSource::ByteSource(ByteSourceConfig config, const Clock& clock, BytesHandler on_bytes,
                       EventHandler on_event)
    : impl_(std::make_unique<Impl>(std::move(config), clock, std::move(on_bytes), std::move(on_event))) {}

ByteSource::~ByteSource() {
  {
    const std::lock_guard lock(impl_->mutex);
    impl_->stopping = true;
  }
  impl_->stop_signal.notify_all();
  impl_->io.stop();
  if (impl_->thread.joinable()) impl_->thread.join();
}

void ByteSource::start() {
  Impl& impl = *impl_;
  asio::co_spawn(impl.io, impl.run(), asio::detached);
  asio::co_spawn(impl.io, impl.watch(), asio::detached);
  impl.thread = std::thread([&impl] { impl.io.run(); });
}

SourceStatus ByteSource::status() const {
  const std::lock_guard lock(impl_->mutex);
  return impl_->status;
}

void ByteSource::hold(DurationNs vehicle_ns) {
  const auto host_ns = static_cast<double>(vehicle_ns) / impl_->clock.rate();
  std::unique_lock lock(impl_->mutex);
  impl_->stop_signal.wait_for(lock, std::chrono::nanoseconds(static_cast<DurationNs>(host_ns)),
                              [this] { return impl_->stopping; });
}

}  // namespace fathom::runtime
