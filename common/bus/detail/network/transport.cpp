#include "bus/detail/network/transport.hpp"

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "bus/detail/security/datagram_check.hpp"

namespace fathom::bus::detail {
namespace {

namespace fastdds = eprosima::fastdds::rtps;

/// Walks over the destinations of one datagram.
class Walk final : public fastdds::LocatorsIterator {
 public:
  explicit Walk(const rtps::Locator_t* at) : at_(at) {}
  fastdds::LocatorsIterator& operator++() override {
    ++at_;
    return *this;
  }
  bool operator==(const fastdds::LocatorsIterator& other) const override {
    return at_ == static_cast<const Walk&>(other).at_;
  }
  bool operator!=(const fastdds::LocatorsIterator& other) const override { return !(*this == other); }
  const rtps::Locator_t& operator*() const override { return *at_; }

 private:
  const rtps::Locator_t* at_;
};

class Transport final : public RoutingTransport<Transport> {
 public:
  explicit Transport(const TransportDescriptor& descriptor)
      : RoutingTransport(descriptor), descriptor_(descriptor) {}

  fastdds::TransportDescriptorInterface* get_configuration() override { return &descriptor_; }

  template <class PassOn>
  bool route(Locators* begin, Locators* end, const PassOn& pass_on) {
    thread_local std::vector<rtps::Locator_t> destinations;  // keeps its memory from datagram to datagram
    destinations.clear();
    for (; *begin != *end; ++*begin) destinations.push_back(**begin);
    for (const rtps::Locator_t& one : destinations) make_known(one);
    if (destinations.size() > 1) descriptor_.low_priority_peers->to_the_back(destinations);
    Walk from(destinations.data());
    Walk to(destinations.data() + destinations.size());
    return pass_on(&from, &to);
  }

  void receive(fastdds::TransportReceiverInterface* dds, const rtps::octet* bytes, std::uint32_t count,
               const rtps::Locator_t& local, const rtps::Locator_t& remote) override {
    const std::span datagram(bytes, count);
    if (!harmless(datagram) || !all_claims(datagram, [this](const Claim& claim) {
          return descriptor_.delivery_watch->arrived(claim);
        })) {
      return descriptor_.refused(rtps::IPLocator::toIPv4string(remote));
    }
    descriptor_.delivery_watch->arrived_from(datagram);
    thread_local std::vector<std::uint8_t> mended;  // keeps its memory from datagram to datagram
    mended.clear();
    all_acknowledgements(datagram, [&](const Acknowledgement& one) {
      if (!descriptor_.acknowledgements->goes_back(one)) return;
      if (mended.empty()) mended.assign(datagram.begin(), datagram.end());
      begin_anew(mended, one);
    });
    dds->OnDataReceived(mended.empty() ? bytes : mended.data(), count, local, remote);
  }

 private:
  TransportDescriptor descriptor_;
};

}  // namespace

TransportDescriptor::TransportDescriptor(std::shared_ptr<fastdds::TransportDescriptorInterface> sockets,
                                         std::shared_ptr<const LowPriorityPeers> who_look_on,
                                         std::shared_ptr<DeliveryWatch> what_arrives,
                                         std::shared_ptr<AcknowledgementBook> what_readers_have,
                                         Refused on_refused)
    : ChainingTransportDescriptor(std::move(sockets)),
      low_priority_peers(std::move(who_look_on)),
      delivery_watch(std::move(what_arrives)),
      acknowledgements(std::move(what_readers_have)),
      refused(std::move(on_refused)) {}

fastdds::TransportInterface* TransportDescriptor::create_transport() const {
  return new Transport(*this);
}

}  // namespace fathom::bus::detail
