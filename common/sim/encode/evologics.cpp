#include "sim/encode/evologics.hpp"

#include <array>
#include <cmath>

#include "sim/encode/decimal.hpp"

namespace fathom::sim::encode {
namespace {

std::string seconds(DurationNs time) {
  return decimal(to_seconds(time), 6);
}

std::string three(const std::array<double, 3>& r_m) {
  return decimal(r_m[0], 4) + "," + decimal(r_m[1], 4) + "," + decimal(r_m[2], 4) + ",";
}

std::array<double, 3> components(const UsblSample& sample) {
  if (known(sample.relative_m[0])) return sample.relative_m;
  const double level_m = sample.range_m * std::cos(sample.depression_rad);
  return {level_m * std::cos(sample.bearing_rad), level_m * std::sin(sample.bearing_rad),
          sample.range_m * std::sin(sample.depression_rad)};
}

}  // namespace

std::string evologics_line(std::string_view text) {
  return "+++AT:" + std::to_string(text.size()) + ":" + std::string(text) + "\r\n";
}

std::string evologics(const UsblSample& sample, DurationNs measured, DurationNs sent) {
  const bool carried = sample.frame == UsblFrame::vehicle_frd;
  if (!carried && sample.frame != UsblFrame::ned) return {};
  const auto [x, y, down] = components(sample);
  if (!known(x) || !known(y) || !known(down)) return {};
  // Forward, left, up of the vehicle; east, north, up.
  const std::array<double, 3> place_m = carried ? std::array{x, -y, -down} : std::array{y, x, -down};
  const double across_m =
      known(sample.sigma_rad) && known(sample.range_m) ? sample.sigma_rad * sample.range_m : 0.0;
  const double accuracy_m = known(sample.sigma_m) ? std::hypot(sample.sigma_m, across_m) : 0.0;
  const double travel_us = known(sample.travel_time_s) ? 1e6 * sample.travel_time_s : 0.0;
  return evologics_line("USBLLONG," + seconds(sent) + "," + seconds(measured) + "," +
                        sample.transponder.str() + "," + three(place_m) + three(place_m) +
                        "0.0000,0.0000,0.0000," + decimal(travel_us, 0) + ",-40,180," +
                        decimal(accuracy_m, 4));
}

}  // namespace fathom::sim::encode
