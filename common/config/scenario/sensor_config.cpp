#include <string>
#include <utility>

#include "config/scenario/scenario_schema.hpp"

namespace fathom::config {
namespace {

using Fault = std::pair<std::string, std::string>;

}  // namespace

void describe(Schema<sim::Window>& s) {
  s.field("from_s", &sim::Window::from_s, "seconds since the start").unit("s").range(0, 1e6).required();
  s.field("to_s", &sim::Window::to_s, "seconds since the start").unit("s").range(0, 1e6).required();
  s.check([](const sim::Window& w) -> Fault {
    if (w.to_s <= w.from_s) return {"to_s", "later than from_s"};
    return {};
  });
}

void describe(Schema<sim::LinkConfig>& s) {
  using Type = sim::LinkConfig::Type;
  s.field("type", &sim::LinkConfig::type, "pseudo-terminal, TCP server or UDP sender")
      .words({{"pty", Type::pty}, {"tcp_server", Type::tcp_server}, {"udp", Type::udp}})
      .required();
  s.field("path", &sim::LinkConfig::path, "pty: name of the link below the simulator's link_dir");
  s.field("address", &sim::LinkConfig::address, "tcp_server: bound; udp: sent to");
  s.field("port", &sim::LinkConfig::port, "tcp_server, udp").range(0, 65535);
  s.check([](const sim::LinkConfig& link) -> Fault {
    if (link.type == Type::pty && link.path.empty()) return {"path", "a name for the pseudo-terminal"};
    if (link.type != Type::pty && link.port == 0) return {"port", "a port from 1 to 65535"};
    return {};
  });
}

void describe(Schema<sim::SensorSuite>& s) {
  for_each_kind([&](auto kind) {
    using Sample = typename decltype(kind)::Sample;
    s.field(std::string(kind.kWord), &sim::SuitePart<Sample>::sensor,
            sim::SimulatedSensor<Sample>::kDescription);
  });
}

}  // namespace fathom::config
