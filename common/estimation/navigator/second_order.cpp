// What a measurement sees beyond the first order, where attitude and velocity are known badly.
#include <algorithm>
#include <cmath>

#include "estimation/navigator/trial.hpp"
#include "geo/so3.hpp"

namespace fathom::estimation {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr int kVelocity = 3;  // where the states stand
constexpr int kAttitude = 6;
/// Of the variance of a row: one that would change by less stays as it is.
constexpr double kNoticed = 0.01;
/// How long a tilt that is not known stays the same.
constexpr double kMemory_s = 3.0;
constexpr double kSoonest_s = 0.01;  // between two headings

/// What the rows of a velocity along the vehicle see beyond the first order where attitude and velocity are
/// both uncertain (AID-DVL-4): its mean is taken off the innovation, its variance is noise. `velocity_N_m_s`
/// is the estimate of what they measure. A row whose variance would change by less than a hundredth stays as
/// it is.
void add_second_order_of_velocity(const ErrorFilter& filter, const Vector3d& velocity_N_m_s,
                                  Observation& observation) {
  // (AID-DVL-4)
  Eigen::Matrix<double, 6, 6> p;
  p << filter.block3(kAttitude, kAttitude), filter.block3(kAttitude, kVelocity),
      filter.block3(kVelocity, kAttitude), filter.block3(kVelocity, kVelocity);
  const double attitude_rad2 = p.diagonal().head<3>().maxCoeff();
  const double velocity_m2_s2 = p.diagonal().tail<3>().maxCoeff();
  const double bound_m2_s2 =
      attitude_rad2 * (velocity_m2_s2 + 0.5 * attitude_rad2 * velocity_N_m_s.squaredNorm());
  for (std::size_t i = 0; i < static_cast<std::size_t>(observation.rows); ++i) {
    const double noise_m2_s2 = observation.sigma[i] * observation.sigma[i];
    if (bound_m2_s2 < kNoticed * noise_m2_s2) continue;
    const auto& h = observation.h[i];
    const Vector3d row(h[kVelocity], h[kVelocity + 1], h[kVelocity + 2]);
    // Half of y' M y, y the errors of attitude and velocity.
    Eigen::Matrix<double, 6, 6> m = Eigen::Matrix<double, 6, 6>::Zero();
    const Matrix3d product = row * velocity_N_m_s.transpose();
    m.topLeftCorner<3, 3>() =
        row.dot(velocity_N_m_s) * Matrix3d::Identity() - 0.5 * (product + product.transpose());
    m.topRightCorner<3, 3>() = geo::skew(row);
    m.bottomLeftCorner<3, 3>() = -geo::skew(row);
    const Eigen::Matrix<double, 6, 6> mp = m * p;
    observation.innovation[i] -= 0.5 * mp.trace();
    observation.sigma[i] = std::sqrt(noise_m2_s2 + 0.5 * (mp * mp).trace());
  }
}

/// The same of the one row of a heading (AID-HDG-3), which turns with the roll of a vehicle that is pitched.
/// A tilt that stays does the same to every heading meanwhile: `again_s` is the time since the one before.
void add_second_order_of_heading(const ErrorFilter& filter, const Matrix3d& C_NB, double again_s,
                                 Observation& observation) {
  // (AID-HDG-3)
  const Vector3d ahead = C_NB.col(0);
  const double level = ahead.head<2>().norm();
  if (observation.rows != 1 || !(level > 0.0)) return;
  const Eigen::Vector2d along = ahead.head<2>() / level;
  const Eigen::Vector2d across(-along.y(), along.x());
  const Eigen::Matrix2d tilt = filter.block3(kAttitude, kAttitude).topLeftCorner<2, 2>();
  const double slope = ahead.z() / level;
  const double curve = 0.5 + slope * slope;
  const double both = across.dot(tilt * along);
  const double square = curve * curve * (along.dot(tilt * along) * across.dot(tilt * across) + both * both);
  const double noise_rad2 = observation.sigma[0] * observation.sigma[0];
  const double lasting = square * std::max(1.0, kMemory_s / std::max(again_s, kSoonest_s));
  if (lasting < kNoticed * noise_rad2) return;
  observation.innovation[0] += curve * both;
  observation.sigma[0] = std::sqrt(noise_rad2 + lasting);
}

}  // namespace

void Navigator::add_second_order(Trial& trial, const AidingState& state, double unused_s) const {
  const ErrorFilter& filter = estimate_.filter;
  if (trial.policy.doppler)
    add_second_order_of_velocity(filter, estimate_.velocity_N_m_s(*setup_, trial.policy.velocity),
                                 trial.whole);
  if (trial.policy.heading_alone) add_second_order_of_heading(filter, state.C_NB, unused_s, trial.whole);
}

}  // namespace fathom::estimation
