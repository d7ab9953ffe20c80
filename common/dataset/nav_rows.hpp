#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <string>

#include "base/time.hpp"
#include "base/unknown.hpp"

namespace fathom::dataset {

/// A row of nav.csv as NavCsv writes it. Angles are radians here.
struct NavRow {
  DurationNs t_ns = 0;
  double latitude_rad = kUnknown;
  double longitude_rad = kUnknown;
  double altitude_m = kUnknown;
  std::array<double, 3> velocity_N_m_s{kUnknown, kUnknown, kUnknown};
  std::array<double, 3> rpy_rad{kUnknown, kUnknown, kUnknown};
  std::array<double, 3> position_sigma_N_m{kUnknown, kUnknown, kUnknown};
  std::array<double, 3> velocity_sigma_N_m_s{kUnknown, kUnknown, kUnknown};
  std::array<double, 3> rpy_sigma_rad{kUnknown, kUnknown, kUnknown};
  std::string mode;  ///< "gps_aided", ...
};

/// Calls `consumer` with each row, plain or .gz. Required are t_s, lat_deg, lon_deg, alt_m; what else is
/// missing stays unknown. Throws DatasetError with file and line, also where t_s goes back.
void read_nav_rows(const std::filesystem::path& path, const std::function<void(const NavRow&)>& consumer);

}  // namespace fathom::dataset
