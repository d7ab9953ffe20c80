#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "base/time.hpp"
#include "base/unknown.hpp"
#include "config/fusion/fusion_config.hpp"
#include "geo/so3.hpp"
#include "geo/wgs84.hpp"
#include "samples/gps.hpp"
#include "samples/nav_state.hpp"

namespace fathom::cli {

/// How a fix is compared with navigation states: where the antenna is and when the fix was valid.
struct Antenna {
  std::array<double, 3> from_output_B_m{0, 0, 0};
  double latency_s = 0.0;  ///< its stamp less this is its instant
};
/// Of the first configured GPS receiver; `found_latency_s` is what the filter found beyond the configuration.
/// A tenth of a second is metres at the speed of a car, more than any of the errors to be told.
[[nodiscard]] Antenna antenna_of(const config::FusionConfig& config, double found_latency_s);

/// Where a vehicle was, from its navigation states in the order of time.
class Path {
 public:
  /// Room for so many states, for the sake of speed.
  void reserve(std::size_t count) { poses_.reserve(count); }
  /// States without a position leave a gap.
  void add(const NavState& state);
  /// Horizontal distance of the antenna from a fix at the fix's own instant, m; unknown where no two states
  /// enclose that within a second.
  [[nodiscard]] double error_m(const GpsSample& fix, const Antenna& antenna) const;

 private:
  struct Pose {
    TimeNs stamp_ns = 0;
    geo::Geodetic position;
    geo::Quaternion q_NB;
  };
  std::vector<Pose> poses_;
};

/// Horizontal errors gathered; rms over all.
struct FixErrors {
  std::size_t count = 0;
  double sum2_m2 = 0.0;

  void add(double error_m);
  void add(const FixErrors& other);
  [[nodiscard]] double rms_m() const;
};

}  // namespace fathom::cli
