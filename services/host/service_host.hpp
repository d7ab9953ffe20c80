#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "base/clock.hpp"
#include "base/exit_code.hpp"
#include "base/time.hpp"
#include "bus/participant.hpp"
#include "config/common_config.hpp"
#include "runtime/log.hpp"
#include "samples/header.hpp"
#include "samples/status/health.hpp"

namespace fathom::host {

/// The name and kind of a service, given by its main.
struct ServiceInfo {
  std::string name;           ///< e.g. "fusion"; the executable is fathom-fusion
  std::string description;    ///< one sentence for --help
  bool low_priority = false;  ///< see bus::ParticipantOptions
};

/// The host of a service, with what every service shares: log, clock, presence on the bus, life sign once a
/// second, orderly end.
///
/// A main builds its work inside the body given to host::run() (services/host/run.hpp) and then calls run():
///
///   int main(int argc, char** argv) {
///     return host::run<config::FusionConfig>(argc, argv, {"fusion", "Fuses ..."},
///         [](host::ServiceHost& host, const config::FusionConfig& config) {
///           fusion::FusionService service(host, config);
///           return host.run();
///         });
///   }
class ServiceHost {
 public:
  struct Start {
    ServiceInfo info;
    config::CommonConfig common;
    std::string config_hash;         ///< hex of the effective configuration
    std::string discovery_listen{};  ///< "address:port" where it is a discovery server to others; else empty
  };

  /// Asks for the configured scheduling and memory, then joins the bus. The caller must not have started a
  /// thread before, because later threads, also those of Fast DDS, inherit the scheduling. SIGINT and SIGTERM
  /// must be blocked in every thread before (host::run() does it first). Throws bus::BusError.
  explicit ServiceHost(Start start);
  ~ServiceHost();
  ServiceHost(const ServiceHost&) = delete;
  ServiceHost& operator=(const ServiceHost&) = delete;

  [[nodiscard]] const config::CommonConfig& common() const;
  [[nodiscard]] const std::string& name() const;
  [[nodiscard]] const std::string& config_hash() const;
  [[nodiscard]] Clock& clock();
  [[nodiscard]] runtime::Log& log();
  [[nodiscard]] bus::Participant& participant();

  /// Header of a sample that this service writes about itself: vehicle, the service's name as sensor, stamp
  /// and arrival now, sequence 0.
  [[nodiscard]] SampleHeader header() const;

  /// A span of vehicle time as the host's own clock measures it. DDS deadlines and waits run on the host's
  /// clock, so in an accelerated run they shrink by the clock's rate.
  [[nodiscard]] DurationNs host_duration(DurationNs vehicle_ns) const;

  /// `fill` completes the life sign just before it is published: state, text, rates, counters. It runs on the
  /// thread of run(). Without it the service is healthy while it runs. Counters of the bus are appended.
  void on_status(std::function<void(ServiceStatus& status)> fill);

  /// Calls `tick` on the thread of run() every `period_ns` of vehicle time. Missed ticks are not made up for.
  /// A service has one tick function.
  void on_tick(DurationNs period_ns, std::function<void()> tick);

  /// Publishes the life sign at once, besides each second, after a change that others should not wait for.
  /// Any thread.
  void publish_status_soon();

  /// Publishes life signs and ticks until SIGINT, SIGTERM or stop(). Returns the exit code. Throws an
  /// exception of `fill` or `tick` on, after the last life sign.
  ExitCode run();

  /// Ends run() soon. Any thread; the first call decides the exit code.
  void stop(ExitCode code);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace fathom::host
