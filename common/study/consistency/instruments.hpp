#pragma once

#include "samples/depth.hpp"
#include "samples/dvl.hpp"
#include "samples/gps.hpp"
#include "samples/heading.hpp"
#include "samples/imu.hpp"
#include "sim/random.hpp"
#include "study/consistency/figures.hpp"
#include "study/consistency/truth_path.hpp"

/// What the instruments of one run say of the truth. Each has a stream of random numbers of its own.
namespace fathom::study {

class InertialUnit {
 public:
  InertialUnit(const ImuGrade& grade, std::uint64_t seed);
  [[nodiscard]] ImuSample read(const PerfectIncrements& truth, double dt_s);

 private:
  struct Triad {
    Eigen::Vector3d bias;
    Eigen::Matrix3d shape;  ///< identity, scale and misalignment
    std::array<sim::GaussMarkov, 3> in_run;
    double walk;
  };
  [[nodiscard]] Triad draw(double bias, double in_run, double scale, double misalignment, double walk,
                           double in_run_s);
  [[nodiscard]] Eigen::Vector3d distort(Triad& triad, const Eigen::Vector3d& increment, double dt_s);

  sim::Random random_;
  Triad gyro_;
  Triad accelerometer_;
  Eigen::Matrix3d g_sensitivity_;
};

class GpsReceiver {
 public:
  GpsReceiver(const GpsFigures& figures, std::uint64_t seed);
  [[nodiscard]] GpsSample read(const Pose& pose, double dt_s);

 private:
  GpsFigures figures_;
  sim::Random random_;
  std::array<sim::GaussMarkov, 3> drift_;
};

class DopplerLog {
 public:
  DopplerLog(const DvlFigures& figures, std::uint64_t seed);
  [[nodiscard]] DvlSample read(const Pose& pose);

 private:
  DvlFigures figures_;
  sim::Random random_;
  double scale_;
  Eigen::Matrix3d axes_DB_;
  Eigen::Vector3d bias_D_m_s_;
};

class DepthGauge {
 public:
  DepthGauge(const DepthFigures& figures, double surface_height_m, std::uint64_t seed);
  [[nodiscard]] DepthSample read(const Pose& pose);

 private:
  DepthFigures figures_;
  double surface_height_m_;
  sim::Random random_;
  double bias_m_;
};

class Compass {
 public:
  Compass(const CompassFigures& figures, std::uint64_t seed);
  [[nodiscard]] HeadingSample read(const Pose& pose);

 private:
  CompassFigures figures_;
  sim::Random random_;
  double bias_rad_;
};

}  // namespace fathom::study
