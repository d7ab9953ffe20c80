#include "samples/status/route.hpp"

#include "bus/detail/mapping.hpp"
#include "idl/guidance.h"

namespace fathom::bus::detail {

template <>
struct Mapping<Route> {
  using Wire = v1::Route;
  static constexpr const char* kTopic = "fathom/v1/route";
  static constexpr const char* kType = "fathom::v1::Route";
  static constexpr bool kHasLists = true;

  static void fields(auto& copy, auto& plain, auto& wire) {
    // The publisher is the key, so it has the name of one on the wire.
    copy(plain.header.vehicle, wire.vehicle());
    copy(plain.header.sensor, wire.publisher());
    copy(plain.header.stamp_ns, wire.stamp_ns());
    copy(plain.header.received_ns, wire.received_ns());
    copy(plain.header.sequence, wire.sequence_number());
    copy(plain.active, wire.active());
    copy(plain.repeats, wire.repeats());
    copy(plain.first_number, wire.first_number());
    copy(plain.mission_count, wire.mission_count());
    copy(plain.leg_start_latitude_rad, wire.leg_start_latitude_rad());
    copy(plain.leg_start_longitude_rad, wire.leg_start_longitude_rad());
    copy.sequence(plain.waypoints, wire.waypoints(), Route::kMostWaypoints,
                  [](auto& each, auto& point, auto& w) {
                    each(point.name, w.name());
                    each(point.latitude_rad, w.latitude_rad());
                    each(point.longitude_rad, w.longitude_rad());
                    each(point.depth_m, w.depth_m());
                    each(point.speed_m_s, w.speed_m_s());
                  });
  }

  static std::string key_text(const Route& sample) { return vehicle_and_sensor(sample); }
};

}  // namespace fathom::bus::detail

FATHOM_BUS_TOPIC(Route)
