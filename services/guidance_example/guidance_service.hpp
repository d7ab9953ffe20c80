#pragma once

#include <memory>

#include "config/guidance_config.hpp"
#include "host/service_host.hpp"

namespace fathom::guidance {

/// A guidance program as its authors would write one: it knows the vehicle only through fathom::Client.
/// Follows waypoints by line of sight, logs its orders, and refuses to steer, saying why, while navigation is
/// not to be relied on.
class GuidanceService {
 public:
  /// Installs its tick and its life sign in `host`, which must outlive it. Throws std::runtime_error.
  GuidanceService(host::ServiceHost& host, const config::GuidanceConfig& config);
  ~GuidanceService();
  GuidanceService(const GuidanceService&) = delete;
  GuidanceService& operator=(const GuidanceService&) = delete;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace fathom::guidance
