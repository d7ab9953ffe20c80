#pragma once

#include <string>
#include <vector>

#include "base/time.hpp"
#include "dataset/dataset.hpp"
#include "samples/nav_state.hpp"

namespace fathom::cli {

/// What one vehicle of a recording measured and where it said that it was.
struct Recorded {
  dataset::Dataset data;              ///< of each kind one sensor, the one that is heard first
  std::vector<NavState> states;       ///< as published, by stamp
  TimeNs epoch_ns = 0;                ///< t_s = 0: the second of the first sample
  std::vector<std::string> left_out;  ///< other sensors, e.g. "gps1"
};

/// `vehicle`: empty: the one that is heard first. Damaged parts are named on standard error. Throws Failure
/// where there is nothing of it.
[[nodiscard]] Recorded read_recorded(const std::string& file, const std::string& vehicle);

/// A data set, nav.csv with the states, and import.json with the instant of t_s = 0. Throws
/// dataset::DatasetError.
void write_recorded(const std::string& folder, const Recorded& recorded);

/// import.json with the instant of t_s = 0. Throws Failure.
void write_epoch(const std::string& folder, TimeNs epoch_ns);

}  // namespace fathom::cli
