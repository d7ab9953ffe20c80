#pragma once

// A socket for transports of Fast DDS that keeps what is sent, and where to.

#include <chrono>
#include <cstdint>
#include <vector>

#include "bus/detail/versions/transports.hpp"

namespace fathom::test {

class DdsSocket final : public bus::detail::RoutedSocket {
 public:
  using Locators = eprosima::fastdds::rtps::LocatorsIterator;
  using Until = std::chrono::steady_clock::time_point;
  using Bytes = std::vector<std::uint8_t>;

#if FATHOM_FASTDDS_MAJOR < 3
  DdsSocket() : SenderResource(LOCATOR_KIND_UDPv4) {
    send_lambda_ = [this](const std::uint8_t* data, std::uint32_t count, Locators* from, Locators* to,
                          const Until&) {
      return keep({data, data + count}, from, to);
    };
  }
  bool send_over(eprosima::fastdds::rtps::ChainingTransport& transport, const Bytes& bytes, Locators* from,
                 Locators* to) {
    return transport.send(this, bytes.data(), static_cast<std::uint32_t>(bytes.size()), from, to, {});
  }
#else
  using Buffer = eprosima::fastdds::rtps::NetworkBuffer;
  DdsSocket() : SenderResource(LOCATOR_KIND_UDPv4) {
    send_buffers_lambda_ = [this](const std::vector<Buffer>& parts, std::uint32_t, Locators* from,
                                  Locators* to, const Until&) {
      Bytes all;
      for (const Buffer& part : parts) {
        const auto* data = static_cast<const std::uint8_t*>(part.buffer);
        all.insert(all.end(), data, data + part.size);
      }
      return keep(all, from, to);
    };
  }
  bool send_over(eprosima::fastdds::rtps::ChainingTransport& transport, const Bytes& bytes, Locators* from,
                 Locators* to) {
    const auto count = static_cast<std::uint32_t>(bytes.size());
    return transport.send(this, {Buffer(bytes.data(), count)}, count, from, to, {});
  }
#endif

  Bytes sent;
  std::vector<bus::detail::rtps::Locator_t> at;
  bool works = true;

 private:
  bool keep(const Bytes& bytes, Locators* from, Locators* to) {
    sent = bytes;
    for (; *from != *to; ++*from) at.push_back(**from);
    return works;
  }
};

/// Sends by a socket that a transport has opened.
inline bool send_by(bus::detail::RoutedSocket& socket, const DdsSocket::Bytes& bytes,
                    DdsSocket::Locators* from, DdsSocket::Locators* to) {
  const auto count = static_cast<std::uint32_t>(bytes.size());
  const auto until = std::chrono::steady_clock::now() + std::chrono::seconds(1);
#if FATHOM_FASTDDS_MAJOR < 3
  return socket.send(bytes.data(), count, from, to, until);
#else
  return socket.send({DdsSocket::Buffer(bytes.data(), count)}, count, from, to, until);
#endif
}

}  // namespace fathom::test
