#include "bus/detail/qos/effective_qos.hpp"

#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>

#include "bus/detail/participant_impl.hpp"
#include "bus/detail/qos/profiles.hpp"
#include "bus/detail/versions/settings.hpp"

namespace fathom::bus::detail {
namespace {

template <class Qos>
EffectiveQos common(const Qos& qos) {
  EffectiveQos result;
  result.matching =
      summarise(qos.reliability(), qos.durability(), qos.deadline(), qos.ownership(), qos.liveliness());
  result.keep_all = qos.history().kind == dds::KEEP_ALL_HISTORY_QOS;
  result.depth = qos.history().depth;
  result.max_samples = qos.resource_limits().max_samples;
  result.max_instances = qos.resource_limits().max_instances;
  result.max_samples_per_instance = qos.resource_limits().max_samples_per_instance;
  result.lifespan_ns = to_ns(qos.lifespan().duration);
  result.data_sharing = qos.data_sharing().kind() != dds::DataSharingKind::OFF;
  return result;
}

}  // namespace

EffectiveQos effective_writer_qos(Participant& participant, const std::string& topic) {
  const dds::DataWriter* writer = participant.impl().publisher->lookup_datawriter(topic);
  if (writer == nullptr) throw BusError("this participant has no writer of " + topic);
  const dds::DataWriterQos& qos = writer->get_qos();
  EffectiveQos result = common(qos);
  result.synchronous = qos.publish_mode().kind == dds::SYNCHRONOUS_PUBLISH_MODE;
  result.heartbeat_ns = to_ns(heartbeat_period(qos));
  result.ownership_strength = qos.ownership_strength().value;
  return result;
}

EffectiveQos effective_reader_qos(Participant& participant, const std::string& topic) {
  const dds::DataReader* reader = participant.impl().subscriber->lookup_datareader(topic);
  if (reader == nullptr) throw BusError("this participant has no reader of " + topic);
  return common(reader->get_qos());
}

}  // namespace fathom::bus::detail
