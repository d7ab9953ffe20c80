#include "nmea_out/outlet.hpp"

#include <array>
#include <list>
#include <mutex>
#include <thread>
#include <utility>

#include <asio/executor_work_guard.hpp>
#include <asio/io_context.hpp>
#include <asio/ip/address.hpp>
#include <asio/ip/multicast.hpp>
#include <asio/ip/tcp.hpp>
#include <asio/ip/udp.hpp>
#include <asio/post.hpp>
#include <asio/serial_port.hpp>

#include "base/clock.hpp"
#include "runtime/lane.hpp"
#include "runtime/refusal_log.hpp"
#include "runtime/reopening.hpp"
#include "runtime/serial/serial_line.hpp"

namespace fathom::nmea_out {
namespace {

using asio::ip::tcp;
using asio::ip::udp;
using config::NmeaOutputConfig;
using config::NmeaOutputType;
using Text = std::shared_ptr<const std::string>;

constexpr int kMostInKernel = 16 * 1024;

std::string describe(const NmeaOutputConfig& config) {
  const std::string endpoint = config.address + ":" + std::to_string(config.port);
  switch (config.type) {
    case NmeaOutputType::udp:
      return "udp " + endpoint;
    case NmeaOutputType::tcp_server:
      return "tcp server " + endpoint;
    case NmeaOutputType::serial:
      break;
  }
  return "serial " + config.path;
}

/// One way out. Everything but send() and status() runs on the outlets' thread.
class Outlet {
 public:
  Outlet(asio::io_context& io_in, NmeaOutputConfig config_in, const Outlets::Say& say)
      : io(io_in), config(std::move(config_in)), port(io, describe(config), say), say_(say) {}
  virtual ~Outlet() = default;
  Outlet(const Outlet&) = delete;
  Outlet& operator=(const Outlet&) = delete;

  void start() {
    try {
      open();
      port.begin_anew();
      port.well();
    } catch (const std::exception& error) {
      fail(error.what());
    }
  }
  /// Returns at once. Any thread, one at a time.
  virtual void send(Text text) {
    asio::post(io, [this, text = std::move(text)] { say(text); });
  }
  virtual void stop() { port.stop(); }

  [[nodiscard]] OutletStatus status() const {
    const std::lock_guard lock(mutex);
    OutletStatus out = shown;
    out.name = port.name();
    out.trouble = port.trouble();
    return out;
  }

 protected:
  virtual void say(const Text& text) = 0;
  virtual void open() = 0;
  virtual void close() = 0;

  /// Closes, says why once, and opens again after a while.
  void fail(const std::string& why) {
    close();
    port.fail(why, [this] { start(); });
  }
  void show(const runtime::Flow& flow, int clients = 0) {
    const std::lock_guard lock(mutex);
    shown.bytes = flow.bytes;
    shown.dropped = flow.dropped;
    shown.clients = clients;
  }
  void note_refused(const std::string& line) {
    if (const auto now = refusals_.add("full", line, SystemClock().monotonic_ns())) say_(true, *now);
    const std::lock_guard lock(mutex);
    ++shown.clients_refused;
  }

  asio::io_context& io;
  const NmeaOutputConfig config;
  runtime::Reopening port;

 private:
  const Outlets::Say say_;
  runtime::RefusalLog refusals_;
  mutable std::mutex mutex;
  OutletStatus shown;
};

/// A datagram for each text, by whoever says it: nobody has to wake up for that, and nobody waits. A socket
/// that cannot send now loses it.
class UdpOutlet final : public Outlet {
 public:
  using Outlet::Outlet;

  void send(Text text) override {
    const std::shared_ptr<udp::socket> socket = shared();
    if (!socket) return;
    asio::error_code error;
    socket->send_to(asio::buffer(*text), target, 0, error);
    if (error == asio::error::would_block || error == asio::error::no_buffer_space) {
      flow.dropped += text->size();
    } else if (error) {
      asio::post(io, [this, socket, why = error.message()] {
        if (shared() == socket) fail(why);
      });
    } else {
      flow.bytes += text->size();
    }
    show(flow);
  }

 private:
  void say(const Text& /*text*/) override {}
  /// Nothing while it is closed. Whoever sends keeps the socket open for as long.
  [[nodiscard]] std::shared_ptr<udp::socket> shared() const {
    const std::lock_guard lock(socket_mutex);
    return current;
  }
  void open() override {
    const auto address = asio::ip::make_address(config.address);
    if (target.port() == 0) target = udp::endpoint(address, static_cast<asio::ip::port_type>(config.port));
    auto opened = std::make_shared<udp::socket>(io);
    udp::socket& socket = *opened;
    socket.open(target.protocol());
    socket.non_blocking(true);
    if (address.is_v4()) socket.set_option(asio::socket_base::broadcast(true));
    if (!config.interface.empty()) {
      const auto from = asio::ip::make_address(config.interface);
      if (address.is_multicast() && from.is_v4())
        socket.set_option(asio::ip::multicast::outbound_interface(from.to_v4()));
      socket.bind(udp::endpoint(from, 0));
    }
    const std::lock_guard lock(socket_mutex);
    current = std::move(opened);
  }
  void close() override {
    const std::lock_guard lock(socket_mutex);
    current.reset();
  }

  mutable std::mutex socket_mutex;  // of the pointer
  std::shared_ptr<udp::socket> current;
  udp::endpoint target;  // set before the first socket is there
  runtime::Flow flow;    // of whoever says
};

/// Every client gets everything; what clients say is read and thrown away.
class TcpOutlet final : public Outlet {
 public:
  using Outlet::Outlet;

