#pragma once

#include <memory>
#include <string>
#include <vector>

#include "base/clock.hpp"
#include "cli/init/proposal.hpp"

namespace fathom::cli {

/// A port to listen to.
struct PortToHear {
  runtime::ByteSourceConfig port;
  bool baud_known = false;  ///< of a serial port; else all usual rates are tried
};

/// "PATH" or "PATH@BAUD". Throws Failure.
[[nodiscard]] PortToHear serial_port(const std::string& text);
/// "ADDRESS:PORT" of a device. Throws Failure.
[[nodiscard]] PortToHear tcp_port(const std::string& text);
/// "PORT" or "ADDRESS:PORT" of this host. Throws Failure.
[[nodiscard]] PortToHear udp_port(const std::string& text);
/// The serial ports of this host, by names that stay the same where there are such.
[[nodiscard]] std::vector<PortToHear> serial_ports_here();

/// Throws Failure where another process has one of the serial ports open: a reader would take bytes from it,
/// and its rate would be changed under it.
void refuse_ports_in_use(const std::vector<PortToHear>& ports);

/// Listens to all ports at once and writes to none: until each was recognised and heard for some seconds, or
/// for `most_s`. A serial port whose bytes no codec understands is tried at the next rate; one that is silent
/// is not, because silence is the same at every rate.
[[nodiscard]] std::vector<Heard> listen(const std::vector<PortToHear>& ports, double most_s,
                                        const Clock& clock);

}  // namespace fathom::cli
