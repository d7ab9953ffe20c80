#include "python/values.hpp"

#include <fathom/client.hpp>

#include "python/value_class.hpp"

namespace fathom::python {
namespace {

void add_states(py::module_& module, const KitPtr& kit) {
  ValueClass<SampleHeader>(module, kit, "SampleHeader", "What every sample carries.")
      .field("vehicle", &SampleHeader::vehicle, "Name of the vehicle.")
      .field("sensor", &SampleHeader::sensor,
             "Which instrument, e.g. \"gps0\"; for status samples the service.")
      .field("stamp_ns", &SampleHeader::stamp_ns, "Instant of validity, ns since the Unix epoch, UTC.")
      .field("received_ns", &SampleHeader::received_ns,
             "Arrival of the last byte at the bridge, ns since the Unix epoch, UTC.")
      .field("sequence", &SampleHeader::sequence, "Grows by one per sample of this writer.")
      .done();

  ValueClass<NavState>(
      module, kit, "NavState",
      "Navigation state at an inertial sample.\n\nN is north-east-down, B the body's forward-right-down. "
      "Unknown values are NaN.")
      .field("header", &NavState::header, "Vehicle, stamp and sequence; header.sensor is the fusion service.")
      .field("mode", &NavState::mode, "What the state rests on.")
      .field("alignment", &NavState::alignment, "How far alignment has come.")
      .field("latitude_rad", &NavState::latitude_rad, "Geodetic latitude, WGS-84, rad.")
      .field("longitude_rad", &NavState::longitude_rad, "Longitude, WGS-84, rad.")
      .field("altitude_m", &NavState::altitude_m, "Above the WGS-84 ellipsoid, up, m.")
      .field("depth_m", &NavState::depth_m, "Below the surface, down, m.")
      .field("altitude_above_bottom_m", &NavState::altitude_above_bottom_m,
             "As the altimeter heard it, m; NaN where that is not fresh.")
      .field("velocity_N_m_s", &NavState::velocity_N_m_s, "Velocity over ground, north-east-down, m/s.")
      .field("q_NB", &NavState::q_NB, "Hamilton quaternion, w first, turns B into N.")
      .field("rpy_rad", &NavState::rpy_rad, "Roll, pitch, yaw (ZYX), rad. Yaw is the true heading.")
      .field("angular_rate_B_rad_s", &NavState::angular_rate_B_rad_s,
             "Angular rate in B, bias-corrected, rad/s.")
      .field("specific_force_B_m_s2", &NavState::specific_force_B_m_s2,
             "Specific force in B, bias-corrected, m/s^2; (0, 0, -g) at rest and level.")
      .field("position_covariance_N_m2", &NavState::position_covariance_N_m2,
             "Covariance of the position in N, 3 rows of 3, m^2.")
      .field("velocity_covariance_N_m2_s2", &NavState::velocity_covariance_N_m2_s2,
             "Covariance of the velocity in N, 3 rows of 3, m^2/s^2.")
      .field("rpy_sigma_rad", &NavState::rpy_sigma_rad, "One sigma of roll, pitch, yaw, rad.")
      .field("gps_outage_s", &NavState::gps_outage_s,
             "Since the last GPS fix was used, s; NaN before the first.")
      .field("dvl_outage_s", &NavState::dvl_outage_s,
             "Since the last DVL velocity was used, s; NaN before the first.")
      .field("reset_counter", &NavState::reset_counter,
             "Grows with every step of the position that is not motion.")
      .field("last_reset_delta_N_m", &NavState::last_reset_delta_N_m, "The last such step in N, m.")
      .done();

  ValueClass<AlignmentCondition>(module, kit, "AlignmentCondition", "One condition that alignment waits for.")
      .field("name", &AlignmentCondition::name, "E.g. \"pitch_rad\".")
      .field("value", &AlignmentCondition::value, "Its value now, in the unit that the name says.")
      .field("limit", &AlignmentCondition::limit, "The magnitude of the value must stay below it.")
      .field("held_s", &AlignmentCondition::held_s, "For how long it has, s.")
      .field("needed_s", &AlignmentCondition::needed_s, "For how long it must, s.")
      .field("met", &AlignmentCondition::met, "Whether it is met.")
      .done();

  using Conditions = std::vector<AlignmentCondition>;
  const auto conditions = [](const AlignmentStatus& status) {
    const std::size_t count = std::min<std::size_t>(status.condition_count, AlignmentStatus::kMaxConditions);
    return Conditions(status.conditions.begin(),
                      status.conditions.begin() + static_cast<std::ptrdiff_t>(count));
  };
  ValueClass<AlignmentStatus>(module, kit, "AlignmentStatus",
                              "What alignment waits for, and what would help.")
      .field("header", &AlignmentStatus::header, "Vehicle, stamp and sequence.")
      .field("phase", &AlignmentStatus::phase, "How far alignment has come.")
      .field("in_phase_s", &AlignmentStatus::in_phase_s, "For how long it has been in this phase, s.")
      .field(
          "conditions", Crossing<Conditions>::type(),
          [conditions](const Kit& k, const AlignmentStatus& status) {
            return Crossing<Conditions>::out(k, conditions(status));
          },
          [](const Kit& k, AlignmentStatus& status, py::handle given, const std::string& where) {
            const Conditions all = Crossing<Conditions>::in(k, given, where);
            if (all.size() > AlignmentStatus::kMaxConditions)
              wrong_value(where, "at most 12 conditions", given);
            status.condition_count = static_cast<std::uint32_t>(all.size());
            std::copy(all.begin(), all.end(), status.conditions.begin());
          },
          [conditions](const AlignmentStatus& a, const AlignmentStatus& b) {
            return Crossing<Conditions>::same(conditions(a), conditions(b));
          },
          "The conditions of the phase.")
      .field("rpy_sigma_rad", &AlignmentStatus::rpy_sigma_rad, "One sigma of roll, pitch, yaw, rad.")
      .field("time_to_aligned_s", &AlignmentStatus::time_to_aligned_s, "Predicted, s; 0 when aligned.")
      .field("advice", &AlignmentStatus::advice, "The manoeuvre that would help, one English sentence.")
      .done();
}

void add_monitoring(py::module_& module, const KitPtr& kit) {
  ValueClass<Alarm>(module, kit, "Alarm", "A latched condition that the monitor tells of.")
      .field("header", &Alarm::header, "Vehicle, stamp and sequence; header.sensor is unused.")
      .field("alarm", &Alarm::alarm, "Its key, e.g. \"gps_outage\" or \"service_missing:fusion\".")
      .field("severity", &Alarm::severity, "How bad it is.")
      .field("active", &Alarm::active, "The condition holds now.")
      .field("acknowledged", &Alarm::acknowledged, "An operator has seen it.")
      .field("since_ns", &Alarm::since_ns, "Since when, ns since the Unix epoch, UTC.")
      .field("cleared_ns", &Alarm::cleared_ns, "When it ended, ns since the Unix epoch, UTC; 0 while active.")
      .field("text", &Alarm::text, "One English sentence.")
      .field("value", &Alarm::value, "What was measured, in the unit of the sentence.")
      .field("limit", &Alarm::limit, "What it is held against, in the same unit.")
      .done();
  ValueClass<WatchedItem>(module, kit, "WatchedItem", "One sensor stream or service as the monitor sees it.")
      .field("name", &WatchedItem::name, "Name of the sensor or the service.")
      .field("presence", &WatchedItem::presence, "Whether it is heard.")
      .field("age_s", &WatchedItem::age_s, "Since it was last heard, s.")
      .field("rate_hz", &WatchedItem::rate_hz, "Over the last seconds, Hz.")
      .done();
  ValueClass<ReceiverOutage>(module, kit, "ReceiverOutage",
                             "What one satellite receiver gave, by the monitor's own clock.")
      .field("name", &ReceiverOutage::name, "Name of the receiver.")
      .field("active", &ReceiverOutage::active, "It is in an outage.")
      .field("severity", &ReceiverOutage::severity, "Of the present outage.")
      .field("since_ns", &ReceiverOutage::since_ns,
             "Last usable fix before the present outage, ns since the Unix epoch, UTC; 0 when there is none.")
      .field("outage_s", &ReceiverOutage::outage_s,
             "Length of the present outage, s; 0 when none, NaN before the first fix.")
      .field("longest_s", &ReceiverOutage::longest_s, "The longest outage, s.")
      .field("total_s", &ReceiverOutage::total_s, "All outages together, s.")
      .field("count", &ReceiverOutage::count, "How many outages there were.")
      .done();
  ValueClass<MonitorStatus>(module, kit, "MonitorStatus", "The vehicle as the monitor sees it.")
      .field("header", &MonitorStatus::header, "Vehicle, stamp and sequence.")
      .field("known", &MonitorStatus::known, "False: the monitor has just been started and cannot say yet.")
      .field("healthy", &MonitorStatus::healthy, "Never while it is not known.")
      .field("mode", &MonitorStatus::mode, "What the navigation state rests on.")
      .field("alignment", &MonitorStatus::alignment, "How far alignment has come.")
      .field("nav_state_age_s", &MonitorStatus::nav_state_age_s, "Age of the navigation state, s.")
      .field("gps_outage_active", &MonitorStatus::gps_outage_active, "No receiver gives a usable fix.")
      .field("gps_outage_severity", &MonitorStatus::gps_outage_severity, "Of the present outage.")
      .field("gps_outage_since_ns", &MonitorStatus::gps_outage_since_ns,
             "Last usable fix before the present outage, ns since the Unix epoch, UTC; 0: none.")
      .field("gps_outage_s", &MonitorStatus::gps_outage_s,
             "Length of the present outage, s; 0 when none, NaN before the first fix.")
      .field("gps_outage_longest_s", &MonitorStatus::gps_outage_longest_s, "The longest outage, s.")
      .field("gps_outage_total_s", &MonitorStatus::gps_outage_total_s, "All outages together, s.")
      .field("gps_outage_count", &MonitorStatus::gps_outage_count, "How many outages there were.")
      .field("alarms_active", &MonitorStatus::alarms_active, "How many alarms are active.")
      .field("alarms_unacknowledged", &MonitorStatus::alarms_unacknowledged, "How many no operator has seen.")
      .field("sensors", &MonitorStatus::sensors, "The streams that are watched.")
      .field("services", &MonitorStatus::services, "The services that are watched.")
      .field("receivers", &MonitorStatus::receivers, "The satellite receivers.")
      .done();
}

void add_guidance(py::module_& module, const KitPtr& kit) {
  ValueClass<NavHealth>(module, kit, "NavHealth",
                        "Whether guidance may rely on the navigation state, and if not, why.")
      .field("ok", &NavHealth::ok, "It may.")
      .field("heard", &NavHealth::heard, "A state has been received at all.")
      .field("fresh", &NavHealth::fresh, "It is not older than the limit.")
      .field("usable", &NavHealth::usable,
             "The mode gives a position, and position, velocity and attitude are finite.")
      .field("aligned", &NavHealth::aligned, "The alignment phase is `aligned`.")
      .field("certain", &NavHealth::certain, "It is within the limits of uncertainty.")
      .field("mode", &NavHealth::mode, "What the state rests on.")
      .field("age_s", &NavHealth::age_s, "Since the state arrived, s; NaN when there is none.")
      .field("horizontal_95_m", &NavHealth::horizontal_95_m,
             "Radius that holds the true position with 95 % probability, m.")
      .field("heading_sigma_rad", &NavHealth::heading_sigma_rad, "One sigma of the heading, rad.")
      .field("reason", &NavHealth::reason,
             "Empty when ok; else one English sentence about the first thing that is wrong.")
      .done();
  ValueClass<HealthLimits>(module, kit, "HealthLimits",
                           "What a navigation state has to fulfil for health().ok.")
      .field("max_age_s", &HealthLimits::max_age_s, "Since the state arrived, s.")
      .field("max_horizontal_95_m", &HealthLimits::max_horizontal_95_m,
             "Radius that holds the true position with 95 % probability, m.")
      .field("max_heading_sigma_rad", &HealthLimits::max_heading_sigma_rad, "One sigma of the heading, rad.")
      .field("need_aligned", &HealthLimits::need_aligned, "The alignment phase must be `aligned`.")
      .done();
  ValueClass<RouteWaypoint>(module, kit, "RouteWaypoint", "A place that guidance passes through, WGS-84.")
      .field("name", &RouteWaypoint::name, "Empty: people call it by its number.")
      .field("latitude_rad", &RouteWaypoint::latitude_rad, "Geodetic latitude, rad.")
      .field("longitude_rad", &RouteWaypoint::longitude_rad, "Longitude, rad.")
      .field("depth_m", &RouteWaypoint::depth_m, "Below the surface, on the way there, m; NaN: unknown.")
      .field("speed_m_s", &RouteWaypoint::speed_m_s, "On the way there, m/s; NaN: unknown.")
      .done();
  ValueClass<Route>(module, kit, "Route",
                    "The waypoints that a program follows, for the people who watch it.")
      .field("header", &Route::header, "Filled in when it is published.")
      .field("active", &Route::active,
             "Index of the one steered to; as many as there are: the last one is passed.")
      .field("repeats", &Route::repeats, "After the last waypoint comes the first.")
      .field("first_number", &Route::first_number,
             "Of waypoints[0] within the mission: a long mission shows a part.")
      .field("mission_count", &Route::mission_count,
             "Waypoints of the whole mission; 0: as many as there are here.")
      .field("leg_start_latitude_rad", &Route::leg_start_latitude_rad,
             "Where the leg to the active waypoint began, rad.")
      .field("leg_start_longitude_rad", &Route::leg_start_longitude_rad,
             "Where the leg to the active waypoint began, rad.")
      .field("waypoints", &Route::waypoints, "At most 64; none: it follows nothing.")
      .done();
}

void add_options(py::module_& module, const KitPtr& kit) {
  ValueClass<ClientSecurity>(module, kit, "ClientSecurity",
                             "How to take part in a protected vehicle network (DDS Security).")
      .field("folder", &ClientSecurity::folder,
             "Credentials as `fathom keygen` makes; empty: $FATHOM_SECURITY_DIR, else not protected.")
      .field("identity", &ClientSecurity::identity, "Whose credentials in the folder.")
      .done();
  ValueClass<ClientOptions>(module, kit, "ClientOptions", "What fathom.Client was told.", "Client")
      .field("domain", &ClientOptions::domain, "DDS domain, 0 to 232.")
      .field("vehicle", &ClientOptions::vehicle,
             "Empty: the first vehicle heard, and only that one from then on.")
      .field("name", &ClientOptions::name, "How this program shows up on the vehicle network.")
      .field("interfaces", &ClientOptions::interfaces, "Addresses bound, nothing else is.")
      .field("peers", &ClientOptions::peers, "Asked for discovery besides multicast.")
      .field("discovery_servers", &ClientOptions::discovery_servers,
             "\"address:port\" of discovery servers; `peers` are not used then.")
      .field("profiles_dir", &ClientOptions::profiles_dir, "Folder of the QoS XML.")
      .field("package_profiles_dir", &ClientOptions::package_profiles_dir,
             "The one that came with the package.")
      .field("security", &ClientOptions::security, "For a protected network.")
      .field("limits", &ClientOptions::limits, "What health() holds the state against.")
      .done();
}

}  // namespace

void add_values(py::module_& module, const KitPtr& kit) {
  add_states(module, kit);
  add_monitoring(module, kit);
  add_guidance(module, kit);
  add_options(module, kit);
}

}  // namespace fathom::python
