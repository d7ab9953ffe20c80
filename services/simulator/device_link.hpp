#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>

#include "base/clock.hpp"
#include "sim/sensor_config.hpp"

namespace fathom::simulator {

/// A link cannot be set up: port taken, folder not writable.
class LinkError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct LinkCounters {
  std::uint64_t bytes_sent = 0;
  std::uint64_t bytes_dropped = 0;  ///< nobody read, or not fast enough
  std::uint64_t peers = 0;          ///< connected now; 1 for links without connections
};

/// Where a simulated device's bytes leave. Sending never blocks and never fails: like a real instrument, the
/// device talks on when nobody listens. One thread at a time.
class DeviceLink {
 public:
  virtual ~DeviceLink() = default;
  /// One message, whole.
  virtual void send(std::span<const std::uint8_t> bytes) = 0;
  /// Takes new connections in; between sends, some times a second.
  virtual void poll() {}
  [[nodiscard]] virtual LinkCounters counters() const = 0;
  /// Where readers find it, for the log.
  [[nodiscard]] virtual std::string where() const = 0;
};

/// Pseudo-terminal in raw mode, its device file linked as `link_path`. Readers may come and go; what was not
/// read within half a second of the host's time is thrown away, so a new reader never starts with old bytes.
/// `clock` must outlive the link. Throws LinkError.
[[nodiscard]] std::unique_ptr<DeviceLink> make_pty_link(const std::string& link_path, const Clock& clock);

/// TCP server for any number of clients up to 16; a client that does not read loses messages. Throws
/// LinkError.
[[nodiscard]] std::unique_ptr<DeviceLink> make_tcp_link(const std::string& address, int port);

/// UDP datagrams, one per message. Throws LinkError.
[[nodiscard]] std::unique_ptr<DeviceLink> make_udp_link(const std::string& address, int port);

[[nodiscard]] std::unique_ptr<DeviceLink> make_link(const sim::LinkConfig& config,
                                                    const std::string& link_dir, int port_offset,
                                                    const Clock& clock);

}  // namespace fathom::simulator
