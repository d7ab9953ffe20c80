#include "bus/detail/mapping.hpp"
#include "idl/health.h"
#include "samples/status/health.hpp"

namespace fathom::bus::detail {

template <>
struct Mapping<MonitorStatus> {
  using Wire = v1::MonitorStatus;
  static constexpr const char* kTopic = "fathom/v1/monitor_status";
  static constexpr const char* kType = "fathom::v1::MonitorStatus";
  static constexpr bool kHasLists = true;

  static void fields(auto& copy, auto& plain, auto& wire) {
    copy_header(copy, plain.header, wire);
    copy(plain.known, wire.known());
    copy(plain.healthy, wire.healthy());
    copy_enum<NavMode::inertial, v1::NavMode::NAV_MODE_INERTIAL>(copy, plain.mode, wire.mode());
    copy_enum<AlignmentPhase::lost, v1::AlignmentPhase::ALIGNMENT_PHASE_LOST>(copy, plain.alignment,
                                                                              wire.alignment());
    copy(plain.nav_state_age_s, wire.nav_state_age_s());
    copy(plain.gps_outage_active, wire.gps_outage_active());
    copy_enum<Severity::critical, v1::Severity::SEVERITY_CRITICAL>(copy, plain.gps_outage_severity,
                                                                   wire.gps_outage_severity());
    copy(plain.gps_outage_since_ns, wire.gps_outage_since_ns());
    copy(plain.gps_outage_s, wire.gps_outage_s());
    copy(plain.gps_outage_longest_s, wire.gps_outage_longest_s());
    copy(plain.gps_outage_total_s, wire.gps_outage_total_s());
    copy(plain.gps_outage_count, wire.gps_outage_count());
    copy(plain.alarms_active, wire.alarms_active());
    copy(plain.alarms_unacknowledged, wire.alarms_unacknowledged());
    const auto item = [](auto& each, auto& watched, auto& w) {
      each(watched.name, w.name());
      copy_enum<Presence::missing, v1::Presence::PRESENCE_MISSING>(each, watched.presence, w.presence());
      each(watched.age_s, w.age_s());
      each(watched.rate_hz, w.rate_hz());
    };
    copy.sequence(plain.sensors, wire.sensors(), 32, item);
    copy.sequence(plain.services, wire.services(), 32, item);
    const auto receiver = [](auto& each, auto& outage, auto& w) {
      each(outage.name, w.name());
      each(outage.active, w.active());
      copy_enum<Severity::critical, v1::Severity::SEVERITY_CRITICAL>(each, outage.severity, w.severity());
      each(outage.since_ns, w.since_ns());
      each(outage.outage_s, w.outage_s());
      each(outage.longest_s, w.longest_s());
      each(outage.total_s, w.total_s());
      each(outage.count, w.count());
    };
    copy.sequence(plain.receivers, wire.receivers(), 16, receiver);
  }

  static std::string key_text(const MonitorStatus& sample) { return sample.header.vehicle.str(); }
};

}  // namespace fathom::bus::detail

FATHOM_BUS_TOPIC(MonitorStatus)
