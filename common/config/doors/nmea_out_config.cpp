#include "config/doors/nmea_out_config.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "config/service_schema.hpp"
#include "runtime/byte_source.hpp"

namespace fathom::config {
namespace {

using Fault = std::pair<std::string, std::string>;

constexpr double kLongestSentence = 82.0;  // characters
constexpr double kBitsPerCharacter = 10.0;

bool is_talker(const std::string& text) {
  return text.size() == 2 &&
         std::all_of(text.begin(), text.end(), [](char c) { return c >= 'A' && c <= 'Z'; });
}

/// That the sentences need on a serial line.
double bits_per_s(const NmeaOutputConfig& output) {
  double sum = 0.0;
  for (const NmeaSentenceConfig& one : output.sentences) sum += one.rate_hz;
  return sum * kLongestSentence * kBitsPerCharacter;
}

}  // namespace

void describe(Schema<NmeaSentenceConfig>& s) {
  s.field("sentence", &NmeaSentenceConfig::sentence, "which; PFTHM is our own and tells uncertainty")
      .words({{"GGA", NmeaSentence::gga},
              {"RMC", NmeaSentence::rmc},
              {"VTG", NmeaSentence::vtg},
              {"GST", NmeaSentence::gst},
              {"HDT", NmeaSentence::hdt},
              {"ZDA", NmeaSentence::zda},
              {"DPT", NmeaSentence::dpt},
              {"VBW", NmeaSentence::vbw},
              {"ROT", NmeaSentence::rot},
              {"PFTHM", NmeaSentence::pfthm}})
      .required();
  s.field("rate_hz", &NmeaSentenceConfig::rate_hz, "how often").unit("Hz").range(0.01, 100);
}

void describe(Schema<NmeaOutputConfig>& s) {
  using C = NmeaOutputConfig;
  s.field("type", &C::type, "how sentences leave")
      .words({{"udp", NmeaOutputType::udp},
              {"tcp_server", NmeaOutputType::tcp_server},
              {"serial", NmeaOutputType::serial}})
      .decides()
      .required();
  s.field("address", &C::address,
          "numeric address: udp: of the one who listens, a group or a broadcast address; tcp_server: of this "
          "host to bind")
      .only_for({"udp", "tcp_server"});
  s.field("port", &C::port, "UDP or TCP port").range(1, 65'535).only_for({"udp", "tcp_server"});
  s.field("interface", &C::interface,
          "numeric address of this host that datagrams leave from; empty: as its routes say")
      .only_for({"udp"});
  s.field("most_clients", &C::most_clients, "connections at a time").range(1, 64).only_for({"tcp_server"});
  s.field("path", &C::path, "the device, e.g. /dev/ttyUSB0").only_for({"serial"});
  s.field("baud", &C::baud, "bits per second; 8 data bits, no parity, 1 stop bit")
      .range(1200, 4'000'000)
      .only_for({"serial"});
  s.field("talker", &C::talker, "two capital letters before the name of each sentence");
  s.field("sentences", &C::sentences, "what is said, and how often");
  s.check([](const C& c) -> Fault {
    if (c.type == NmeaOutputType::serial && c.path.empty())
      return {"path", "a path, because the type is serial"};
    if (c.type != NmeaOutputType::serial && !runtime::is_numeric_address(c.address))
      return {"address", "a numeric IPv4 or IPv6 address"};
    if (!c.interface.empty() && !runtime::is_numeric_address(c.interface))
      return {"interface", "a numeric IPv4 or IPv6 address, or empty"};
    if (!is_talker(c.talker)) return {"talker", "two capital letters"};
    if (c.sentences.empty()) return {"sentences", "at least one sentence"};
    const double needed = bits_per_s(c);
    if (c.type == NmeaOutputType::serial && needed > c.baud)
      return {"baud", "at least " + std::to_string(static_cast<long>(std::ceil(needed))) +
                          ", which these sentences need at these rates"};
    return {};
  });
}

void describe(Schema<NmeaOutConfig>& s) {
  using C = NmeaOutConfig;
  s.include(&C::common);
  s.field("valid_95_m", &C::valid_95_m,
          "a position whose 95 % radius is larger is said to be not valid (status V)")
      .unit("m")
      .range(0.01, 1e6);
  s.field("valid_heading_deg", &C::valid_heading_rad, "a heading whose sigma is larger is not told")
      .unit("deg")
      .range(0.01, 180)
      .scaled(std::numbers::pi / 180.0);
  s.field("silence_s", &C::silence_s,
          "without a navigation state for so long it is said that there is no position")
      .unit("s")
      .range(0.1, 60);
  s.field("point_B_m", &C::point_B_m,
          "the point of the vehicle that is told, from the inertial unit: forward, right, down")
      .unit("m")
      .range(-1000, 1000);
  s.field("outputs", &C::outputs, "where sentences go").required();
  s.check([](const C& config) -> Fault {
    if (config.outputs.empty()) return {"outputs", "at least one output"};
    return {};
  });
}

template LoadedConfig<NmeaOutConfig> load_service_config(const LoadRequest& request);
template std::string explain_service_config<NmeaOutConfig>();

ConfigKind nmea_out_kind() {
  return make_kind<NmeaOutConfig>("nmea_out");
}

}  // namespace fathom::config
