#pragma once

#include <cstdint>
#include <string>

#include "bus/detail/qos/qos_summary.hpp"
#include "bus/participant.hpp"

namespace fathom::bus::detail {

/// The policies that an existing reader or writer really has, free of Fast DDS types.
struct EffectiveQos {
  QosSummary matching;
  bool keep_all = false;
  int depth = 0;
  int max_samples = 0;
  int max_instances = 0;
  int max_samples_per_instance = 0;
  DurationNs lifespan_ns = kForever;
  bool data_sharing = true;
  // Of writers only:
  bool synchronous = false;
  DurationNs heartbeat_ns = 0;
  std::uint32_t ownership_strength = 0;
};

/// The policies of the participant's writer (reader) of this topic. Throws BusError when there is none.
[[nodiscard]] EffectiveQos effective_writer_qos(Participant& participant, const std::string& topic);
[[nodiscard]] EffectiveQos effective_reader_qos(Participant& participant, const std::string& topic);

}  // namespace fathom::bus::detail
