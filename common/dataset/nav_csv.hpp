#pragma once

#include <filesystem>

#include "base/time.hpp"
#include "dataset/csv_writer.hpp"
#include "samples/nav_state.hpp"

namespace fathom::dataset {

/// nav.csv: the columns of reference.csv, then sigma_{n,e,d}_m, sigma_v{n,e,d}_m_s,
/// sigma_{roll,pitch,yaw}_deg, mode, gps_outage_s, alignment. One row per navigation state. Decimals resolve
/// 1 um, 1 um/s and 1e-9 deg.
class NavCsv {
 public:
  /// Throws WriteError. `epoch_ns` is the instant of t_s = 0.
  NavCsv(const std::filesystem::path& path, TimeNs epoch_ns);
  void add(const NavState& state);
  void close() { csv_.close(); }

 private:
  CsvWriter csv_;
  TimeNs epoch_ns_;
};

}  // namespace fathom::dataset
