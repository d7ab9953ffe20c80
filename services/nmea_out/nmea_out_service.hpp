#pragma once

#include <memory>

#include "config/doors/nmea_out_config.hpp"
#include "host/service_host.hpp"

namespace fathom::nmea_out {

/// Tells the navigation state as sentences of NMEA 0183, through UDP, TCP and serial ports.
class NmeaOutService {
 public:
  NmeaOutService(host::ServiceHost& host, const config::NmeaOutConfig& config);
  ~NmeaOutService();
  NmeaOutService(const NmeaOutService&) = delete;
  NmeaOutService& operator=(const NmeaOutService&) = delete;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace fathom::nmea_out
