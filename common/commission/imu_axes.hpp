#pragma once

#include <vector>

#include <Eigen/Core>

#include "commission/assumed.hpp"
#include "commission/finding.hpp"
#include "commission/fit/dvl_fit.hpp"
#include "commission/fit/strapdown.hpp"
#include "commission/gps_check.hpp"

namespace fathom::commission {

/// Axes, signs and units of gyro and accelerometer, from what GPS, DVL and compass say of the motion.
struct ImuAxes {
  Findings findings;
  ImuReading reading;  ///< how the recording has to be read
  bool wrong = false;
};

/// What the test works on: the spans in which the vehicle turned and accelerated most.
struct Evidence {
  std::vector<Span> gps;
  std::vector<Span> dvl;
  std::vector<Span> rest;
  double gps_latency_s = 0.0;
  double dvl_latency_s = 0.0;
};

[[nodiscard]] ImuAxes check_imu_axes(const Series& series, const Assumed& assumed, const GpsCheck& gps,
                                     const Evidence& evidence);

/// The latency between -1.5 and 1.5 s that leaves the least squares, on a grid of 0.1 s.
[[nodiscard]] double scan_gps_latency(const Series& series, const GpsCheck& gps,
                                      const std::vector<Span>& windows, const ImuReading& reading);
[[nodiscard]] double scan_dvl_latency(const Series& series, const std::vector<Span>& windows,
                                      const ImuReading& reading);

}  // namespace fathom::commission
