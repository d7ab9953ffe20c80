#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "base/time.hpp"
#include "samples/truth.hpp"

namespace fathom::demo {

/// What a recorded vehicle's folder means for a demonstration.
struct Recording {
  std::vector<std::string> bridges;                  ///< instruments that were recorded, e.g. "imu", "dvl"
  std::map<std::string, double, std::less<>> rates;  ///< mean rates, by kind
  double imu_rate_hz = 100.0;
  double duration_s = 0.0;  ///< until shortly after the last sample
  double last_imu_s = 0.0;  ///< t_s of the last inertial sample
  double start_s = 0.0;     ///< t_s of `start`
  Truth start;              ///< reference at or after the first inertial sample
  std::filesystem::path fusion_file;
  double end_error_limit = 0.01;  ///< share of the distance travelled

  [[nodiscard]] bool has(std::string_view kind) const { return rates.count(kind) > 0; }
  [[nodiscard]] double rate_hz(std::string_view kind, double otherwise) const;
};

/// `fusion_file` empty: CONFIG/solve/NAME.json, NAME being that of the folder or of one above it; else the
/// fusion service's own file. Throws dataset::DatasetError when the folder has no inertial samples or no
/// reference.
[[nodiscard]] Recording describe_recording(const std::filesystem::path& directory,
                                           const std::filesystem::path& fusion_file,
                                           const std::filesystem::path& config_directory);

/// Overrides of the fusion service: start from the recording's reference, its t_s = 0 being `epoch_ns`.
[[nodiscard]] std::vector<std::string> start_sets(const Recording& recording, TimeNs epoch_ns);

}  // namespace fathom::demo
