#pragma once

#include <memory>

#include "config/recorder_config.hpp"
#include "host/service_host.hpp"

namespace fathom::recorder {

/// Keeps everything that is said on the vehicle network in files that any reader of MCAP opens.
class RecorderService {
 public:
  RecorderService(host::ServiceHost& host, const config::RecorderConfig& config);
  ~RecorderService();
  RecorderService(const RecorderService&) = delete;
  RecorderService& operator=(const RecorderService&) = delete;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace fathom::recorder
