#include "study/consistency/cell_run.hpp"

#include <numbers>

#include "sim/random.hpp"

namespace fathom::study {
namespace {

ecef::Geodetic draw_place(const Cell& cell, std::uint64_t seed) {
  sim::Random random(seed, "place");
  const double latitude = (cell.latitude_deg + random.uniform(-1.0, 1.0)) * std::numbers::pi / 180.0;
  const double longitude = random.uniform(-3.0, 3.0);
  return {latitude, longitude, cell.height_m};
}

}  // namespace

CellRun::CellRun(const Cell& cell, std::uint64_t seed)
    : cell_(&cell),
      manoeuvres_(cell.motion(seed)),
      path_(manoeuvres_, draw_place(cell, seed)),
      imu_(*cell.inertial, seed),
      gps_(cell.gps, seed),
      dvl_(cell.dvl, seed),
      depth_(kDepthGauge, kSurfaceHeight_m, seed),
      compass_(kCompass, seed),
      dt_s_(1.0 / cell.imu_rate_hz),
      gps_beat_(cell.imu_rate_hz, cell.gps.rate_hz),
      dvl_beat_(cell.imu_rate_hz, cell.dvl.rate_hz),
      depth_beat_(cell.imu_rate_hz, kDepthGauge.rate_hz),
      compass_beat_(cell.imu_rate_hz, kCompass.rate_hz) {}

}  // namespace fathom::study
