#include "bus/detail/mapping.hpp"
#include "idl/replication.h"
#include "samples/status/replication.hpp"

namespace fathom::bus::detail {

template <>
struct Mapping<ReplicaStatus> {
  using Wire = v1::ReplicaStatus;
  static constexpr const char* kTopic = "fathom/v1/replica_status";
  static constexpr const char* kType = "fathom::v1::ReplicaStatus";

  static void fields(auto& copy, auto& plain, auto& wire) {
    copy_header(copy, plain.header, wire);
    copy_enum<ReplicaPhase::in_step, v1::ReplicaPhase::REPLICA_PHASE_IN_STEP>(copy, plain.phase,
                                                                              wire.phase());
    copy(plain.in_step_s, wire.in_step_s());
    copy(plain.leads, wire.leads());
    copy(plain.ownership_strength, wire.ownership_strength());
    copy(plain.missed, wire.missed());
    copy(plain.caught_up, wire.caught_up());
    copy(plain.unprepared, wire.unprepared());
  }

  static std::string key_text(const ReplicaStatus& sample) { return vehicle_and_sensor(sample); }
};

}  // namespace fathom::bus::detail

FATHOM_BUS_TOPIC(ReplicaStatus)
