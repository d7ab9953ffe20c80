#include "health/vehicle_health.hpp"

#include <cmath>
#include <cstdlib>
#include <utility>

#include "health/text.hpp"
#include "samples/position/gives_position.hpp"

namespace fathom::health {

namespace {

std::vector<std::pair<SourceKind, Name>> names_of(const std::vector<ExpectedSensor>& sensors) {
  std::vector<std::pair<SourceKind, Name>> names;
  names.reserve(sensors.size());
  for (const ExpectedSensor& sensor : sensors) names.emplace_back(sensor.kind, sensor.name);
  return names;
}

std::vector<Name> names_of(const std::vector<ExpectedService>& services) {
  std::vector<Name> names;
  names.reserve(services.size());
  for (const ExpectedService& service : services) names.push_back(service.name);
  return names;
}

GpsOutageConfig gps_config(const HealthConfig& config) {
  GpsOutageConfig gps = config.gps;
  for (const ExpectedSensor& sensor : config.sensors)
    if (sensor.kind == SourceKind::gps) gps.receivers.push_back(sensor.name);
  return gps;
}

}  // namespace

VehicleHealth::VehicleHealth(const HealthConfig& config, const Instant& start, DescribeWriter describe)
    : config_(config),
      start_(start),
      fresh_(config.sensors, config.service),
      describe_(std::move(describe)),
      book_(config.vehicle),
      gps_(gps_config(config), start),
      fixes_(config.fixes, fresh_),
      interference_(fresh_),
      disputes_(fresh_),
      stamps_(config.stamps, fresh_),
      writers_(names_of(config.sensors)),
      changes_(names_of(config.services)),
      nav_(config.nav, config.startup_s, start),
      alignment_(config.alignment, fresh_),
      refusal_(config.refusal, fresh_),
      sensors_(config.sensors, config.startup_s, start),
      services_(config.services, config.service, config.startup_s, start) {}

void VehicleHealth::heard(SourceKind kind, const SampleHeader& header, const Instant& now,
                          const WriterGuid& writer) {
  if (!ours(header)) return;
  sensors_.heard(kind, header.sensor, now);
  stamps_.heard(kind, header, now);
  writers_.heard(kind, header.sensor, writer, now);
  if (kind == SourceKind::imu) changes_.heard_imu(header.sensor, writer, now);
}

void VehicleHealth::add(const GpsSample& sample, const Instant& now, const WriterGuid& writer) {
  if (!ours(sample.header)) return;
  heard(SourceKind::gps, sample.header, now, writer);
  const bool alive = fixes_.add(sample, now);
  const bool honest = interference_.add(sample, now);
  gps_.add(sample, now, alive && honest);
  // It was frozen before that could be known.
  if (!alive) gps_.doubt(sample.header.sensor, fixes_.same_since_ns(sample.header.sensor));
}

void VehicleHealth::add(const DvlSample& sample, const Instant& now, const WriterGuid& writer) {
  if (!ours(sample.header)) return;
  if (!is_second_half(sample)) heard(SourceKind::dvl, sample.header, now, writer);
  fixes_.add(sample, now);
}

bool VehicleHealth::is_second_half(const DvlSample& sample) {
  constexpr std::size_t kMostDvls = 16;  // names come from the network: bounded
  const Name& name = sample.header.sensor;
  const auto known = pings_.find(name);
  if (sample.mode == DvlMode::water) return known != pings_.end() && known->second == sample.header.stamp_ns;
  if (known != pings_.end() || pings_.size() < kMostDvls) pings_[name] = sample.header.stamp_ns;
  return false;
}

void VehicleHealth::add(const NavState& state, const Instant& now, const WriterGuid& writer) {
  if (!ours(state.header)) return;
  changes_.heard(state, writer, now);
  orders_.add(state);
  nav_.add(state, now);
  gps_.add(state, now);
  fixes_.add(state, now);
  alignment_.add(state, now);
  refusal_.add(state);
}

void VehicleHealth::add(const AlignmentStatus& status, const Instant& now) {
  if (ours(status.header)) alignment_.add(status, now);
}

void VehicleHealth::add(const ServiceStatus& status, const Instant& now) {
  if (!ours(status.header)) return;
  services_.add(status, now);
  stamps_.add(status, now);
  intruders_.add(status, now);
  clocks_.add(status, now);
  orders_.add(status, book_, now);
}

void VehicleHealth::add(const Verdict& verdict, const Instant& now) {
  if (!ours(verdict.header) || !is_news(verdict)) return;
  gps_.add(verdict);
  fixes_.add(verdict);
  refusal_.add(verdict, now);
  disputes_.add(verdict, now);
}

void VehicleHealth::add(const Forecast& forecast, const Instant& now) {
  if (ours(forecast.header)) gps_.add(forecast, now);
}

int VehicleHealth::apply(const Command& command, const Instant& now) {
  if (!ours(command.header)) return 0;
  orders_.apply(command, book_, now);
  if (command.kind != CommandKind::acknowledge_alarm) return 0;
  return book_.acknowledge(command.target.view());
}

void VehicleHealth::evaluate(const Instant& now) {
  gps_.evaluate(now);
  nav_.evaluate(now);
  sensors_.evaluate(now);
  services_.evaluate(now);
  gps_.report(book_, now);
  fixes_.report(book_, now);
  interference_.report(book_, now);
  disputes_.report(book_, now);
  stamps_.report(book_, now);
  writers_.report(book_, now, describe_);
  changes_.report(book_, now, describe_);
  nav_.report(book_, now);
  alignment_.report(book_, now);
  refusal_.report(book_, now);
  sensors_.report(book_, now);
  services_.report(book_, now);
  intruders_.report(book_, now);
  clocks_.report(book_, now);
  book_.settle(now);
}

bool VehicleHealth::known(const Instant& now) const {
  if (!gps_.known(now)) return false;
  if (now.monotonic_ns - start_.monotonic_ns >= from_seconds(config_.startup_s)) return true;
  return (!config_.nav.expected || nav_.ever_heard()) && sensors_.all_heard() && services_.all_heard();
}

MonitorStatus VehicleHealth::status(const Instant& now) const {
  MonitorStatus status;
  status.header.vehicle = config_.vehicle;
  status.header.stamp_ns = now.utc_ns;
  status.header.received_ns = now.utc_ns;
  status.mode = nav_.mode();
  status.alignment =
      nav_.mode() == NavMode::none && !nav_.fresh() ? AlignmentPhase::none : alignment_.phase();
  status.nav_state_age_s = nav_.age_s(now);
  const ReceiverOutage outage = gps_.vehicle(now);
  status.gps_outage_active = outage.active;
  status.gps_outage_severity = outage.severity;
  status.gps_outage_since_ns = outage.since_ns;
  status.gps_outage_s = outage.outage_s;
  status.gps_outage_longest_s = outage.longest_s;
  status.gps_outage_total_s = outage.total_s;
  status.gps_outage_count = outage.count;
  status.receivers = gps_.receivers(now);
  status.alarms_active = book_.active_count();
  status.alarms_unacknowledged = book_.unacknowledged_count();
  status.sensors = sensors_.items(now);
  status.services = services_.items(now);
  const bool navigating = !config_.nav.expected || (nav_.fresh() && gives_position(nav_.mode()));
  status.known = known(now);
  status.healthy = status.known && navigating && gps_.good() && !book_.any_active(Severity::warning);
  return status;
}

}  // namespace fathom::health
