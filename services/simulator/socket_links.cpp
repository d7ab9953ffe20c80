#include <array>
#include <cerrno>
#include <cstring>
#include <vector>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>

#include "simulator/device_link.hpp"
#include "simulator/file_descriptor.hpp"

namespace fathom::simulator {
namespace {

std::string endpoint_text(const char* scheme, const std::string& address, int port) {
  return std::string(scheme) + address + ":" + std::to_string(port);
}

sockaddr_in endpoint(const std::string& address, int port, const std::string& where) {
  sockaddr_in out{};
  out.sin_family = AF_INET;
  out.sin_port = htons(static_cast<std::uint16_t>(port));
  if (port < 1 || port > 65535) throw LinkError(where + ": port outside 1 to 65535");
  if (::inet_pton(AF_INET, address.c_str(), &out.sin_addr) != 1) {
    throw LinkError(where + ": not a numeric IPv4 address");
  }
  return out;
}

class TcpLink final : public DeviceLink {
 public:
  TcpLink(const std::string& address, int port) : where_(endpoint_text("tcp://", address, port)) {
    const sockaddr_in at = endpoint(address, port, where_);
    listener_ = FileDescriptor(::socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
    const int yes = 1;
    ::setsockopt(listener_.get(), SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    if (!listener_.valid() ||
        ::bind(listener_.get(), reinterpret_cast<const sockaddr*>(&at), sizeof at) != 0 ||
        ::listen(listener_.get(), 8) != 0) {
      throw LinkError(where_ + ": " + std::strerror(errno));
    }
  }

  void poll() override {
    while (clients_.size() < kMostClients) {
      FileDescriptor client(::accept4(listener_.get(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC));
      if (!client.valid()) return;
      const int yes = 1;
      ::setsockopt(client.get(), IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
      clients_.push_back({std::move(client), {}});
    }
  }

  void send(std::span<const std::uint8_t> bytes) override {
    poll();
    std::erase_if(clients_, [&](Client& client) { return !serve(client, bytes); });
    counters_.peers = clients_.size();
  }

  [[nodiscard]] LinkCounters counters() const override { return counters_; }
  [[nodiscard]] std::string where() const override { return where_; }

 private:
  struct Client {
    FileDescriptor socket;
    std::vector<std::uint8_t> rest;  ///< of a message that went only in part
  };
  static constexpr std::size_t kMostClients = 16;

  // Sends what it can; false when the client is gone.
  bool flush(Client& client) {
    while (!client.rest.empty()) {
      const ssize_t sent = ::send(client.socket.get(), client.rest.data(), client.rest.size(), MSG_NOSIGNAL);
      if (sent < 0) return errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR;
      counters_.bytes_sent += static_cast<std::uint64_t>(sent);
      client.rest.erase(client.rest.begin(), client.rest.begin() + sent);
    }
    return true;
  }

  bool serve(Client& client, std::span<const std::uint8_t> bytes) {
    std::array<char, 256> ignored{};
    ssize_t received = 0;
    while ((received = ::recv(client.socket.get(), ignored.data(), ignored.size(), 0)) > 0) {
    }
    if (received == 0 || (errno != EAGAIN && errno != EWOULDBLOCK && errno != EINTR)) return false;
    if (!flush(client)) return false;
    if (!client.rest.empty()) {  // still behind: this message is lost for it
      counters_.bytes_dropped += bytes.size();
      return true;
    }
    client.rest.assign(bytes.begin(), bytes.end());
    return flush(client);
  }

  std::string where_;
  FileDescriptor listener_;
  std::vector<Client> clients_;
  LinkCounters counters_;
};

class UdpLink final : public DeviceLink {
 public:
  UdpLink(const std::string& address, int port) : where_(endpoint_text("udp://", address, port)) {
    to_ = endpoint(address, port, where_);
    socket_ = FileDescriptor(::socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
    if (!socket_.valid()) throw LinkError(where_ + ": " + std::strerror(errno));
    counters_.peers = 1;
  }

  void send(std::span<const std::uint8_t> bytes) override {
    // Not connected: the refusals of a port that nobody has open do not come back as errors.
    const ssize_t sent = ::sendto(socket_.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL,
                                  reinterpret_cast<const sockaddr*>(&to_), sizeof to_);
    (sent < 0 ? counters_.bytes_dropped : counters_.bytes_sent) += bytes.size();
  }

  [[nodiscard]] LinkCounters counters() const override { return counters_; }
  [[nodiscard]] std::string where() const override { return where_; }

 private:
  std::string where_;
  sockaddr_in to_{};
  FileDescriptor socket_;
  LinkCounters counters_;
};

}  // namespace

std::unique_ptr<DeviceLink> make_tcp_link(const std::string& address, int port) {
  return std::make_unique<TcpLink>(address, port);
}

std::unique_ptr<DeviceLink> make_udp_link(const std::string& address, int port) {
  return std::make_unique<UdpLink>(address, port);
}

std::unique_ptr<DeviceLink> make_link(const sim::LinkConfig& config, const std::string& link_dir,
                                      int port_offset, const Clock& clock) {
  switch (config.type) {
    case sim::LinkConfig::Type::pty:
      return make_pty_link(link_dir + "/" + config.path, clock);
    case sim::LinkConfig::Type::tcp_server:
      return make_tcp_link(config.address, config.port + port_offset);
    case sim::LinkConfig::Type::udp:
      break;
  }
  return make_udp_link(config.address, config.port + port_offset);
}

}  // namespace fathom::simulator
