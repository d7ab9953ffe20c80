#include "bench/doors/listeners.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cstring>
#include <functional>
#include <span>
#include <string_view>
#include <thread>
#include <utility>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include "base/clock.hpp"
#include "bus/ros2/node.hpp"
#include "mavlink/frame.hpp"
#include "mavlink/messages.hpp"
#include "ros2/messages/geometry.hpp"
#include "support/free_port.hpp"
#include "support/presence.hpp"

namespace fathom::test {
namespace {

using Datagram = std::span<const std::uint8_t>;

/// Hands over each datagram, or piece of a stream, with its arrival.
class SocketListener final : public Listener {
 public:
  SocketListener(int socket, bool is_open, std::function<void(Datagram, TimeNs)> with)
      : socket_(socket), open_(is_open), with_(std::move(with)) {
    thread_ = std::thread([this] { run(); });
  }
  ~SocketListener() override {
    stop_ = true;
    thread_.join();
    close(socket_);
  }
  [[nodiscard]] bool connected() const override { return open_; }

  /// Of datagrams to a port of this host.
  static std::unique_ptr<Listener> of_port(int port, std::function<void(Datagram, TimeNs)> with) {
    const int descriptor = socket(AF_INET, SOCK_DGRAM, 0);
    const sockaddr_in address = loopback(port);
    const bool bound = bind(descriptor, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
    return std::make_unique<SocketListener>(descriptor, bound, std::move(with));
  }

 private:
  void run() {
    std::array<std::uint8_t, 2048> bytes{};
    while (!stop_) {
      pollfd one{socket_, POLLIN, 0};
      if (poll(&one, 1, 50) <= 0) continue;
      const ssize_t size = recv(socket_, bytes.data(), bytes.size(), 0);
      if (size > 0) with_(Datagram(bytes.data(), static_cast<std::size_t>(size)), clock_.utc_ns());
    }
  }

  SystemClock clock_;
  int socket_;
  bool open_;
  std::function<void(Datagram, TimeNs)> with_;
  std::atomic<bool> stop_ = false;
  std::thread thread_;
};

class Ros2Listener final : public Listener {
 public:
  Ros2Listener(std::uint32_t domain, Arrivals& arrivals)
      : graph_(options(domain)),
        node_(graph_, {"/", "doors_bench", ros2::Distro::jazzy}),
        odometry_(node_, "/fathom/odometry", bus::ros2::Quality::reliable,
                  [this, &arrivals](const ros2::Odometry& message, const bus::SampleInfo&) {
                    const TimeNs stamp_ns =
                        message.header.stamp.sec * kNsPerSecond + message.header.stamp.nanosec;
                    arrivals.heard(Arrivals::key(stamp_ns), clock_.utc_ns());
                  }) {}
  [[nodiscard]] bool connected() const override { return odometry_.matched_publishers() > 0; }

 private:
  static bus::ParticipantOptions options(std::uint32_t domain) {
    bus::ParticipantOptions out = presence(domain, "doors_bench");
    out.user_data = bus::ros2::kUserData;
    return out;
  }

  SystemClock clock_;
  bus::Participant graph_;
  bus::ros2::Node node_;
  bus::ros2::Subscription<ros2::Odometry> odometry_;
};

}  // namespace

SocketHop::SocketHop(Kind kind, std::size_t bytes)
    : bytes_(std::max(bytes, sizeof key_)),
      socket_(socket(AF_INET, kind == Kind::tcp ? SOCK_STREAM : SOCK_DGRAM, 0)) {
  const auto with = [this](Datagram heard, TimeNs now_ns) {
    std::int64_t key = 0;
    if (heard.size() < sizeof key) return;
    std::memcpy(&key, heard.data(), sizeof key);
    arrivals_.heard(key, now_ns);
  };
  const int type = kind == Kind::tcp ? SOCK_STREAM : SOCK_DGRAM;
  const sockaddr_in to = loopback(free_port(type));
  const auto* address = reinterpret_cast<const sockaddr*>(&to);
  int receiving = socket(AF_INET, type, 0);
  bool met = bind(receiving, address, sizeof to) == 0;
  if (kind == Kind::tcp) {
    const int listening = receiving;
    met = met && listen(listening, 1) == 0 && connect(socket_, address, sizeof to) == 0;
    receiving = met ? accept(listening, nullptr, nullptr) : -1;
    close(listening);
    const int on = 1;
    (void)setsockopt(socket_, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
  } else {
    met = met && connect(socket_, address, sizeof to) == 0;
  }
  listener_ = std::make_unique<SocketListener>(receiving, met && receiving >= 0, with);
}

SocketHop::~SocketHop() {
  listener_.reset();
  close(socket_);
}

void SocketHop::send() {
  ++key_;
  std::memcpy(bytes_.data(), &key_, sizeof key_);
  arrivals_.said(key_ * kNsPerMillisecond, SystemClock().utc_ns());
  (void)::send(socket_, bytes_.data(), bytes_.size(), MSG_NOSIGNAL);
}

void Arrivals::said(TimeNs stamp_ns, TimeNs now_ns) {
  const std::lock_guard lock(mutex_);
  said_ns_[key(stamp_ns)] = now_ns;
}

void Arrivals::heard(std::int64_t key, TimeNs now_ns) {
  const std::lock_guard lock(mutex_);
  const auto at = said_ns_.find(key);
  if (at == said_ns_.end()) return;
  through_us_.push_back(1e-3 * static_cast<double>(now_ns - at->second));
  said_ns_.erase(at);
}

std::vector<double> Arrivals::take_us() {
  const std::lock_guard lock(mutex_);
  return std::exchange(through_us_, {});
}

std::unique_ptr<Listener> hear_nmea(int port, Arrivals& arrivals) {
  return SocketListener::of_port(port, [&arrivals](Datagram bytes, TimeNs now_ns) {
    // $GPGGA,hhmmss.sss,
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    constexpr std::size_t kTime = 7;
    if (text.size() < kTime + 10 || text.substr(3, 3) != "GGA") return;
    const auto digits = [&](std::size_t at, std::size_t count) {
      return std::stoll(std::string(text.substr(kTime + at, count)));
    };
    arrivals.heard(((digits(0, 2) * 60 + digits(2, 2)) * 60 + digits(4, 2)) * 1000 + digits(7, 3), now_ns);
  });
}

std::unique_ptr<Listener> hear_mavlink(int port, Arrivals& arrivals) {
  return SocketListener::of_port(port, [&arrivals](Datagram bytes, TimeNs now_ns) {
    const auto look = mavlink::look_at(bytes);
    if (look.kind != mavlink::Look::Kind::frame || look.frame.id != mavlink::Odometry::kId) return;
    const auto odometry = mavlink::message_of<mavlink::Odometry>(look.frame.payload);
    arrivals.heard(Arrivals::key(static_cast<TimeNs>(odometry.time_usec) * 1000), now_ns);
  });
}

std::unique_ptr<Listener> hear_ros2(std::uint32_t domain, Arrivals& arrivals) {
  return std::make_unique<Ros2Listener>(domain, arrivals);
}

}  // namespace fathom::test
