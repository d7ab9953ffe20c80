#include "console/view/vehicle_view_json.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string_view>

#include "base/units.hpp"
#include "console/view/rows.hpp"
#include "status/json.hpp"

namespace fathom::console {
namespace {

/// Longitude in [-180, 180] degrees, as the map wants it; unknown stays unknown.
double wrapped_deg(double longitude_rad) {
  return std::remainder(longitude_rad * kDegPerRad, 360.0);
}

void write(Rows& out, const NavRow& row) {
  out.open('[');
  out.instant(row.utc_ns);
  // Positions to 1e-8 degree (a millimetre), all else to six digits.
  out.number(row.values[0], 10);
  out.number(row.values[1], 11);
  for (std::size_t i = 2; i < row.values.size(); ++i) out.number(row.values[i]);
  out.close(']');
}

void write(Rows& out, const VerdictRow& row) {
  out.open('[');
  out.instant(row.utc_ns);
  out.whole(static_cast<int>(row.kind));
  out.number(static_cast<double>(row.test_ratio), 4);
  out.number(static_cast<double>(row.latency_s), 4);
  for (std::size_t i = 0; i < row.dimensions; ++i) {
    out.number(static_cast<double>(row.innovation[i]), 4);
    out.number(static_cast<double>(row.sigma[i]), 4);
  }
  out.close(']');
}

void write(Rows& out, const FixRow& row) {
  out.open('[');
  out.instant(row.utc_ns);
  out.number(row.latitude_deg, 10);
  out.number(row.longitude_deg, 11);
  out.number(row.sigma_m, 4);
  out.text(to_string(row.source));
  out.text(row.sensor.view());
  row.verdict ? out.whole(static_cast<int>(*row.verdict)) : out.number(kUnknown);
  out.close(']');
}

void write(Rows& out, const DetailRow& row, std::size_t count) {
  out.open('[');
  out.instant(row.utc_ns);
  for (std::size_t i = 0; i < count; ++i) {
    out.number(static_cast<double>(row.value[i]), 5);
    out.number(static_cast<double>(row.sigma[i]), 4);
  }
  out.close(']');
}

/// What a series is called, before its rows.
void head(Rows& out, std::size_t index, const VerdictSeries& series) {
  out.key("index");
  out.whole(static_cast<std::int64_t>(index));
  out.key("sensor");
  out.text(series.sensor.view());
  out.key("model");
  out.text(series.model.view());
  out.key("source");
  out.text(to_string(series.source));
}

void write_fresh_verdicts(Rows& out, const Tick& tick) {
  out.key("verdicts");
  out.open('[');
  for (std::size_t i = 0; i < tick.fresh_series.size(); ++i) {
    const auto mine = [i](const auto& entry) { return entry.first == i; };
    const auto& rows = tick.fresh.verdicts;
    if (std::none_of(rows.begin(), rows.end(), mine)) continue;
    out.open('{');
    head(out, i, tick.fresh_series[i]);
    out.key("rows");
    out.open('[');
    for (const auto& [index, row] : rows) {
      if (index == i) write(out, row);
    }
    out.close(']');
    out.close('}');
  }
  out.close(']');
}

void write_sources(Rows& out, const Tick& tick) {
  out.key("sources");
  out.open('[');
  for (const SourceLine& line : tick.sources) {
    out.open('{');
    out.key("sensor");
    out.text(line.sensor.view());
    out.key("kind");
    out.text(to_string(line.kind));
    out.key("last");
    out.text(to_string(line.last));
    out.key("last_ratio");
    out.number(line.last_ratio, 4);
    out.key("latency_s");
    out.number(line.latency_s, 4);
    out.key("since_used_s");
    out.number(line.since_used_s, 5);
    out.key("since_heard_s");
    out.number(line.since_heard_s, 5);
    out.key("counts");
    out.open('[');
    for (const std::uint64_t count : line.counts) out.whole(static_cast<std::int64_t>(count));
    out.close(']');
    out.close('}');
  }
  out.close(']');
}

void write_services(Rows& out, const Tick& tick) {
  out.key("services");
  out.open('[');
  for (const ServiceLine& line : tick.services) {
    out.open('{');
    out.key("name");
    out.text(line.status.header.sensor.view());
    out.key("restarts");
    out.whole(line.restarts);
    out.key("started_ms");
    out.instant(line.status.started_ns);
    out.key("rates");
    out.open('[');
    for (const ServiceRate& rate : line.status.rates) {
      out.open('[');
      out.text(rate.name.view());
      out.number(rate.hz, 5);
      out.close(']');
    }
    out.close(']');
    out.key("counters");
    out.open('[');
    for (const ServiceCounter& counter : line.status.counters) {
      out.open('[');
      out.text(counter.name.view());
      out.whole(static_cast<std::int64_t>(counter.value));
      out.close(']');
    }
    out.close(']');
    out.close('}');
  }
  out.close(']');
}

void write(Rows& out, const RouteWaypoint& point) {
  out.open('[');
  out.text(point.name.view());
  out.number(point.latitude_rad * kDegPerRad, 10);
  out.number(wrapped_deg(point.longitude_rad), 11);
  out.number(point.depth_m);
  out.number(point.speed_m_s);
  out.close(']');
}

void write_routes(Rows& out, const std::vector<RouteLine>& lines) {
  out.key("routes");
  out.open('[');
  for (const RouteLine& line : lines) {
    const Route& route = line.route;
    out.open('{');
    out.key("publisher");
    out.text(route.header.sensor.view());
    out.key("age_s");
    out.number(line.age_s, 5);
    out.key("old");
    out.raw(line.old ? "true" : "false");
    out.key("active");
    out.whole(route.active);
    out.key("repeats");
    out.raw(route.repeats ? "true" : "false");
    out.key("first_number");
    out.whole(route.first_number);
    out.key("mission_count");
    out.whole(route.mission_count);
    out.key("leg_start");
    out.open('[');
    out.number(route.leg_start_latitude_rad * kDegPerRad, 10);
    out.number(wrapped_deg(route.leg_start_longitude_rad), 11);
    out.close(']');
    out.key("points");
    out.open('[');
    for (const RouteWaypoint& point : route.waypoints) write(out, point);
    out.close(']');
    out.close('}');
  }
  out.close(']');
}

void write_beacons(Rows& out, const std::vector<BeaconLine>& lines) {
  out.key("beacons");
  out.open('[');
  for (const BeaconLine& line : lines) {
    const RangeSample& range = line.range;
    out.open('{');
    out.key("name");
    out.text(range.beacon.view());
    out.key("sensor");
    out.text(range.header.sensor.view());
    out.key("lat_deg");
    out.number(range.beacon_latitude_rad * kDegPerRad, 10);
    out.key("lon_deg");
    out.number(wrapped_deg(range.beacon_longitude_rad), 11);
    out.key("depth_m");
    out.number(range.beacon_depth_m);
    out.key("range_m");
    out.number(range.range_m);
    out.key("sigma_m");
    out.number(range.sigma_m, 4);
    out.key("age_s");
    out.number(line.age_s, 5);
    out.key("verdict");
    line.verdict ? out.whole(static_cast<int>(*line.verdict)) : out.number(kUnknown);
    out.close('}');
  }
  out.close(']');
}

/// Two by two of the horizontal covariance: the page draws the ellipse.
void write_covariance(Rows& out, const Tick& tick) {
  out.key("horizontal_covariance_m2");
  out.open('[');
  if (tick.view.nav) {
    const auto& p = tick.view.nav->sample.position_covariance_N_m2;
    for (const std::size_t i : {0U, 1U, 4U}) out.number(p[i]);
  }
  out.close(']');
}

void write_names(Rows& out, const std::vector<Name>& names) {
  out.key("detail_names");
  out.open('[');
  for (const Name& name : names) out.text(name.view());
  out.close(']');
}

}  // namespace

std::string tick_json(const Tick& tick) {
  std::string text;
  text.reserve(12000);
  Rows out(text);
  out.open('{');
  out.key("tick");
  out.whole(static_cast<std::int64_t>(tick.number));
  out.key("utc_ms");
  out.instant(tick.utc_ns);
  out.key("trust");
  out.open('{');
  out.key("level");
  out.text(to_string(tick.trust.level));
  out.key("sentence");
  out.text(tick.trust.sentence);
  out.key("advice");
  out.text(tick.trust.advice);
  out.close('}');
  out.key("status");
  out.raw(status::json_line(tick.view));
  out.key("nav_latency_s");
  out.number(tick.nav_latency_s, 4);
  write_covariance(out, tick);
  write_beacons(out, tick.beacons);
  out.key("current");
  out.open('[');
  for (const StateEstimate& state : tick.current) {
    out.open('[');
    out.text(state.name.view());
    out.number(state.value, 5);
    out.number(state.sigma, 4);
    out.close(']');
  }
  out.close(']');
  write_sources(out, tick);
  write_services(out, tick);
  if (tick.routes) write_routes(out, *tick.routes);
  out.key("nav");
  out.open('[');
  for (const NavRow& row : tick.fresh.nav) write(out, row);
  out.close(']');
  write_fresh_verdicts(out, tick);
  out.key("fixes");
  out.open('[');
  for (const FixRow& row : tick.fresh.fixes) write(out, row);
  out.close(']');
  if (tick.fresh.detail_renamed) write_names(out, tick.detail_names);
  out.key("detail");
  out.open('[');
  if (tick.fresh.detail) write(out, *tick.fresh.detail, tick.detail_count);
  out.close(']');
  out.close('}');
  return text;
}

std::string snapshot_json(const Snapshot& snapshot) {
  const History& history = snapshot.history;
  std::string text;
  text.reserve(300 * history.nav().size() + 20000);
  Rows out(text);
  const auto rows = [&out](const char* key, const auto& ring, auto&&... more) {
    out.key(key);
    out.open('[');
    for (std::size_t i = 0; i < ring.size(); ++i) write(out, ring[i], more...);
    out.close(']');
  };
  out.open('{');
  out.key("tick");
  out.whole(static_cast<std::int64_t>(snapshot.tick));
  out.key("nav_columns");
  out.open('[');
  for (const std::string_view name : kNavColumns) out.text(name);
  out.close(']');
  out.key("verdict_kinds");
  out.open('[');
  for (std::size_t i = 0; i < kVerdictKinds; ++i) out.text(to_string(static_cast<VerdictKind>(i)));
  out.close(']');
  out.key("nav_modes");
  out.open('[');
  for (int i = 0; i <= static_cast<int>(NavMode::inertial); ++i) out.text(to_string(static_cast<NavMode>(i)));
  out.close(']');
  rows("nav", history.nav());
  rows("fixes", history.fixes());
  out.key("verdicts");
  out.open('[');
  for (std::size_t i = 0; i < history.verdicts().size(); ++i) {
    out.open('{');
    head(out, i, history.verdicts()[i]);
    rows("rows", history.verdicts()[i].rows);
    out.close('}');
  }
  out.close(']');
  const NavDetail& detail = history.detail_names();
  std::vector<Name> names;
  for (std::size_t i = 0; i < detail.count; ++i) names.push_back(detail.states[i].name);
  write_names(out, names);
  rows("detail", history.detail(), names.size());
  out.close('}');
  return text;
}

}  // namespace fathom::console
