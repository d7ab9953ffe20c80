#include "bus/detail/transport.hpp"

#include <chrono>
#include <cstdint>
#include <utility>
#include <vector>

#include <fastdds/rtps/common/LocatorsIterator.hpp>
#include <fastdds/rtps/network/SenderResource.h>
#include <fastdds/rtps/transport/TransportReceiverInterface.h>
#include <fastrtps/utils/IPLocator.h>

#include "bus/detail/datagram_check.hpp"

namespace fathom::bus::detail {
namespace {

namespace rtps = eprosima::fastdds::rtps;
using eprosima::fastrtps::rtps::octet;
using eprosima::fastrtps::rtps::SenderResource;

/// Walks over the destinations of one datagram.
class Walk final : public rtps::LocatorsIterator {
 public:
  explicit Walk(const rtps::Locator* at) : at_(at) {}
  rtps::LocatorsIterator& operator++() override {
    ++at_;
    return *this;
  }
  bool operator==(const rtps::LocatorsIterator& other) const override {
    return at_ == static_cast<const Walk&>(other).at_;
  }
  bool operator!=(const rtps::LocatorsIterator& other) const override { return !(*this == other); }
  const rtps::Locator& operator*() const override { return *at_; }

 private:
  const rtps::Locator* at_;
};

class Transport final : public rtps::ChainingTransport {
 public:
  explicit Transport(const TransportDescriptor& descriptor)
      : ChainingTransport(descriptor), descriptor_(descriptor) {}

  rtps::TransportDescriptorInterface* get_configuration() override { return &descriptor_; }

  bool send(SenderResource* socket, const octet* bytes, std::uint32_t count, rtps::LocatorsIterator* begin,
            rtps::LocatorsIterator* end, const std::chrono::steady_clock::time_point& until) override {
    thread_local std::vector<rtps::Locator> destinations;  // keeps its memory from datagram to datagram
    destinations.clear();
    for (; *begin != *end; ++*begin) destinations.push_back(**begin);
    if (destinations.size() > 1) descriptor_.onlookers->to_the_back(destinations);
    Walk from(destinations.data());
    Walk to(destinations.data() + destinations.size());
    return socket->send(bytes, count, &from, &to, until);
  }

  void receive(rtps::TransportReceiverInterface* dds, const octet* bytes, std::uint32_t count,
               const rtps::Locator& local, const rtps::Locator& remote) override {
    if (harmless({bytes, count})) return dds->OnDataReceived(bytes, count, local, remote);
    descriptor_.refused(eprosima::fastrtps::rtps::IPLocator::toIPv4string(remote));
  }

 private:
  TransportDescriptor descriptor_;
};

}  // namespace

TransportDescriptor::TransportDescriptor(std::shared_ptr<rtps::TransportDescriptorInterface> sockets,
                                         std::shared_ptr<const Onlookers> who_look_on, Refused on_refused)
    : ChainingTransportDescriptor(std::move(sockets)),
      onlookers(std::move(who_look_on)),
      refused(std::move(on_refused)) {}

rtps::TransportInterface* TransportDescriptor::create_transport() const {
  return new Transport(*this);
}

}  // namespace fathom::bus::detail
