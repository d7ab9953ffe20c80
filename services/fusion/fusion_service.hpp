#pragma once

#include <memory>

#include "config/fusion/fusion_config.hpp"
#include "host/service_host.hpp"

namespace fathom::fusion {

/// The estimation engine on the vehicle network: sensor samples and commands in; NavState with each inertial
/// sample, a Verdict per measurement, and once a second NavDetail, AlignmentStatus and Forecast out. A change
/// of the alignment phase is published at once.
///
/// Each topic is read on a thread of the bus; one mutex guards the engine, and nothing is published while it
/// is held. Samples of other vehicles on the same network are ignored and counted.
class FusionService {
 public:
  /// Installs its tick and its life sign in `host`, which must outlive it. Throws bus::BusError.
  FusionService(host::ServiceHost& host, const config::FusionConfig& config);
  ~FusionService();
  FusionService(const FusionService&) = delete;
  FusionService& operator=(const FusionService&) = delete;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace fathom::fusion
