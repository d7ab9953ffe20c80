#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "base/clock.hpp"
#include "bus/participant.hpp"
#include "bus/ros2/node.hpp"
#include "config/doors/ros2_gateway_config.hpp"
#include "ros2/input/door.hpp"
#include "ros2/input/samples.hpp"
#include "runtime/log.hpp"

namespace fathom::ros2_gateway {

/// What one topic has brought.
struct InputCounts {
  std::uint64_t samples = 0;
  std::array<std::uint64_t, ros2::kRefusals> refused{};  ///< by ros2::Refusal
  std::uint64_t not_written = 0;
  TimeNs last_ns = 0;  ///< monotonic, of the last sample; 0: none yet
};

/// An instrument of the vehicle that is a topic of ROS 2.
class Input {
 public:
  virtual ~Input() = default;
  [[nodiscard]] virtual const config::RosInputConfig& config() const = 0;
  [[nodiscard]] virtual InputCounts counts() const = 0;
  [[nodiscard]] virtual int matched_publishers() const = 0;
};

struct InputSurroundings {
  bus::Participant& vehicle_network;
  bus::ros2::Node& node;
  const Clock& clock;
  runtime::Log& log;
  std::string vehicle;
  std::string name_space;
  double clock_rate = 1.0;
  ros2::PoseRule poses;  ///< how poses in map are places; its origin counts where an input is one
};

/// Throws bus::BusError.
[[nodiscard]] std::vector<std::unique_ptr<Input>> make_inputs(
    const std::vector<config::RosInputConfig>& configs, const InputSurroundings& surroundings);

}  // namespace fathom::ros2_gateway