  void say(const Text& text) override {
    // A client may end while it is sent to.
    for (auto next = clients.begin(); next != clients.end();) {
      const auto client = *next++;
      client->send(text);
    }
    show(flow, static_cast<int>(clients.size()));
  }
  void stop() override {
    Outlet::stop();
    close();
  }

 private:
  using Client = runtime::Lane<tcp::socket>;

  void open() override {
    const tcp::endpoint here(asio::ip::make_address(config.address),
                             static_cast<asio::ip::port_type>(config.port));
    acceptor.open(here.protocol());
    acceptor.set_option(asio::socket_base::reuse_address(true));
    acceptor.bind(here);
    acceptor.listen();
    accept();
  }
  void close() override {
    asio::error_code ignored;
    acceptor.close(ignored);
    for (const auto& client : std::exchange(clients, {})) client->end("");
  }

  void accept() {
    acceptor.async_accept([this](const asio::error_code& error, tcp::socket socket) {
      if (error == asio::error::operation_aborted) return;
      if (error) return fail(error.message());
      if (clients.size() < static_cast<std::size_t>(config.most_clients)) {
        add(std::move(socket));
      } else {
        refuse(socket);
      }
      accept();
    });
  }
  void refuse(const tcp::socket& socket) {
    asio::error_code gone;
    const std::string peer = socket.remote_endpoint(gone).address().to_string();
    note_refused(port.name() + ": a client from " + peer + " was refused: " + std::to_string(clients.size()) +
                 " are connected, expected at most that many (most_clients)");
  }
  void add(tcp::socket socket) {
    asio::error_code ignored;
    socket.set_option(tcp::no_delay(true), ignored);
    socket.set_option(asio::socket_base::keep_alive(true), ignored);
    // What waits in the kernel is old when it is read.
    socket.set_option(asio::socket_base::send_buffer_size(kMostInKernel), ignored);
    const auto place = clients.emplace(clients.end());
    // The client leaves the list by itself, once, unless the list was emptied before.
    *place = std::make_shared<Client>(std::move(socket), flow, [this, place](const std::string& why) {
      if (!why.empty()) clients.erase(place);
    });
    read(*place);
  }
  /// Until the client goes.
  void read(const std::shared_ptr<Client>& client) {
    client->stream().async_read_some(asio::buffer(thrown_away),
                                     [this, client](const asio::error_code& error, std::size_t) {
                                       if (error == asio::error::operation_aborted) return;
                                       if (error) return client->end(error.message());
                                       read(client);
                                     });
  }

  tcp::acceptor acceptor{io};
  std::list<std::shared_ptr<Client>> clients;
  std::array<char, 512> thrown_away{};
  runtime::Flow flow;
};

class SerialOutlet final : public Outlet {
 public:
  using Outlet::Outlet;

  void say(const Text& text) override {
    if (lane) lane->send(text);
    show(flow);
  }
  void stop() override {
    Outlet::stop();
    close();
  }

 private:
  void open() override {
    asio::serial_port port = runtime::open_serial_line(io, config.path, config.baud);
    lane = std::make_shared<runtime::Lane<asio::serial_port>>(std::move(port), flow,
                                                              [this](const std::string& why) {
                                                                if (!why.empty()) fail(why);
                                                              });
  }
  void close() override {
    if (lane) std::exchange(lane, nullptr)->end("");
  }

  std::shared_ptr<runtime::Lane<asio::serial_port>> lane;
  runtime::Flow flow;
};

std::unique_ptr<Outlet> make(asio::io_context& io, const NmeaOutputConfig& config, const Outlets::Say& say) {
  switch (config.type) {
    case NmeaOutputType::udp:
      return std::make_unique<UdpOutlet>(io, config, say);
    case NmeaOutputType::tcp_server:
      return std::make_unique<TcpOutlet>(io, config, say);
    case NmeaOutputType::serial:
      break;
  }
  return std::make_unique<SerialOutlet>(io, config, say);
}

}  // namespace

struct Outlets::Impl {
  Impl(const std::vector<NmeaOutputConfig>& outputs, Say say_in) : say(std::move(say_in)) {
    for (const NmeaOutputConfig& one : outputs) outlets.push_back(make(io, one, say));
    asio::post(io, [this] {
      for (const auto& outlet : outlets) outlet->start();
    });
    thread = std::thread([this] { io.run(); });
  }
  ~Impl() {
    asio::post(io, [this] {
      for (const auto& outlet : outlets) outlet->stop();
      io.stop();
    });
    thread.join();
  }

  const Say say;
  asio::io_context io;
  asio::executor_work_guard<asio::io_context::executor_type> work{io.get_executor()};
  std::vector<std::unique_ptr<Outlet>> outlets;
  std::thread thread;
};

Outlets::Outlets(const std::vector<NmeaOutputConfig>& outputs, Say say)
    : impl_(std::make_unique<Impl>(outputs, std::move(say))) {}
Outlets::~Outlets() = default;

void Outlets::send(std::size_t index, std::string text) {
  impl_->outlets.at(index)->send(std::make_shared<const std::string>(std::move(text)));
}

std::vector<OutletStatus> Outlets::status() const {
  std::vector<OutletStatus> out;
  for (const auto& outlet : impl_->outlets) out.push_back(outlet->status());
  return out;
}

}  // namespace fathom::nmea_out
