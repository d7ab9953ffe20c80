#pragma once

#include <algorithm>
#include <cmath>
#include <string_view>

#include "base/time.hpp"
#include "study/consistency/cells.hpp"
#include "study/consistency/instruments.hpp"

namespace fathom::study {

/// When an instrument with a rate of its own speaks, in inertial steps.
class Beat {
 public:
  Beat(double imu_rate_hz, double rate_hz)
      : every_(std::max(1L, std::lround(imu_rate_hz / rate_hz))), period_s_(every_ / imu_rate_hz) {}
  [[nodiscard]] bool strikes(long step) const { return step % every_ == 0; }
  [[nodiscard]] double period_s() const { return period_s_; }

 private:
  long every_;
  double period_s_;
};

/// One drawn run of a cell: the truth, and what its instruments say of it. Same cell and seed, same samples.
class CellRun {
 public:
  CellRun(const Cell& cell, std::uint64_t seed);
  CellRun(const CellRun&) = delete;  // the path follows its manoeuvres
  CellRun& operator=(const CellRun&) = delete;

  [[nodiscard]] double time_s() const { return path_.time_s(); }
  [[nodiscard]] Pose pose() const { return path_.pose(); }

  /// Carries the vehicle on by one inertial interval and hands `take` the samples of its end, the inertial
  /// one last.
  template <class Take>
  void step(Take&& take) {
    ImuSample inertial = imu_.read(path_.advance(dt_s_), dt_s_);
    const TimeNs stamp_ns = kEpoch_ns + from_seconds(static_cast<double>(step_ + 1) * dt_s_);
    const auto hand_out = [&](auto sample, std::string_view sensor) {
      sample.header.vehicle = std::string_view("auv");
      sample.header.sensor = sensor;
      sample.header.stamp_ns = sample.header.received_ns = stamp_ns;
      sample.header.sequence = static_cast<std::uint64_t>(step_ + 1);
      take(sample);
    };
    if (gps_beat_.strikes(step_) && path_.time_s() < cell_->outage_from_s)
      hand_out(gps_.read(path_.pose(), gps_beat_.period_s()), "gps");
    if (cell_->under_water && dvl_beat_.strikes(step_)) hand_out(dvl_.read(path_.pose()), "dvl");
    if (cell_->under_water && depth_beat_.strikes(step_)) hand_out(depth_.read(path_.pose()), "depth");
    if (compass_beat_.strikes(step_)) hand_out(compass_.read(path_.pose()), "heading");
    hand_out(inertial, "imu");
    ++step_;
  }

 private:
  static constexpr TimeNs kEpoch_ns = 1'700'000'000 * kNsPerSecond;

  const Cell* cell_;
  Manoeuvres manoeuvres_;
  TruthPath path_;
  InertialUnit imu_;
  GpsReceiver gps_;
  DopplerLog dvl_;
  DepthGauge depth_;
  Compass compass_;
  double dt_s_;
  Beat gps_beat_;
  Beat dvl_beat_;
  Beat depth_beat_;
  Beat compass_beat_;
  long step_ = 0;
};

}  // namespace fathom::study
