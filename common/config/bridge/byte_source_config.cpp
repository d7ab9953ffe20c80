#include "config/bridge/byte_source_config.hpp"

namespace fathom::config {

using runtime::ByteSourceConfig;
using runtime::Pace;
using runtime::SourceType;
using runtime::TimeConfig;
using runtime::TimeMode;
using Violation = std::pair<std::string, std::string>;

void describe(Schema<ByteSourceConfig>& s) {
  s.field("type", &ByteSourceConfig::type, "where the instrument's bytes come from")
      .words({{"serial", SourceType::serial},
              {"tcp_client", SourceType::tcp_client},
              {"tcp_server", SourceType::tcp_server},
              {"udp", SourceType::udp},
              {"file", SourceType::file}})
      .required();
  s.field("path", &ByteSourceConfig::path, "serial: device, e.g. /dev/ttyUSB0; file: the recording");
  s.field("baud", &ByteSourceConfig::baud, "serial: bits per second; 8 data bits, no parity, 1 stop bit")
      .range(1200, 4'000'000);
  s.field("address", &ByteSourceConfig::address,
          "tcp_client: numeric address of the device; tcp_server, udp: numeric address of this host to bind");
  s.field("port", &ByteSourceConfig::port, "tcp_client, tcp_server, udp: port").range(0, 65'535);
  s.field("multicast", &ByteSourceConfig::multicast, "udp: group to join on the address; empty: none");
  s.field("pace", &ByteSourceConfig::pace,
          "file: played as its frames' times say, at bytes_per_s, or at once")
      .words({{"original", Pace::original}, {"rate", Pace::rate}, {"fastest", Pace::fastest}});
  s.field("bytes_per_s", &ByteSourceConfig::bytes_per_s, "file with pace rate: speed").range(1, 1e9);
  s.field("silence_s", &ByteSourceConfig::silence_s,
          "a connection without bytes for this long is reported silent; 0: when its samples are stale")
      .unit("s")
      .range(0, 86'400);
  s.field("backoff_first_s", &ByteSourceConfig::backoff_first_s,
          "wait after the first failed attempt to connect")
      .unit("s")
      .range(0.01, 60);
  s.field("backoff_most_s", &ByteSourceConfig::backoff_most_s, "longest wait between attempts to connect")
      .unit("s")
      .range(0.01, 600);
  s.check([](const ByteSourceConfig& c) -> Violation {
    const bool by_path = c.type == SourceType::serial || c.type == SourceType::file;
    if (by_path && c.path.empty()) return {"path", "a path, because the type is serial or file"};
    if (!by_path && c.port == 0) return {"port", "1 to 65535, because the type is tcp or udp"};
    if (!by_path && !runtime::is_numeric_address(c.address))
      return {"address", "a numeric IPv4 or IPv6 address"};
    if (!c.multicast.empty() && !runtime::is_numeric_address(c.multicast)) {
      return {"multicast", "a numeric IPv4 or IPv6 address, or empty"};
    }
    if (c.backoff_most_s < c.backoff_first_s) return {"backoff_most_s", "at least backoff_first_s"};
    return {};
  });
}

void describe(Schema<TimeConfig>& s) {
  s.field("mode", &TimeConfig::mode, "where the instant of validity comes from")
      .words({{"arrival", TimeMode::arrival},
              {"device_utc", TimeMode::device_utc},
              {"device_clock", TimeMode::device_clock}})
      .required();
  s.field("latency_s", &TimeConfig::latency_s, "from validity to arrival where the frame does not tell")
      .unit("s")
      .range(0, 60);
  s.field("minimum_latency_s", &TimeConfig::minimum_latency_s,
          "device_clock: from validity to arrival of the quickest frame")
      .unit("s")
      .range(0, 60);
  s.field("drift_ppm", &TimeConfig::drift_ppm, "device_clock: most drift between device and host clock")
      .unit("1e-6")
      .range(0, 10'000);
  s.field("jump_s", &TimeConfig::jump_s, "device_clock: a larger shift of its offset is a step of its clock")
      .unit("s")
      .range(0.001, 3600);
  s.field("window_s", &TimeConfig::window_s, "device_clock: a delay that lasts longer is a step of its clock")
      .unit("s")
      .range(0.1, 3600);
  s.field("rollover_s", &TimeConfig::rollover_s, "device_clock: period of the device's counter; 0: endless")
      .unit("s")
      .range(0, 1e9);
  s.field("max_age_s", &TimeConfig::max_age_s,
          "device_utc: a time older than this at arrival is not believed")
      .unit("s")
      .range(0.001, 1e6);
  s.field("tolerance_s", &TimeConfig::tolerance_s,
          "device_utc: a time this far after its arrival is still believed")
      .unit("s")
      .range(0, 3600);
}

}  // namespace fathom::config
