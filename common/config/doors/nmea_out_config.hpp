#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "config/common_config.hpp"
#include "config/registry.hpp"

namespace fathom::config {

enum class NmeaSentence : std::uint8_t {
  gga = 0,
  rmc = 1,
  vtg = 2,
  gst = 3,
  hdt = 4,
  zda = 5,
  dpt = 6,
  vbw = 7,
  rot = 8,
  pfthm = 9,
};

/// One sentence of an output and how often it is said.
struct NmeaSentenceConfig {
  NmeaSentence sentence = NmeaSentence::gga;
  double rate_hz = 1.0;
};

enum class NmeaOutputType : std::uint8_t { udp = 0, tcp_server = 1, serial = 2 };

/// Where sentences go.
struct NmeaOutputConfig {
  NmeaOutputType type = NmeaOutputType::udp;
  std::string address =
      "127.0.0.1";        ///< udp: to whom, also a group or a broadcast address; tcp_server: to bind
  int port = 10'110;      ///< the one that IANA gives to nmea-0183
  std::string interface;  ///< udp: numeric address of this host to send from; empty: as routes say
  int most_clients = 8;   ///< tcp_server
  std::string path;       ///< serial
  int baud = 38'400;      ///< serial; 8 data bits, no parity, 1 stop bit
  std::string talker = "IN";
  std::vector<NmeaSentenceConfig> sentences{{NmeaSentence::gga, 1.0}, {NmeaSentence::rmc, 1.0},
                                            {NmeaSentence::vtg, 1.0}, {NmeaSentence::hdt, 1.0},
                                            {NmeaSentence::zda, 1.0}, {NmeaSentence::pfthm, 1.0}};
};

/// deploy/config/nmea_out.json
struct NmeaOutConfig {
  CommonConfig common;
  double valid_95_m = 100.0;            ///< a position whose 95 % radius is larger is not valid
  double valid_heading_rad = 0.174533;  ///< a heading whose sigma is larger is not told
  double silence_s = 1.0;               ///< without a navigation state for so long there is no position
  /// The point of the vehicle that is told, from the inertial unit: forward, right, down.
  std::array<double, 3> point_B_m{0.0, 0.0, 0.0};
  std::vector<NmeaOutputConfig> outputs;
};

[[nodiscard]] ConfigKind nmea_out_kind();

}  // namespace fathom::config
