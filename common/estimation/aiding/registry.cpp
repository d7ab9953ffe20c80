#include "estimation/aiding/registry.hpp"

#include "estimation/aiding/airspeed.hpp"
#include "estimation/aiding/baro_altitude.hpp"
#include "estimation/aiding/depth.hpp"
#include "estimation/aiding/dvl_beams.hpp"
#include "estimation/aiding/dvl_velocity.hpp"
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

/// Appends the model's rows; a sample none of whose components is finite is out of range.
template <class Model>
Usable append(const Model& model, const AidingInput& in, Observation& out) {
  const int before = out.rows;
  observe(model, in.state.index, out);
  return out.rows > before ? Usable::yes : Usable::out_of_range;
}

Usable gps_position(const AidingInput& in, const EventSample& any, Observation& out) {
  const auto& sample = std::get<GpsSample>(any);
  if (!in.sensor.use_position) return Usable::not_estimated;
  const Usable usable = GpsPosition::usable(in.sensor, sample);
  return usable == Usable::yes ? append(GpsPosition(in.state, in.sensor, sample), in, out) : usable;
}

Usable gps_velocity(const AidingInput& in, const EventSample& any, Observation& out) {
  const auto& sample = std::get<GpsSample>(any);
  if (!in.sensor.use_velocity) return Usable::not_estimated;
  const Usable usable = GpsVelocity::usable(in.sensor, sample);
  return usable == Usable::yes ? append(GpsVelocity(in.state, in.sensor, sample), in, out) : usable;
}

Usable dvl_velocity(const AidingInput& in, const EventSample& any, Observation& out) {
  const auto& sample = std::get<DvlSample>(any);
  if (DvlBeams::present(in.sensor, sample)) return Usable::other_model;
  const Usable usable = DvlVelocity::usable(in.state, sample);
  return usable == Usable::yes ? append(DvlVelocity(in.state, in.sensor, sample), in, out) : usable;
}

Usable dvl_beams(const AidingInput& in, const EventSample& any, Observation& out) {
  const auto& sample = std::get<DvlSample>(any);
  if (!DvlBeams::present(in.sensor, sample)) return Usable::other_model;
  const Usable usable = DvlBeams::usable(in.state, sample);
  if (usable != Usable::yes) return usable;
  out.each_alone = true;
  return append(DvlBeams(in.state, in.sensor, sample), in, out);
}

Usable depth(const AidingInput& in, const EventSample& any, Observation& out) {
  const auto& sample = std::get<DepthSample>(any);
  const Usable usable = Depth::usable(sample);
  return usable == Usable::yes ? append(Depth(in.state, in.sensor, sample, in.surface_altitude_m), in, out)
                               : usable;
}

Usable heading(const AidingInput& in, const EventSample& any, Observation& out) {
  const auto& sample = std::get<HeadingSample>(any);
  const Usable usable = Heading::usable(in.state, sample);
  return usable == Usable::yes ? append(Heading(in.state, in.sensor, sample), in, out) : usable;
}

Usable usbl_position(const AidingInput& in, const EventSample& any, Observation& out) {
  const auto& sample = std::get<UsblSample>(any);
  if (sample.frame != UsblFrame::geodetic) return Usable::other_model;
  const Usable usable = UsblPosition::usable(sample);
  return usable == Usable::yes
             ? append(UsblPosition(in.state, in.sensor, sample, in.surface_altitude_m), in, out)
             : usable;
}

Usable usbl_vector(const AidingInput& in, const EventSample& any, Observation& out) {
  const auto& sample = std::get<UsblSample>(any);
  if (sample.frame == UsblFrame::geodetic || UsblRangeBearing::present(sample)) return Usable::other_model;
  const Usable usable = UsblVector::usable(in.sensor, sample);
  return usable == Usable::yes
             ? append(UsblVector(in.state, in.sensor, sample, in.surface_altitude_m), in, out)
             : usable;
}

