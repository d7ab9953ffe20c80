#include "estimation/aiding/registry.hpp"

#include <algorithm>
#include <array>

#include "estimation/aiding/airspeed.hpp"
#include "estimation/aiding/baro_altitude.hpp"
#include "estimation/aiding/beacon_range.hpp"
#include "estimation/aiding/depth.hpp"
#include "estimation/aiding/dvl_beams.hpp"
#include "estimation/aiding/dvl_velocity.hpp"
#include "estimation/aiding/fix_position.hpp"
#include "estimation/aiding/flow_angles.hpp"
#include "estimation/aiding/gps_position.hpp"
#include "estimation/aiding/gps_velocity.hpp"
#include "estimation/aiding/heading.hpp"
#include "estimation/aiding/model_velocity.hpp"
#include "estimation/aiding/speed_log.hpp"
#include "estimation/aiding/usbl_position.hpp"
#include "estimation/aiding/usbl_range_bearing.hpp"
#include "estimation/aiding/usbl_vector.hpp"

namespace fathom::estimation {
namespace {

template <class Model>
constexpr AidingEntry entry() {
  using Sample = typename Model::Sample;
  return {kSourceOf<Sample>, Model::kName,
          [](const AidingInput& input, const EventSample& sample, Observation& out) {
            return Model::append_rows(input, std::get<Sample>(sample), out);
          },
          [](const SensorConfig& sensor, const EventSample& sample) {
            return Model::policy(sensor, std::get<Sample>(sample));
          },
          [](const SensorConfig& sensor) {
            if constexpr (requires { Model::may_aid(sensor); }) return Model::may_aid(sensor);
            return true;
          }};
}

/// A sample's rows come in this order.
constexpr std::array kRegistry{
    entry<GpsPosition>(),   entry<GpsVelocity>(), entry<DvlVelocity>(),
    entry<DvlBeams>(),      entry<Depth>(),       entry<Heading>(),
    entry<UsblPosition>(),  entry<UsblVector>(),  entry<UsblRangeBearing>(),
    entry<Airspeed>(),      entry<FlowAngles>(),  entry<BaroAltitude>(),
    entry<ModelVelocity>(), entry<SpeedLog>(),    entry<BeaconRange>(),
    entry<FixPosition>(),
};

}  // namespace

SensorConfig default_sensor(SourceKind kind, const std::string& name) {
  SensorConfig sensor;
  sensor.sensor = name;
  sensor.kind = kind;
  for_each_aiding_kind([&](auto row) {
    using Sample = typename decltype(row)::Sample;
    if (row.kSource == kind) set_defaults(sensor, static_cast<const Sample*>(nullptr));
  });
  return sensor;
}

bool may_aid(const SensorConfig& sensor) {
  return std::any_of(kRegistry.begin(), kRegistry.end(), [&](const AidingEntry& entry) {
    return entry.source == sensor.kind && entry.may_aid(sensor);
  });
}

bool may_place(const SensorConfig& sensor, const EventSample& sample) {
  return std::any_of(kRegistry.begin(), kRegistry.end(), [&](const AidingEntry& entry) {
    return entry.source == sensor.kind && entry.policy(sensor, sample).position;
  });
}

std::span<const AidingEntry> aiding_registry() {
  return kRegistry;
}

}  // namespace fathom::estimation
