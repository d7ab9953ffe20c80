#pragma once

#include <string>

#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/publisher/qos/DataWriterQos.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/subscriber/qos/DataReaderQos.hpp>

#include "bus/detail/qos/qos_summary.hpp"
#include "bus/detail/versions/names.hpp"
#include "bus/reader.hpp"
#include "bus/writer.hpp"

namespace fathom::bus::detail {

/// The folder of QoS profiles: `configured`, else as ParticipantOptions::profiles_dir says. Throws BusError
/// naming the places it looked at.
[[nodiscard]] std::string find_profiles_dir(const std::string& configured);

/// Loads every *.xml of the folder, in the order of the names, into the process; a file loaded before is
/// skipped. Throws BusError naming the file.
void load_profiles(const std::string& folder);

/// The topic's profile, changed by the configuration. Throws BusError.
[[nodiscard]] dds::DataWriterQos writer_qos(const dds::Publisher& publisher, const std::string& topic,
                                            const WriterOptions& options);
[[nodiscard]] dds::DataReaderQos reader_qos(const dds::Subscriber& subscriber, const std::string& topic,
                                            const ReaderOptions& options);

[[nodiscard]] Policy policy_of(dds::QosPolicyId_t id);

[[nodiscard]] inline DurationNs to_ns(const Duration& duration) {
  if (duration.seconds == infinite_duration().seconds) return kForever;
  return duration.seconds * kNsPerSecond + static_cast<DurationNs>(duration.nanosec);
}

/// The summary of a DataWriterQos, a DataReaderQos or their counterparts in discovery.
template <class Reliability, class Durability, class Deadline, class Ownership, class Liveliness>
QosSummary summarise(const Reliability& reliability, const Durability& durability, const Deadline& deadline,
                     const Ownership& ownership, const Liveliness& liveliness) {
  QosSummary summary;
  summary.reliability = reliability.kind == dds::RELIABLE_RELIABILITY_QOS ? 1 : 0;
  summary.durability = durability.kind;
  summary.deadline_ns = to_ns(deadline.period);
  summary.ownership = ownership.kind;
  summary.liveliness = liveliness.kind;
  summary.lease_ns = to_ns(liveliness.lease_duration);
  return summary;
}

}  // namespace fathom::bus::detail