Usable usbl_range_bearing(const AidingInput& in, const EventSample& any, Observation& out) {
  const auto& sample = std::get<UsblSample>(any);
  if (sample.frame == UsblFrame::geodetic || !UsblRangeBearing::present(sample)) return Usable::other_model;
  const Usable usable = UsblRangeBearing::usable(in.sensor, sample);
  return usable == Usable::yes
             ? append(UsblRangeBearing(in.state, in.sensor, sample, in.surface_altitude_m), in, out)
             : usable;
}

Usable airspeed(const AidingInput& in, const EventSample& any, Observation& out) {
  const auto& sample = std::get<AirspeedSample>(any);
  const Usable usable = Airspeed::usable(in.state, sample);
  return usable == Usable::yes ? append(Airspeed(in.state, in.sensor, sample, in.unused_s), in, out) : usable;
}

Usable flow_angles(const AidingInput& in, const EventSample& any, Observation& out) {
  if (!FlowAngles::wanted(in.sensor)) return Usable::not_estimated;
  const Usable usable = Airspeed::usable(in.state, std::get<AirspeedSample>(any));
  if (usable != Usable::yes) return usable;
  out.each_alone = true;
  return append(FlowAngles(in.state, in.sensor, in.unused_s), in, out);
}

Usable baro_altitude(const AidingInput& in, const EventSample& any, Observation& out) {
  const auto& sample = std::get<AirspeedSample>(any);
  const Usable usable = BaroAltitude::usable(in.sensor, sample);
  if (usable != Usable::yes) return usable;
  out.each_alone = true;
  return append(BaroAltitude(in.state, in.sensor, sample), in, out);
}

Usable speed_log(const AidingInput& in, const EventSample& any, Observation& out) {
  // The model knows more of the same shaft speed.
  if (in.water != nullptr) return Usable::not_estimated;
  const auto& sample = std::get<PropulsionSample>(any);
  const Usable usable = SpeedLog::usable(in.state, in.sensor, sample, in.surface_altitude_m);
  return usable == Usable::yes ? append(SpeedLog(in.state, in.sensor, sample, in.unused_s), in, out) : usable;
}

Usable model_velocity(const AidingInput& in, const EventSample& any, Observation& out) {
  if (in.water == nullptr || in.vehicle_model == nullptr) return Usable::not_estimated;
  const auto& sample = std::get<PropulsionSample>(any);
  const Usable usable =
      ModelVelocity::usable(in.state, *in.vehicle_model, *in.water, sample, in.surface_altitude_m);
  return usable == Usable::yes ? append(ModelVelocity(in.state, *in.vehicle_model, *in.water), in, out)
                               : usable;
}

constexpr std::array<AidingEntry, 14> kRegistry{{
    {SourceKind::gps, GpsPosition::kName, gps_position},
    {SourceKind::gps, GpsVelocity::kName, gps_velocity},
    {SourceKind::dvl, DvlVelocity::kName, dvl_velocity},
    {SourceKind::dvl, DvlBeams::kName, dvl_beams},
    {SourceKind::depth, Depth::kName, depth},
    {SourceKind::heading, Heading::kName, heading},
    {SourceKind::usbl, UsblPosition::kName, usbl_position},
    {SourceKind::usbl, UsblVector::kName, usbl_vector},
    {SourceKind::usbl, UsblRangeBearing::kName, usbl_range_bearing},
    {SourceKind::airspeed, Airspeed::kName, airspeed},
    {SourceKind::airspeed, FlowAngles::kName, flow_angles},
    {SourceKind::airspeed, BaroAltitude::kName, baro_altitude},
    {SourceKind::propulsion, ModelVelocity::kName, model_velocity},
    {SourceKind::propulsion, SpeedLog::kName, speed_log},
}};

}  // namespace

std::span<const AidingEntry> aiding_registry() {
  return kRegistry;
}

}  // namespace fathom::estimation
