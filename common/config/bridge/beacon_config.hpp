#pragma once

#include <string>
#include <utility>
#include <vector>

#include "codec/registry.hpp"

namespace fathom::config {

/// A beacon that answers, and where it is.
struct BeaconConfig {
  std::string address;
  double latitude_rad = 0.0;
  double longitude_rad = 0.0;
  double depth_m = 0.0;
};

/// What is wrong with a list of them: the key and what is expected; nothing where all is well.
[[nodiscard]] std::pair<std::string, std::string> wrong_beacons(const std::vector<BeaconConfig>& beacons);
/// As a codec is told them, with the speed of sound that it has by itself.
[[nodiscard]] codec::BeaconOptions beacon_options(const std::vector<BeaconConfig>& beacons);

}  // namespace fathom::config
