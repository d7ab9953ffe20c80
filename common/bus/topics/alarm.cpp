#include "bus/detail/mapping.hpp"
#include "idl/health.h"
#include "samples/status/health.hpp"

namespace fathom::bus::detail {

template <>
struct Mapping<Alarm> {
  using Wire = v1::Alarm;
  static constexpr const char* kTopic = "fathom/v1/alarm";
  static constexpr const char* kType = "fathom::v1::Alarm";

  static void fields(auto& copy, auto& plain, auto& wire) {
    copy_header(copy, plain.header, wire);
    copy(plain.alarm, wire.alarm());
    copy_enum<Severity::critical, v1::Severity::SEVERITY_CRITICAL>(copy, plain.severity, wire.severity());
    copy(plain.active, wire.active());
    copy(plain.acknowledged, wire.acknowledged());
    copy(plain.since_ns, wire.since_ns());
    copy(plain.cleared_ns, wire.cleared_ns());
    copy(plain.text, wire.text());
    copy(plain.value, wire.value());
    copy(plain.limit, wire.limit());
  }

  static std::string key_text(const Alarm& sample) {
    return sample.header.vehicle.str() + "/" + sample.alarm.str();
  }
};

}  // namespace fathom::bus::detail

FATHOM_BUS_TOPIC(Alarm)
