#include "bus/detail/mapping.hpp"
#include "idl/health.h"
#include "samples/status/health.hpp"

namespace fathom::bus::detail {

template <>
struct Mapping<ServiceStatus> {
  using Wire = v1::ServiceStatus;
  static constexpr const char* kTopic = "fathom/v1/service_status";
  static constexpr const char* kType = "fathom::v1::ServiceStatus";
  static constexpr bool kHasLists = true;

  static void fields(auto& copy, auto& plain, auto& wire) {
    // The service is the key, so it has the name of one on the wire.
    copy(plain.header.vehicle, wire.vehicle());
    copy(plain.header.sensor, wire.service());
    copy(plain.header.stamp_ns, wire.stamp_ns());
    copy(plain.header.received_ns, wire.received_ns());
    copy(plain.header.sequence, wire.sequence_number());
    copy_enum<ServiceState::stopping, v1::ServiceState::SERVICE_STATE_STOPPING>(copy, plain.state,
                                                                                wire.state());
    copy(plain.version, wire.version());
    copy(plain.config_hash, wire.config_hash());
    copy(plain.host, wire.host());
    copy(plain.pid, wire.pid());
    copy(plain.started_ns, wire.started_ns());
    copy(plain.utc_offset_ns, wire.utc_offset_ns());
    copy(plain.text, wire.text());
    copy.sequence(plain.rates, wire.rates(), 16, [](auto& each, auto& rate, auto& w) {
      each(rate.name, w.name());
      each(rate.hz, w.hz());
    });
    copy.sequence(plain.counters, wire.counters(), kMostCounters, [](auto& each, auto& counter, auto& w) {
      each(counter.name, w.name());
      each(counter.value, w.value());
    });
  }

  static std::string key_text(const ServiceStatus& sample) { return vehicle_and_sensor(sample); }
};

}  // namespace fathom::bus::detail

FATHOM_BUS_TOPIC(ServiceStatus)
