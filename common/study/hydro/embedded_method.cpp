#include "study/hydro/embedded_method.hpp"

#include <optional>

#include <Eigen/LU>

#include "geo/so3.hpp"
#include "geo/wgs84.hpp"
#include "study/baselines/embedded_filter.hpp"

namespace fathom::study::hydro {
namespace {

using estimation::hydro::Controls;

estimation::NavSolution start_of(const Run& run) {
  estimation::NavSolution nav;
  nav.position = {run.start.latitude_rad, run.start.longitude_rad, run.start.altitude_m};
  nav.v_N_m_s = geo::vec(run.start.velocity_N_m_s);
  nav.q_NB = geo::from_rpy(geo::vec(run.start.rpy_rad));
  return nav;
}

/// Plays the measurements: inertial intervals and depths to the navigator, one filter step each tenth of a
/// second with the newest controls and the DVL of that tenth.
template <class Inertial, class Depth, class Step, class Second>
void play(const Run& run, const Inertial& inertial, const Depth& slave, const Step& step,
          const Second& second) {
  TimeNs depth_ns = 0;
  Controls controls{run.coefficients.propulsor_rpm, 0.0, 0.0};
  std::optional<DvlSample> dvl;
  std::uint64_t intervals = 0;
  std::size_t seconds = 0;
  for (const sim::Measurement& measurement : run.measurements) {
    if (const auto* imu = std::get_if<ImuSample>(&measurement)) {
      inertial(geo::vec(imu->delta_angle_B_rad), geo::vec(imu->delta_velocity_B_m_s), imu->delta_time_s);
      if (++intervals % 10 == 0) {
        step(controls, dvl);
        dvl.reset();
      }
      if (intervals % 100 == 0 && ++seconds < run.truth.size()) second(run.truth[seconds], seconds);
    } else if (const auto* sample = std::get_if<DepthSample>(&measurement)) {
      if (depth_ns != 0) slave(sample->depth_m, to_seconds(sample->header.stamp_ns - depth_ns));
      depth_ns = sample->header.stamp_ns;
    } else if (const auto* shaft = std::get_if<PropulsionSample>(&measurement)) {
      controls.rpm = shaft->rpm;
    } else if (const auto* fins = std::get_if<FinsSample>(&measurement)) {
      controls.rudder_rad = fins->rudder_rad;
      controls.stern_rad = fins->stern_rad;
    } else if (const auto* velocity = std::get_if<DvlSample>(&measurement)) {
      dvl = *velocity;
    }
  }
}

ErrorPoint error_of(const estimation::NavSolution& nav, const Truth& truth, std::size_t second) {
  const Eigen::Vector3d d =
      geo::difference_N({truth.latitude_rad, truth.longitude_rad, truth.altitude_m}, nav.position);
  return {static_cast<double>(second), d.x(), d.y(), kUnknown};
}

template <int N>
std::vector<ErrorPoint> run_embedded(const Run& run) {
  EmbeddedFilterConfig config;
  config.velocity_m_s = run.start.velocity_sigma_N_m_s[0];
  config.position_m = run.start.position_sigma_N_m[0];
  config.tilt_rad = run.start.attitude_sigma_rad[0];
  config.heading_rad = run.start.attitude_sigma_rad[2];
  // The printed filter keeps the printed noise; the other is told what the instrument is.
  if constexpr (N == kLinkedStates) config.dvl_m_s = dvl_equivalent_sigma_m_s();
  EmbeddedFilter<N> filter(run.coefficients, config);
  filter.start(start_of(run), 0.0);
  std::vector<ErrorPoint> out;
  play(
      run, [&](const auto& dtheta, const auto& dv, double dt_s) { filter.advance(dtheta, dv, dt_s); },
      [&](double depth_m, double dt_s) { filter.slave(depth_m, dt_s); },
      [&](const Controls& controls, const std::optional<DvlSample>& dvl) { filter.step(controls, dvl); },
      [&](const Truth& truth, std::size_t second) {
        ErrorPoint point = error_of(filter.nav(), truth, second);
        using namespace estimation::hydro;
        const Eigen::Matrix2d p = filter.filter().P.template block<2, 2>(kPosition, kPosition);
        const Eigen::Vector2d e(point.north_m, point.east_m);
        point.nees = e.dot(p.inverse() * e);
        out.push_back(point);
      });
  return out;
}

}  // namespace

std::vector<ErrorPoint> run_ins(const Run& run) {
  SlavedNavigator navigator;
  navigator.start(start_of(run), 0.0);
  std::vector<ErrorPoint> out;
  play(
      run, [&](const auto& dtheta, const auto& dv, double dt_s) { navigator.advance(dtheta, dv, dt_s); },
      [&](double depth_m, double dt_s) { navigator.slave(depth_m, dt_s); },
      [](const Controls&, const std::optional<DvlSample>&) {},
      [&](const Truth& truth, std::size_t second) {
        out.push_back(error_of(navigator.nav(), truth, second));
      });
  return out;
}

std::vector<ErrorPoint> run_printed(const Run& run) {
  return run_embedded<kPrintedStates>(run);
}

std::vector<ErrorPoint> run_linked(const Run& run) {
  return run_embedded<kLinkedStates>(run);
}

}  // namespace fathom::study::hydro
