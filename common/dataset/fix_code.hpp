#pragma once

#include <cmath>
#include <optional>

#include "samples/gps.hpp"

namespace fathom::dataset {

/// The `fix` column: 0 for none, else the quality numbers of post-processing tools (1 best). Recordings also
/// use it for a count of satellites, so that every number from 5 on is taken as an ordinary fix, and so is a
/// blank. Nothing for what is not a whole number from 0 to 99.
[[nodiscard]] inline std::optional<GpsFix> fix_from_code(double code) {
  if (std::isnan(code)) return GpsFix::fix_3d;
  if (code == 0.0) return GpsFix::none;
  if (code == 1.0) return GpsFix::rtk_fixed;
  if (code == 2.0) return GpsFix::rtk_float;
  if (code == 3.0 || code == 4.0) return GpsFix::differential;
  if (code >= 5.0 && code <= 99.0 && code == std::floor(code)) return GpsFix::fix_3d;
  return std::nullopt;
}

[[nodiscard]] inline int code_from_fix(GpsFix fix) {
  switch (fix) {
    case GpsFix::rtk_fixed:
      return 1;
    case GpsFix::rtk_float:
      return 2;
    case GpsFix::differential:
      return 4;
    case GpsFix::fix_3d:
    case GpsFix::fix_2d:
      return 5;
    case GpsFix::none:
    case GpsFix::time_only:
    case GpsFix::dead_reckoning:
      return 0;
  }
  return 0;
}

}  // namespace fathom::dataset
