#pragma once

#include <cstdint>

#include <fastdds/dds/subscriber/SampleInfo.hpp>

#include "bus/detail/in_order.hpp"
#include "bus/detail/versions/discovery_listener.hpp"

namespace fathom::bus::detail {

/// A sample that Fast DDS handed over, and what it comes after.
inline Arrival arrival_of(const WriterGuid& guid, const dds::SampleInfo& info) {
  const auto number = [](const rtps::SampleIdentity& identity) {
    return static_cast<std::uint64_t>(identity.sequence_number().to64long());
  };
  Arrival arrival{{guid, number(info.sample_identity)}};
  const rtps::SampleIdentity& after = info.related_sample_identity;
  if (after.writer_guid() != rtps::GUID_t()) {
    arrival.after = Arrival::Place{to_guid(after.writer_guid()), number(after)};
  }
  return arrival;
}

}  // namespace fathom::bus::detail
