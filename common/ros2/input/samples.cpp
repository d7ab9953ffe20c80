#include "ros2/input/samples.hpp"

#include <cmath>

#include "base/units.hpp"
#include "codec/depth/pressure.hpp"
#include "geo/so3.hpp"
#include "geo/wgs84.hpp"
#include "ros2/frames/convention.hpp"

namespace fathom::ros2 {
namespace {

bool finite(const Vector3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

std::string number(double value) {
  return std::to_string(value);
}

std::string text_of(const Vector3& v) {
  return "(" + number(v.x) + ", " + number(v.y) + ", " + number(v.z) + ")";
}

/// What says that there is no such measurement.
bool is_absent(const Covariance3& covariance) {
  return covariance[0] == -1.0;
}

Eigen::Vector3d in_frd(const Vector3& v, Axes axes) {
  const Eigen::Vector3d given = eigen(v);
  return axes == Axes::flu ? Eigen::Vector3d(R_FB(Convention::enu_flu) * given) : given;
}

/// One sigma for all components: the root of the mean variance. NaN where none is known; nothing where one
/// cannot be a variance.
std::optional<double> mean_sigma(double xx, double yy, double zz) {
  double sum = 0.0;
  int known_ones = 0;
  for (const double variance : {xx, yy, zz}) {
    const auto sigma = sigma_of(variance);
    if (!sigma) return std::nullopt;
    if (!known(*sigma)) continue;
    sum += variance;
    ++known_ones;
  }
  return known_ones == 0 ? kUnknown : std::sqrt(sum / known_ones);
}

std::string no_variance(const char* what, double xx, double yy, double zz) {
  return std::string(what) + " has the variances " + text_of({xx, yy, zz}) +
         ", expected none below 0 but -1 for one that is not known";
}

}  // namespace

Entry<ImuSample> imu_sample(const Imu& message, const SampleHeader& header, const ImuRule& rule) {
  if (is_absent(message.angular_velocity_covariance) || is_absent(message.linear_acceleration_covariance)) {
    const bool rate = is_absent(message.angular_velocity_covariance);
    return {Refusal::missing, std::string(rate ? "angular_velocity" : "linear_acceleration") +
                                  "_covariance says that there is none (-1), expected both triads"};
  }
  if (!finite(message.angular_velocity)) {
    return {Refusal::value,
            "angular_velocity is " + text_of(message.angular_velocity) + ", expected finite rad/s"};
  }
  if (!finite(message.linear_acceleration)) {
    return {Refusal::value,
            "linear_acceleration is " + text_of(message.linear_acceleration) + ", expected finite m/s^2"};
  }
  const Eigen::Matrix3d R_BS = matrix3(rule.R_BS);
  ImuSample out;
  out.header = header;
  out.angular_rate_B_rad_s = geo::arr(R_BS * eigen(message.angular_velocity));
  out.specific_force_B_m_s2 = geo::arr(R_BS * eigen(message.linear_acceleration));
  return out;
}

Entry<GpsSample> gps_sample(const NavSatFix& message, const SampleHeader& header) {
  GpsSample out;
  out.header = header;
  if (message.status.status < NavSatStatus::kFix) return out;
  out.fix = message.status.status == NavSatStatus::kFix ? GpsFix::fix_3d : GpsFix::differential;
  const bool on_earth =
      std::abs(message.latitude) <= 90.0 && message.longitude >= -180.0 && message.longitude <= 360.0;
  if (!on_earth) {
    return {Refusal::value, "latitude and longitude are " + number(message.latitude) + " and " +
                                number(message.longitude) + " deg, expected -90 to 90 and -180 to 360"};
  }
  if (std::isinf(message.altitude)) return {Refusal::value, "altitude is infinite, expected m or NaN"};
  out.latitude_rad = message.latitude * kRadPerDeg;
  out.longitude_rad = geo::wrap_pi(message.longitude * kRadPerDeg);
  out.altitude_m = message.altitude;
  if (message.position_covariance_type == NavSatFix::kUnknownCovariance) return out;
  const Covariance3& c = message.position_covariance;
  const auto east = sigma_of(c[0]);
  const auto north = sigma_of(c[4]);
  const auto up = sigma_of(c[8]);
  if (!east || !north || !up)
    return {Refusal::covariance, no_variance("position_covariance", c[0], c[4], c[8])};
  out.position_sigma_N_m = {*north, *east, *up};
  return out;
}

Entry<DepthSample> depth_sample(const FluidPressure& message, const SampleHeader& header,
                                const PressureRule& rule) {
  // Twice what is at the bottom of the deepest trench.
  constexpr double kMost_Pa = 2.2e8;
  const double pressure_Pa = message.fluid_pressure;
  if (!std::isfinite(pressure_Pa) || std::abs(pressure_Pa) > kMost_Pa ||
      (rule.atmosphere_Pa > 0.0 && pressure_Pa <= 0.0)) {
    return {Refusal::value,
            "fluid_pressure is " + number(pressure_Pa) + ", expected Pa above 0, at most 2.2e8"};
  }
  const auto sigma_Pa = sigma_of(message.variance);
  if (!sigma_Pa) {
    return {Refusal::covariance, "variance is " + number(message.variance) + ", expected 0 or more, or -1"};
  }
  DepthSample out;
  out.header = header;
  out.pressure_Pa = rule.atmosphere_Pa > 0.0 ? pressure_Pa : pressure_Pa + 101'325.0;
  const double gauge_Pa = pressure_Pa - rule.atmosphere_Pa;
  out.depth_m = codec::depth_from_pressure(gauge_Pa, rule.latitude_rad);
  if (known(*sigma_Pa)) {
    constexpr double kStep_Pa = 1000.0;
    const double slope_m_Pa =
        (codec::depth_from_pressure(gauge_Pa + kStep_Pa, rule.latitude_rad) - out.depth_m) / kStep_Pa;
    out.sigma_m = slope_m_Pa * *sigma_Pa;
  }
  return out;
}

Entry<DvlSample> dvl_sample(const Dvl& message, const SampleHeader& header, const VelocityRule& rule) {
  constexpr int kBeamsNeeded = 3;
  DvlSample out;
  out.header = header;
  if (message.velocity_mode != Dvl::kBottom && message.velocity_mode != Dvl::kWater) {
    return {Refusal::value, "velocity_mode is " + std::to_string(message.velocity_mode) +
                                ", expected 1 (bottom) or 2 (water)"};
  }
  out.mode = message.velocity_mode == Dvl::kBottom ? DvlMode::bottom : DvlMode::water;
  const Covariance3& c = message.velocity_covar;
  const auto sigma = mean_sigma(c[0], c[4], c[8]);
  if (!sigma) return {Refusal::covariance, no_variance("velocity_covar", c[0], c[4], c[8])};
  out.sigma_m_s = *sigma;
  if (message.num_good_beams >= kBeamsNeeded) {
    if (!finite(message.velocity)) {
      return {Refusal::value, "velocity is " + text_of(message.velocity) + ", expected finite m/s"};
    }
    out.velocity_D_m_s = geo::arr(in_frd(message.velocity, rule.axes));
  }
  if (std::isfinite(message.altitude) && message.altitude > 0.0) out.altitude_m = message.altitude;
  if (std::isfinite(message.sound_speed) && message.sound_speed > 0.0F) {
    out.sound_speed_m_s = static_cast<double>(message.sound_speed);
  }
  for (std::size_t i = 0; message.beam_ranges_valid && i < out.beam_range_m.size(); ++i) {
    if (std::isfinite(message.range[i]) && message.range[i] > 0.0) out.beam_range_m[i] = message.range[i];
  }
  return out;
}

Entry<DvlSample> dvl_sample(const TwistWithCovarianceStamped& message, const SampleHeader& header,
                            const VelocityRule& rule) {
  const Vector3& linear = message.twist.twist.linear;
  if (!finite(linear))
    return {Refusal::value, "twist.linear is " + text_of(linear) + ", expected finite m/s"};
  const Eigen::Matrix3d c = linear_block(message.twist.covariance);
  const auto sigma = mean_sigma(c(0, 0), c(1, 1), c(2, 2));
  if (!sigma) return {Refusal::covariance, no_variance("twist.covariance", c(0, 0), c(1, 1), c(2, 2))};
  DvlSample out;
  out.header = header;
  out.mode = rule.mode;
  out.velocity_D_m_s = geo::arr(in_frd(linear, rule.axes));
  out.sigma_m_s = *sigma;
  return out;
}

Entry<FixSample> fix_sample(const PoseWithCovarianceStamped& message, const SampleHeader& header,
                            const PoseRule& rule) {
  // Metres along the meridian and the parallel mean little further away, and nobody sends a vehicle there.
  constexpr double kFarthest_m = 1e6;
  const Point& place = message.pose.pose.position;
  const Vector3 given{place.x, place.y, place.z};
  if (!finite(given) || std::hypot(place.x, place.y) > kFarthest_m) {
    return {Refusal::value,
            "position is " + text_of(given) + ", expected finite m within 1000 km of the origin"};
  }
  const Eigen::Matrix3d P_W = linear_block(message.pose.covariance);
  const double xx = P_W(0, 0);
  const double yy = P_W(1, 1);
  const double xy = P_W(0, 1);
  const double half_difference = std::hypot(0.5 * (xx - yy), xy);
  const double greatest_m2 = 0.5 * (xx + yy) + half_difference;
  if (!std::isfinite(greatest_m2) || xx <= 0.0 || yy <= 0.0 || xy * xy > xx * yy) {
    return {Refusal::covariance, "pose.covariance has x, y and xy " + text_of({xx, yy, xy}) +
                                     " m^2, expected a positive covariance: a fix counts by its sigma"};
  }
  const Eigen::Vector3d horizontal_W(place.x, place.y, 0.0);
  const geo::Geodetic at = geo::moved_by(rule.origin, R_WN(rule.convention) * horizontal_W);
  FixSample out;
  out.header = header;
  out.latitude_rad = at.latitude_rad;
  out.longitude_rad = geo::wrap_pi(at.longitude_rad);
  out.sigma_m = std::sqrt(greatest_m2);
  return out;
}

}  // namespace fathom::ros2
