#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <vector>

#include "bus/detail/versions/names.hpp"

#if FATHOM_FASTDDS_MAJOR < 3
#include <fastdds/rtps/common/LocatorsIterator.hpp>
#include <fastdds/rtps/network/SenderResource.h>
#include <fastdds/rtps/transport/ChainingTransport.h>
#include <fastdds/rtps/transport/ChainingTransportDescriptor.h>
#include <fastdds/rtps/transport/TransportReceiverInterface.h>
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#else
#include <fastdds/rtps/common/LocatorsIterator.hpp>
#include <fastdds/rtps/transport/ChainingTransport.hpp>
#include <fastdds/rtps/transport/ChainingTransportDescriptor.hpp>
#include <fastdds/rtps/transport/SenderResource.hpp>
#include <fastdds/rtps/transport/TransportReceiverInterface.hpp>
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.hpp>
#endif

namespace fathom::bus::detail {

#if FATHOM_FASTDDS_MAJOR < 3
using RoutedSocket = rtps::SenderResource;
#else
using RoutedSocket = eprosima::fastdds::rtps::SenderResource;
#endif

/// A transport in front of another, whose send() hands over the bytes as the version does, and asks
/// `Derived::route(begin, end, pass_on)` where they go: it calls pass_on(from, to) and returns its answer.
template <class Derived>
class RoutingTransport : public eprosima::fastdds::rtps::ChainingTransport {
 public:
  using ChainingTransport::ChainingTransport;
  using Locators = eprosima::fastdds::rtps::LocatorsIterator;
  using Until = std::chrono::steady_clock::time_point;

#if FATHOM_FASTDDS_MAJOR < 3
  bool send(RoutedSocket* socket, const rtps::octet* bytes, std::uint32_t count, Locators* begin,
            Locators* end, const Until& until) final {
#else
  bool send(RoutedSocket* socket, const std::vector<eprosima::fastdds::rtps::NetworkBuffer>& bytes,
            std::uint32_t count, Locators* begin, Locators* end, const Until& until) final {
#endif
    return static_cast<Derived*>(this)->route(begin, end, [&](Locators* from, Locators* to) {
      return socket->send(bytes, count, from, to, until);
    });
  }

 protected:
  /// To be called before a datagram goes to `destination`. Fast DDS 2 counts what goes where, and ends the
  /// process when it sends to a place for which it has opened no channel. A discovery server does that by
  /// itself: it announces itself to a client while another of its threads is still taking that client in.
  void make_known([[maybe_unused]] const rtps::Locator_t& destination) {
#if FATHOM_FASTDDS_MAJOR < 3
    if (std::find(known_.begin(), known_.end(), destination) != known_.end()) return;
    low_level_transport_->OpenOutputChannel(no_more_sockets_, destination);
    known_.push_back(destination);
#endif
  }

 private:
#if FATHOM_FASTDDS_MAJOR < 3
  std::vector<rtps::Locator_t> known_;
  eprosima::fastdds::rtps::SendResourceList
      no_more_sockets_;  ///< they are made for interfaces, which Fast DDS has found itself
#endif
};

}  // namespace fathom::bus::detail
