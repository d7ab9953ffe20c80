#include "cli/bench/vehicle.hpp"

#include <cmath>

#include "geo/so3.hpp"
#include "geo/wgs84.hpp"

namespace fathom::cli {
namespace {

constexpr TimeNs kEpochNs = 1'700'000'000 * kNsPerSecond;
constexpr double kHeading_rad = 0.5;
constexpr geo::Geodetic kStart{0.6, 0.2, -20.0};

const Eigen::Vector3d& velocity_N() {
  static const Eigen::Vector3d v(2.0 * std::cos(kHeading_rad), 2.0 * std::sin(kHeading_rad), 0.0);
  return v;
}

}  // namespace

BenchVehicle::BenchVehicle(const std::string& configuration, double imu_rate_hz)
    : rate_hz_(imu_rate_hz), now_ns_(kEpochNs) {
  (void)estimation::named_state_groups(configuration, config_.groups);
  config_.configuration = configuration;
  config_.imu.nominal_rate_hz = imu_rate_hz;
  config_.sensors = {estimation::default_sensor(SourceKind::gps, "gps0"),
                     estimation::default_sensor(SourceKind::dvl, "dvl0"),
                     estimation::default_sensor(SourceKind::depth, "depth0"),
                     estimation::default_sensor(SourceKind::heading, "compass0")};
  carry_transponder();
  const geo::LocalEarth earth(kStart);
  const Eigen::Matrix3d c = geo::to_matrix(geo::from_rpy({0.0, 0.0, kHeading_rad}));
  const Eigen::Vector3d transport = earth.transport_rate_N(velocity_N());
  rate_B_rad_s_ = geo::arr(c.transpose() * (earth.earth_rate_N + transport));
  force_B_m_s2_ = geo::arr(
      c.transpose() * (geo::cross(2.0 * earth.earth_rate_N + transport, velocity_N()) - earth.gravity_N()));
}

estimation::InitialState BenchVehicle::start() const {
  estimation::InitialState state;
  state.latitude_rad = kStart.latitude_rad;
  state.longitude_rad = kStart.longitude_rad;
  state.altitude_m = kStart.altitude_m;
  state.velocity_N_m_s = geo::arr(velocity_N());
  state.rpy_rad = {0.0, 0.0, kHeading_rad};
  return state;
}

SampleHeader BenchVehicle::header(const char* sensor, TimeNs stamp_ns) const {
  SampleHeader out;
  out.vehicle = std::string_view(config_.vehicle);
  out.sensor = sensor;
  out.stamp_ns = stamp_ns;
  out.received_ns = now_ns_;
  out.sequence = static_cast<std::uint64_t>(stamp_ns - kEpochNs);
  return out;
}

bool BenchVehicle::every(double rate_hz) const {
  return step_ % std::llround(rate_hz_ / rate_hz) == 0;
}

geo::Geodetic BenchVehicle::position(TimeNs stamp_ns) {
  return geo::moved_by(kStart, to_seconds(stamp_ns - kEpochNs) * velocity_N());
}

void BenchVehicle::step(std::vector<Sample>& out) {
  out.clear();
  now_ns_ = kEpochNs + step_ * from_seconds(1.0 / rate_hz_);
  ImuSample imu;
  imu.header = header("imu", now_ns_);
  imu.angular_rate_B_rad_s = rate_B_rad_s_;
  imu.specific_force_B_m_s2 = force_B_m_s2_;
  out.emplace_back(imu);
  // A ripple instead of noise, so that no reading repeats.
  const double ripple = std::sin(0.7 * static_cast<double>(step_));
  if (step_ > 0 && every(2.0)) {
    GpsSample gps;
    gps.header = header("gps0", now_ns_ - 105'000'000);
    const geo::Geodetic at = position(gps.header.stamp_ns);
    gps.fix = GpsFix::fix_3d;
    gps.latitude_rad = at.latitude_rad;
    gps.longitude_rad = at.longitude_rad;
    gps.altitude_m = at.altitude_m + 0.1 * ripple;
    gps.velocity_N_m_s = geo::arr(velocity_N());
    out.emplace_back(gps);
  }
  if (step_ > 0 && every(5.0)) {
    DvlSample dvl;
    dvl.header = header("dvl0", now_ns_ - 83'000'000);
    dvl.velocity_D_m_s = {2.0 + 0.01 * ripple, 0.0, 0.0};
    out.emplace_back(dvl);
  }
  if (step_ > 0 && every(10.0)) {
    DepthSample depth;
    depth.header = header("depth0", now_ns_ - 42'000'000);
    depth.depth_m = 20.0 + 0.01 * ripple;
    out.emplace_back(depth);
    HeadingSample heading;
    heading.header = header("compass0", now_ns_ - 42'000'000);
    heading.heading_rad = kHeading_rad + 0.005 * ripple;
    out.emplace_back(heading);
  }
  ++step_;
}

estimation::Navigator settled(const estimation::Setup& setup, const BenchVehicle& vehicle) {
  estimation::Navigator navigator(setup);
  navigator.start(vehicle.start(), kNsPerSecond);
  estimation::ImuStep step;
  step.increments.dt_s = 0.01;
  for (int k = 0; k < 3000; ++k) {
    step.from_ns = navigator.now_ns();
    step.to_ns = step.from_ns + 10'000'000;
    step.increments.dtheta_rad = {1e-4, 2e-4, 2e-3};
    step.increments.dv_m_s = {1e-3, -2e-3, -0.098};
    step.increments.dtheta_before_rad = step.increments.dtheta_rad;
    step.increments.dv_before_m_s = step.increments.dv_m_s;
    navigator.advance(step, step.to_ns);
    navigator.finish(step);
  }
  return navigator;
}

}  // namespace fathom::cli
