#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <string>

#include "bus/detail/network/acknowledgements.hpp"
#include "bus/detail/network/delivery_watch.hpp"
#include "bus/detail/network/low_priority_peers.hpp"
#include "bus/detail/versions/transports.hpp"

namespace fathom::bus::detail {

/// A transport between Fast DDS and the sockets.
///
/// It sends a datagram for several readers to low-priority peers last. By itself Fast DDS sends in the order
/// in which it found the readers. Each datagram wakes a process, which then waits for a processor behind
/// those that were woken before.
///
/// It drops a received datagram that would end this process (harmless()) or that makes an impossible claim
/// (DeliveryWatch), and calls `refused` with the sender's address, on the thread that received it. It helps
/// readers that forgot what they had to get it again (AcknowledgementBook).
struct TransportDescriptor final : eprosima::fastdds::rtps::ChainingTransportDescriptor {
  using Refused = std::function<void(const std::string& address)>;

  TransportDescriptor(std::shared_ptr<eprosima::fastdds::rtps::TransportDescriptorInterface> sockets,
                      std::shared_ptr<const LowPriorityPeers> who_look_on,
                      std::shared_ptr<DeliveryWatch> what_arrives,
                      std::shared_ptr<AcknowledgementBook> what_readers_have, Refused on_refused);
  [[nodiscard]] eprosima::fastdds::rtps::TransportInterface* create_transport() const override;
  /// The bytes after which a writer of Fast DDS 2.9.1 sends a heartbeat to all its readers. It counts the
  /// bytes of a batch again with each sample of the batch. With the size of a socket's buffer it sent that
  /// heartbeat with nearly each sample that one reader had missed, and every other reader had to answer. On
  /// a protected network of twenty services the answers kept two slow processors busy for good: datagrams
  /// were dropped, and what had to be sent again kept them busy. The periodic heartbeat is enough: it goes
  /// on as long as a reader lacks a sample.
  [[nodiscard]] std::uint32_t min_send_buffer_size() const override {
    return std::numeric_limits<std::int32_t>::max();
  }

  std::shared_ptr<const LowPriorityPeers> low_priority_peers;
  std::shared_ptr<DeliveryWatch> delivery_watch;
  std::shared_ptr<AcknowledgementBook> acknowledgements;
  Refused refused;
};

}  // namespace fathom::bus::detail
