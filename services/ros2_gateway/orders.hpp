#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <string>

#include "bus/ros2/node.hpp"
#include "bus/writer.hpp"
#include "host/service_host.hpp"
#include "ros2/messages/geometry.hpp"
#include "samples/command.hpp"
#include "samples/nav_state.hpp"
#include "samples/position/fix.hpp"

namespace fathom::ros2_gateway {

/// Orders that come as text on a topic of ROS 2, in the words of the console. What became of each is said on
/// the topic's answer: JSON with "accepted", "text" and "confirm", which is true where the order waits to be
/// given once more, confirmed.
class Orders {
 public:
  /// `topic`: its full name. Throws bus::BusError.
  Orders(host::ServiceHost& host, bus::ros2::Node& node, const std::string& topic);

  /// Where navigation is: a position far from it has to be confirmed. Any thread.
  void heard(const NavState& state);
  [[nodiscard]] std::uint64_t passed_on() const { return passed_on_; }
  [[nodiscard]] std::uint64_t refused() const { return refused_; }

 private:
  void take(const std::string& text);

  host::ServiceHost& host_;
  std::atomic<std::uint64_t> passed_on_ = 0;
  std::atomic<std::uint64_t> refused_ = 0;
  std::mutex mutex_;  // of the state
  NavState state_;
  std::uint64_t sequence_ = 0;  // of the handler, which is one
  bus::Writer<Command> commands_;
  bus::Writer<FixSample> fixes_;
  bus::ros2::Publisher<ros2::String> answers_;
  bus::ros2::Subscription<ros2::String> subscription_;  // last: it hands over to all of the above
};

}  // namespace fathom::ros2_gateway
