#pragma once

#include <functional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "base/units.hpp"
#include "geo/wgs84.hpp"
#include "unit/commission/vehicle.hpp"

namespace fathom::test {

/// A mistake as people make it, and what has to be said of it: a finding of `sensor` named `what`, with these
/// words in its sentence.
struct Sabotage {
  std::string name;
  std::function<void(dataset::Dataset&)> commit;
  std::string sensor, what, words;
};

/// 12 mistakes and some relatives; a data set without the instrument is left as it was.
inline std::vector<Sabotage> sabotages() {
  using Eigen::Matrix3d;
  const Matrix3d one = Matrix3d::Identity();
  Matrix3d swapped = Matrix3d::Zero();
  swapped(0, 1) = swapped(1, 0) = swapped(2, 2) = 1.0;
  Matrix3d mirror = one;
  mirror(1, 1) = -1.0;
  const Matrix3d turned = Eigen::AngleAxisd(45.0 * kRadPerDeg, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  return {
      {"accelerometer negated", [=](auto& d) { through(d, one, -one); }, "imu", "accelerometer_axes",
       "all three axes are negated"},
      {"gyro negated", [=](auto& d) { through(d, -one, one); }, "imu", "gyro_axes",
       "all three axes are negated"},
      {"gyro x and y swapped", [=](auto& d) { through(d, swapped, one); }, "imu", "gyro_axes",
       "x and y are exchanged"},
      {"gyro in deg/s", [=](auto& d) { through(d, one / kRadPerDeg, one); }, "imu", "gyro_unit", "deg/s"},
      {"accelerometer in g", [=](auto& d) { through(d, one, one / 9.80665); }, "imu", "accelerometer_unit",
       "gravity in g"},
      {"dvl rotated 45 deg", [=](auto& d) { dvl_through(d, turned.transpose()); }, "dvl", "mounting_yaw",
       "turned by 4"},
      {"dvl mirrored", [=](auto& d) { dvl_through(d, mirror); }, "dvl", "mirror", "y is negated"},
      {"dvl in mm/s", [=](auto& d) { dvl_through(d, 1000.0 * one); }, "dvl", "unit", "mm/s"},
      {"depth in bar",
       [](auto& d) {
         for (auto& sample : d.template of<DepthSample>()) sample.depth_m *= 0.0993;
       },
       "depth", "unit", "bar"},
      {"compass magnetic for true",
       [](auto& d) {
         for (auto& sample : d.template of<HeadingSample>())
           sample.heading_rad = geo::wrap_two_pi(sample.heading_rad + 8.5 * kRadPerDeg);
       },
       "heading", "offset", "magnetic"},
      {"gps velocity east north up",
       [](auto& d) {
         for (auto& sample : d.template of<GpsSample>())
           sample.velocity_N_m_s = {sample.velocity_N_m_s[1], sample.velocity_N_m_s[0],
                                    -sample.velocity_N_m_s[2]};
       },
       "gps", "velocity_axes", "east, north, up"},
      {"imu 10 % fast",
       [](auto& d) {
         auto& imu = d.template of<ImuSample>();
         const TimeNs first = imu.front().header.stamp_ns;
         for (auto& sample : imu) {
           sample.header.stamp_ns = first + (sample.header.stamp_ns - first) * 10 / 11;
           sample.header.received_ns = sample.header.stamp_ns;
         }
       },
       "imu", "rate", "10.0 % off"},
      {"dvl stamped 0.5 s late", [](auto& d) { stamp_late<DvlSample>(d, 0.5); }, "dvl", "latency", "s late"},
  };
}

}  // namespace fathom::test
