#include "bus/detail/mapping.hpp"
#include "idl/replication.h"
#include "samples/status/replication.hpp"

namespace fathom::bus::detail {

template <>
struct Mapping<EngineStatePart> {
  using Wire = v1::EngineStatePart;
  static constexpr const char* kTopic = "fathom/v1/engine_state";
  static constexpr const char* kType = "fathom::v1::EngineStatePart";

  static void fields(auto& copy, auto& plain, auto& wire) {
    copy_header(copy, plain.header, wire);
    copy(plain.transfer, wire.transfer());
    copy(plain.missed, wire.missed());
    copy(plain.part, wire.part());
    copy(plain.parts, wire.parts());
    copy(plain.size, wire.size());
    copy(plain.bytes, wire.bytes());
  }

  static std::string key_text(const EngineStatePart& sample) { return vehicle_and_sensor(sample); }
};

}  // namespace fathom::bus::detail

FATHOM_BUS_TOPIC(EngineStatePart)
