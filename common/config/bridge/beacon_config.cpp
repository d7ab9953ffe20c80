#include "config/bridge/beacon_config.hpp"

#include <set>
#include <string_view>

#include "config/bridge/bridge_schema.hpp"

namespace fathom::config {

void describe(Schema<BeaconConfig>& s) {
  using C = BeaconConfig;
  s.field("address", &C::address,
          "as the instrument tells it: the number of a modem, A to D of a transponder")
      .required();
  s.field("latitude_deg", &C::latitude_rad, "where it is")
      .unit("deg")
      .range(-90, 90)
      .scaled(kRadPerDeg)
      .required();
  s.field("longitude_deg", &C::longitude_rad, "where it is")
      .unit("deg")
      .range(-180, 180)
      .scaled(kRadPerDeg)
      .required();
  s.field("depth_m", &C::depth_m, "below the surface").unit("m").range(-100, 12'000).required();
  s.check([](const C& beacon) -> std::pair<std::string, std::string> {
    if (beacon.address.empty() || beacon.address.size() > Name::kCapacity)
      return {"address", "1 to 31 characters"};
    return {};
  });
}

std::pair<std::string, std::string> wrong_beacons(const std::vector<BeaconConfig>& beacons) {
  if (beacons.size() > codec::BeaconOptions::kMost) return {"beacons", "at most 16 beacons"};
  std::set<std::string> addresses;
  for (const BeaconConfig& beacon : beacons) {
    if (!addresses.insert(beacon.address).second)
      return {"beacons", "different addresses, but \"" + beacon.address + "\" comes twice"};
  }
  return {};
}

codec::BeaconOptions beacon_options(const std::vector<BeaconConfig>& beacons) {
  codec::BeaconOptions out;
  for (const BeaconConfig& one : beacons) {
    if (out.count < codec::BeaconOptions::kMost)
      out.list[out.count++] = {std::string_view(one.address), one.latitude_rad, one.longitude_rad,
                               one.depth_m};
  }
  return out;
}

}  // namespace fathom::config
