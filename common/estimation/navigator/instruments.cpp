#include "estimation/navigator/instruments.hpp"

#include <cmath>

#include "estimation/aiding/model.hpp"

namespace fathom::estimation {
namespace {

/// Equal, and not all of them unknown.
bool same(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  bool any = false;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (std::isnan(a[i]) != std::isnan(b[i])) return false;
    if (!std::isnan(a[i]) && a[i] != b[i]) return false;
    any = any || !std::isnan(a[i]);
  }
  return any;
}

/// Of the variance that is expected: what a simulator without noise leaves, that may well repeat itself, is
/// less, and what an instrument leaves whose sigma is said eight times too large is more.
constexpr double kLeastNoise = 0.015;
constexpr double kForgets = 0.05;
/// Beacons without an address that lie closer together are one: seen from where they are heard they lie in
/// much the same direction, and one that drifts is followed.
constexpr double kApart_m = 100.0;

}  // namespace

std::optional<BeaconId> beacon_of(const EventSample& sample) {
  BeaconId id;
  if (const auto* range = std::get_if<RangeSample>(&sample)) {
    id = {range->beacon, range->beacon_latitude_rad, range->beacon_longitude_rad};
  } else if (const auto* usbl = std::get_if<UsblSample>(&sample)) {
    // Else the transponder is the vehicle's own.
    if (usbl->frame != UsblFrame::vehicle_frd) return std::nullopt;
    id = {usbl->transponder, usbl->station_latitude_rad, usbl->station_longitude_rad};
  } else {
    return std::nullopt;
  }
  if (!is_on_earth(id.latitude_rad, id.longitude_rad)) id.latitude_rad = id.longitude_rad = kUnknown;
  if (id.name.empty() && !known(id.latitude_rad)) return std::nullopt;
  return id;
}

bool HeardBeacon::is(int of_sensor, const BeaconId& other) const {
  if (sensor != of_sensor || id.name != other.name) return false;
  if (!id.name.empty()) return true;
  const geo::Geodetic place{id.latitude_rad, id.longitude_rad, 0.0};
  return geo::difference_N(place, {other.latitude_rad, other.longitude_rad, 0.0}).norm() < kApart_m;
}

Instruments::Instruments(const Setup& setup)
    : count(std::min<std::size_t>(setup.config.sensors.size(), kMaxSensors)) {
  for (std::size_t i = 0; i < count; ++i) {
    sensors[i].enabled = setup.config.sensors[i].enabled;
    if (setup.water_layer[i] >= 0) ++layer_count;
  }
}

Instrument& Instruments::behind(const Setup& setup, const Measurement& measurement) {
  const auto slot = static_cast<std::size_t>(measurement.sensor);
  const int layer = setup.water_layer[slot];
  if (is_of_water(measurement.sample) && layer >= 0) return water_layers[static_cast<std::size_t>(layer)];
  const std::optional<BeaconId> beacon = beacon_of(measurement.sample);
  return beacon ? behind(measurement.sensor, *beacon) : sensors[slot];
}

Instrument& Instruments::behind(int sensor, const BeaconId& beacon) {
  const auto begin = beacons.begin();
  const auto end = begin + static_cast<std::ptrdiff_t>(beacon_count);
  auto found = std::find_if(begin, end, [&](const HeardBeacon& one) { return one.is(sensor, beacon); });
  if (found == end) {
    if (beacon_count < beacons.size()) {
      ++beacon_count;
    } else {
      found = std::min_element(begin, end, [](const HeardBeacon& a, const HeardBeacon& b) {
        return a.instrument.stamp_ns < b.instrument.stamp_ns;
      });
    }
    *found = {.sensor = sensor, .id = {}, .instrument = {}};
  }
  found->id = beacon;
  return found->instrument;
}

int Instruments::beacon(const Instrument& one) const {
  for (std::size_t i = 0; i < beacon_count; ++i)
    if (&beacons[i].instrument == &one) return static_cast<int>(i);
  return 0;
}

double Instruments::noise_factor(const Setup& setup, int sensor) const {
  const auto slot = static_cast<std::size_t>(sensor);
  double out = sensors[slot].noise.largest_factor();
  if (const int layer = setup.water_layer[slot]; layer >= 0)
    out = std::max(out, water_layers[static_cast<std::size_t>(layer)].noise.largest_factor());
  for (const HeardBeacon& one : beacons)
    if (one.sensor == sensor) out = std::max(out, one.instrument.noise.largest_factor());
  return out;
}

void Instrument::note_innovation(double now) {
  if (!repeats && std::isfinite(now)) normalised_square += kForgets * (now - normalised_square);
}

bool Instrument::is_frozen(const std::array<double, 3>& now, const Eigen::Vector3d& prediction, double limit,
                           const Eigen::Vector3d& travelled_N_m, double way_m) {
  repeats = same(now, reading);
  if (!repeats) {
    reading = now;
    first_prediction = prediction;
    first_travelled_N_m = travelled_N_m;
    return false;
  }
  const bool noisy = normalised_square > kLeastNoise;
  return (prediction - first_prediction).norm() > limit ||
         (noisy && (travelled_N_m - first_travelled_N_m).norm() > way_m);
}

}  // namespace fathom::estimation
