#pragma once

#include <functional>
#include <memory>
#include <string>

#include "bus/detail/network/delivery_watch.hpp"
#include "bus/detail/network/low_priority_peers.hpp"
#include "bus/detail/versions/transports.hpp"

namespace fathom::bus::detail {

/// Between Fast DDS and the sockets.
///
/// A datagram for several goes to those who look on after it has gone to all others. By itself Fast DDS sends
/// in the order in which it found the readers; each datagram wakes a process, which then stands in line for a
/// processor behind those that were woken before.
///
/// A datagram that would end this process (harmless()), or claims what cannot be (DeliveryWatch), is left
/// out, and `refused` told its sender's address, on the thread that received it.
struct TransportDescriptor final : eprosima::fastdds::rtps::ChainingTransportDescriptor {
  using Refused = std::function<void(const std::string& address)>;

  TransportDescriptor(std::shared_ptr<eprosima::fastdds::rtps::TransportDescriptorInterface> sockets,
                      std::shared_ptr<const LowPriorityPeers> who_look_on,
                      std::shared_ptr<DeliveryWatch> what_arrives, Refused on_refused);
  [[nodiscard]] eprosima::fastdds::rtps::TransportInterface* create_transport() const override;

  std::shared_ptr<const LowPriorityPeers> low_priority_peers;
  std::shared_ptr<DeliveryWatch> delivery_watch;
  Refused refused;
};

}  // namespace fathom::bus::detail
