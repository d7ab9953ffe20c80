#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>

#include "config/bridge/bridge_config.hpp"
#include "runtime/device_time.hpp"
#include "sim/device_encoder.hpp"
#include "sim/simulation.hpp"

namespace fathom::cli {

/// The way of a simulated measurement through its instrument's bytes, without a network: device encoder,
/// codec, device clock, mounting and stamps as the bridges are configured for the scenario.
class DevicePath {
 public:
  using Take = std::function<void(const sim::Measurement&)>;

  /// Bridges as in the folder `config_directory`, with what the scenario sets in them. Throws
  /// config::ConfigError.
  DevicePath(const sim::Scenario& scenario, const std::string& config_directory, TimeNs power_on_ns);
  ~DevicePath();
  DevicePath(const DevicePath&) = delete;
  DevicePath& operator=(const DevicePath&) = delete;

  /// Hands over what comes of the measurement's bytes, which arrive at its received_ns. A sensor without
  /// device output goes straight through.
  void send(const sim::Measurement& measurement, const Take& take);

 private:
  struct Channel;
  [[nodiscard]] Channel* channel_of(std::string_view sensor);

  sim::DeviceEncoder encoder_;
  std::map<std::string, std::unique_ptr<Channel>, std::less<>> channels_;  ///< by the kind's name
};

}  // namespace fathom::cli
