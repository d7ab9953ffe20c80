#pragma once

#include <string>
#include <vector>

namespace fathom::bus {

/// An IPv4 address of this host.
struct LocalAddress {
  std::string address;
  std::string card;       ///< name of its network interface
  bool has_link = false;  ///< up, with a carrier: Fast DDS leaves out, for good, what has none when it starts
};

[[nodiscard]] std::vector<LocalAddress> local_addresses();

/// Those of `interfaces` that have no link.
[[nodiscard]] std::vector<LocalAddress> without_link(const std::vector<std::string>& interfaces);

/// Throws BusError where this host does not have one of them, or where none of them has a link: Fast DDS
/// would leave them out in silence, and never use them afterwards.
void check_interfaces(const std::vector<std::string>& interfaces);

}  // namespace fathom::bus
