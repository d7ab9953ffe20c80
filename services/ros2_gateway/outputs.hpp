#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "bus/ros2/node.hpp"
#include "config/doors/ros2_gateway_config.hpp"
#include "ros2/output/diagnostics.hpp"
#include "samples/nav_state.hpp"

namespace fathom::ros2_gateway {

/// What has been said so far.
struct OutputCounts {
  std::uint64_t states = 0;         ///< taken
  std::uint64_t published = 0;      ///< messages
  std::uint64_t not_published = 0;  ///< failed to be written
  std::uint64_t unusable = 0;       ///< states without a position, or without an uncertainty
  std::uint64_t back_in_time = 0;   ///< states left out because a later one was said
  std::uint64_t begun_anew = 0;     ///< times that the clock was set back
  std::string unusable_text;        ///< why the last state was; empty when it was not
};

/// Navigation as messages of ROS 2.
class Outputs {
 public:
  /// `now_ns`: of the stamp of what is latched at once.
  Outputs(bus::ros2::Node& node, const config::Ros2GatewayConfig& config, TimeNs now_ns);
  ~Outputs();
  Outputs(const Outputs&) = delete;
  Outputs& operator=(const Outputs&) = delete;

  /// One thread at a time. `monotonic_ns` is of the vehicle's clock.
  void take(const NavState& state, TimeNs monotonic_ns);
  /// Any thread.
  void diagnostics(const ros2::DiagnosticArray& message);
  [[nodiscard]] OutputCounts counts() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace fathom::ros2_gateway
