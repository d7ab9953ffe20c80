#pragma once

#include <cstdint>
#include <vector>

#include <fastdds/rtps/transport/TransportReceiverInterface.h>

#include "bus/detail/network/peer_book.hpp"
#include "bus/detail/versions/transports.hpp"

namespace fathom::bus::detail {
namespace fastdds = eprosima::fastdds::rtps;

/// The identity of an endpoint of a participant.
inline WriterGuid guid(std::uint8_t participant, std::uint8_t endpoint) {
  WriterGuid made{};
  made[0] = participant;
  made[15] = endpoint;
  return made;
}

/// What Fast DDS gets of a transport.
struct Dds final : fastdds::TransportReceiverInterface {
  void OnDataReceived(const std::uint8_t* bytes, std::uint32_t count, const rtps::Locator_t&,
                      const rtps::Locator_t&) override {
    received.emplace_back(bytes, bytes + count);
  }
  std::vector<std::vector<std::uint8_t>> received;
};

}  // namespace fathom::bus::detail
