#include "config/bridge/byte_source_config.hpp"

namespace fathom::config {

using runtime::ByteSourceConfig;
using runtime::Framing;
using runtime::Pace;
using runtime::SourceType;
using runtime::TimeConfig;
using runtime::TimeMode;
using Violation = std::pair<std::string, std::string>;

namespace {

template <class Source>
void describe_source(Schema<Source>& s) {
  s.field("type", &ByteSourceConfig::type, "where the instrument's bytes come from")
      .words({{"serial", SourceType::serial},
              {"tcp_client", SourceType::tcp_client},
              {"tcp_server", SourceType::tcp_server},
              {"udp", SourceType::udp},
              {"file", SourceType::file}})
      .decides()
      .required();
  s.field("path", &ByteSourceConfig::path, "the device, e.g. /dev/ttyUSB0, or the recording")
      .only_for({"serial", "file"});
  s.field("baud", &ByteSourceConfig::baud, "bits per second").range(1200, 4'000'000).only_for({"serial"});
  s.field("framing", &ByteSourceConfig::framing, "data bits, parity and stop bits of a character")
      .words({{"8N1", Framing::n8_1},
              {"8E1", Framing::e8_1},
              {"8O1", Framing::o8_1},
              {"7E1", Framing::e7_1},
              {"7O1", Framing::o7_1}})
      .only_for({"serial"});
  s.field("address", &ByteSourceConfig::address,
          "numeric address: of the device for tcp_client, else of this host to bind")
      .only_for({"tcp_client", "tcp_server", "udp"});
  s.field("port", &ByteSourceConfig::port, "TCP or UDP port")
      .range(0, 65'535)
      .only_for({"tcp_client", "tcp_server", "udp"});
  s.field("multicast", &ByteSourceConfig::multicast, "group to join on the address; empty: none")
      .only_for({"udp"});
  s.field("shared", &ByteSourceConfig::shared,
          "true: other bridges of this host that say so as well read the same port")
      .only_for({"serial", "tcp_client", "tcp_server", "udp"});
  s.field("pace", &ByteSourceConfig::pace, "played as its frames' times say, at bytes_per_s, or at once")
      .words({{"original", Pace::original}, {"rate", Pace::rate}, {"fastest", Pace::fastest}})
      .only_for({"file"});
  s.field("bytes_per_s", &ByteSourceConfig::bytes_per_s, "speed where pace is rate")
      .unit("bytes/s")
      .range(1, 1e9)
      .only_for({"file"});
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
}

}  // namespace

void describe(Schema<InstrumentPort>& s) {
  describe_source(s);
}

void describe(Schema<ByteSourceConfig>& s) {
  describe_source(s);
  s.check([](const ByteSourceConfig& c) -> Violation {
    const bool by_path = c.type == SourceType::serial || c.type == SourceType::file;
    if (by_path && c.path.empty()) return {"path", "a path, because the type is serial or file"};
    if (!by_path && c.port == 0) return {"port", "1 to 65535, because the type is tcp or udp"};
    if (!by_path && !runtime::is_numeric_address(c.address))
      return {"address", "a numeric IPv4 or IPv6 address"};
    if (!c.multicast.empty() && !runtime::is_multicast_address(c.multicast)) {
      return {"multicast",
              "the address of a group, 224.0.0.0 to 239.255.255.255 or one of IPv6 that begins with ff, or "
              "empty"};
    }
    // A group of IPv4 is joined at an address of IPv4.
    if (c.multicast.find('.') != std::string::npos && c.address.find(':') != std::string::npos)
      return {"address", "one of IPv4, as the group is"};
    if (c.backoff_most_s < c.backoff_first_s) return {"backoff_most_s", "at least backoff_first_s"};
    return {};
  });
}

void describe(Schema<TimeConfig>& s) {
  s.field("mode", &TimeConfig::mode, "where the instant of validity comes from")
      .words({{"arrival", TimeMode::arrival},
              {"device_utc", TimeMode::device_utc},
              {"device_clock", TimeMode::device_clock}})
      .decides()
      .required();
  s.field("latency_s", &TimeConfig::latency_s, "from validity to arrival where the frame does not tell")
      .unit("s")
      .range(0, 60);
  s.field("minimum_latency_s", &TimeConfig::minimum_latency_s,
          "from validity to arrival of the quickest frame; the age that a frame says counts where it is more")
      .unit("s")
      .range(0, 60)
      .only_for({"device_clock"});
  s.field("drift_ppm", &TimeConfig::drift_ppm, "most drift between device and host clock")
      .unit("ppm")
      .range(0, 10'000)
      .only_for({"device_clock"});
  s.field("jump_s", &TimeConfig::jump_s, "a larger shift of its offset is a step of its clock")
      .unit("s")
      .range(0.001, 3600)
      .only_for({"device_clock"});
  s.field("window_s", &TimeConfig::window_s, "a delay that lasts longer is a step of its clock")
      .unit("s")
      .range(0.1, 3600)
      .only_for({"device_clock"});
  s.field("rollover_s", &TimeConfig::rollover_s, "period of the device's counter; 0: endless")
      .unit("s")
      .range(0, 1e9)
      .only_for({"device_clock"});
  s.field("max_age_s", &TimeConfig::max_age_s, "a time older than this at arrival is not believed")
      .unit("s")
      .range(0.001, 1e6)
      .only_for({"device_utc"});
  s.field("tolerance_s", &TimeConfig::tolerance_s, "a time this far after its arrival is still believed")
      .unit("s")
      .range(0, 3600)
      .only_for({"device_utc"});
}

}  // namespace fathom::config
