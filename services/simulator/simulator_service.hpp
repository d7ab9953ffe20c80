#pragma once

#include <memory>

#include "bus/writer.hpp"
#include "config/scenario/simulator_config.hpp"
#include "host/service_host.hpp"
#include "samples/truth.hpp"
#include "simulator/player.hpp"

namespace fathom::simulator {

/// The simulated vehicle's instruments on their links, its truth on the bus.
class SimulatorService {
 public:
  /// Throws dataset::DatasetError, LinkError, bus::BusError.
  SimulatorService(host::ServiceHost& host, const config::SimulatorConfig& config);

 private:
  void fill(ServiceStatus& status);

  host::ServiceHost& host_;
  config::SimulatorConfig config_;
  bus::Writer<Truth> truth_writer_;
  std::map<std::string, std::uint64_t> messages_before_;
  TimeNs status_before_ns_ = 0;
  bool said_finished_ = false;
  std::unique_ptr<Player> player_;
};

}  // namespace fathom::simulator
