#include "bus/interfaces.hpp"

#include <algorithm>
#include <array>

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <netinet/in.h>

#include "bus/participant.hpp"

namespace fathom::bus {

std::vector<LocalAddress> local_addresses() {
  std::vector<LocalAddress> out;
  ifaddrs* list = nullptr;
  if (getifaddrs(&list) != 0) return out;
  for (const ifaddrs* one = list; one != nullptr; one = one->ifa_next) {
    if (one->ifa_addr == nullptr || one->ifa_addr->sa_family != AF_INET) continue;
    std::array<char, INET_ADDRSTRLEN> text{};
    const auto* address = reinterpret_cast<const sockaddr_in*>(one->ifa_addr);
    if (inet_ntop(AF_INET, &address->sin_addr, text.data(), text.size()) == nullptr) continue;
    constexpr unsigned kLink = IFF_UP | IFF_RUNNING;
    out.push_back({text.data(), one->ifa_name, (one->ifa_flags & kLink) == kLink});
  }
  freeifaddrs(list);
  return out;
}

std::vector<LocalAddress> without_link(const std::vector<std::string>& interfaces) {
  std::vector<LocalAddress> out;
  for (const LocalAddress& one : local_addresses()) {
    if (!one.has_link && std::find(interfaces.begin(), interfaces.end(), one.address) != interfaces.end())
      out.push_back(one);
  }
  return out;
}

void check_interfaces(const std::vector<std::string>& interfaces) {
  if (interfaces.empty()) throw BusError("no interfaces: expected at least one IPv4 address of this host");
  const std::vector<LocalAddress> present = local_addresses();
  for (const std::string& interface : interfaces) {
    const bool found = std::any_of(present.begin(), present.end(),
                                   [&](const LocalAddress& one) { return one.address == interface; });
    if (found) continue;
    std::string text;
    for (const LocalAddress& one : present) text.append(text.empty() ? "" : ", ").append(one.address);
    throw BusError("interface '" + interface + "': this host has no such address, only " + text);
  }
  const std::vector<LocalAddress> silent = without_link(interfaces);
  if (silent.size() < interfaces.size()) return;
  throw BusError("interface '" + silent.front().address + "': its network card " + silent.front().card +
                 " has no link: no cable, or what is at its other end is off");
}

}  // namespace fathom::bus
