#pragma once

#include <vector>

#include <Eigen/Core>

#include "commission/fit/dvl_fit.hpp"
#include "commission/fit/gps_fit.hpp"
#include "commission/fit/strapdown.hpp"

namespace fathom::commission {

/// What the joint fit begins with.
struct JointStart {
  ImuReading reading;
  GpsFit gps;                     ///< its attitude of an instant has to be known
  double rate_noise = 0;          ///< rad/sqrt(s)
  double force_noise = 0;         ///< (m/s)/sqrt(s)
  double rate_bias_sigma = 0.01;  ///< rad/s: of that of the reading
  double gps_sigma_m_s = 0.1;
  bool with_dvl = false;
  DvlFigures dvl;
};

/// GPS and DVL against one motion of the whole log.
struct JointFit {
  bool done = false;
  GpsFit gps;            ///< lever and latency, with their sigmas
  DvlFigures dvl;        ///< done: with it
  VectorSeries rpy_rad;  ///< roll, pitch and unwrapped yaw of the body, ten times a second
  double yaw_sigma_rad = 0.0;
  ScalarSeries sunk_m;  ///< way down of the inertial unit since the start; empty where nothing measures it
};

/// Levers, latencies, mounting and scale by a Kalman filter that has them in its state, besides attitude,
/// velocity, biases, scales and misalignments of the inertial unit, over the whole log at once: a window of
/// its own has to find its own gravity, the log has one. Relinearised until nothing moves. The noise of GPS
/// and DVL is that of the innovations; sigmas are stretched by what successive innovations have in common.
/// Precondition: velocity_N has rows, gps.attitude is set.
[[nodiscard]] JointFit fit_joint(const Series& series, const GpsVelocity& velocity_N,
                                 const JointStart& start);

}  // namespace fathom::commission
