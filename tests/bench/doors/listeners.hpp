#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "base/time.hpp"

/// Who hears navigation behind a door, each in the words of its own world.
namespace fathom::test {

/// How long what was said took to be heard. A state is known by its stamp in whole milliseconds of the day,
/// which is what all doors tell.
class Arrivals {
 public:
  static std::int64_t key(TimeNs stamp_ns) { return stamp_ns / kNsPerMillisecond % 86'400'000; }

  void said(TimeNs stamp_ns, TimeNs now_ns);
  void heard(std::int64_t key, TimeNs now_ns);
  /// us, of everything since the last call.
  [[nodiscard]] std::vector<double> take_us();

 private:
  std::mutex mutex_;
  std::map<std::int64_t, TimeNs> said_ns_;
  std::vector<double> through_us_;
};

class Listener {
 public:
  virtual ~Listener() = default;
  /// There is a connection, where the door has such a thing.
  [[nodiscard]] virtual bool connected() const = 0;
};

/// Sends bytes to itself, a key in front of them: what a socket costs that nothing stands behind.
class SocketHop {
 public:
  enum class Kind { udp, tcp };
  SocketHop(Kind kind, std::size_t bytes);
  ~SocketHop();
  SocketHop(const SocketHop&) = delete;
  SocketHop& operator=(const SocketHop&) = delete;

  void send();
  /// us, of everything since the last call.
  [[nodiscard]] std::vector<double> take_us() { return arrivals_.take_us(); }

 private:
  Arrivals arrivals_;
  std::vector<std::uint8_t> bytes_;
  std::int64_t key_ = 0;
  int socket_;
  std::unique_ptr<Listener> listener_;
};

/// GGA by UDP.
[[nodiscard]] std::unique_ptr<Listener> hear_nmea(int port, Arrivals& arrivals);
/// ODOMETRY by UDP.
[[nodiscard]] std::unique_ptr<Listener> hear_mavlink(int port, Arrivals& arrivals);
/// fathom/v1/nav_state by WebSocket, as Foxglove asks for it.
[[nodiscard]] std::unique_ptr<Listener> hear_foxglove(int port, Arrivals& arrivals);
/// nav_msgs/Odometry in a graph of ROS 2.
[[nodiscard]] std::unique_ptr<Listener> hear_ros2(std::uint32_t domain, Arrivals& arrivals);

}  // namespace fathom::test
