// Where a start is: by GPS, an order or the configuration, else by acoustic fixes.
#include <algorithm>
#include <cmath>

#include "estimation/navigator/start/correlate.hpp"
#include "estimation/navigator/start/starter.hpp"

namespace fathom::estimation {
namespace {

using Eigen::Vector3d;

/// A fix that is so much older than the next one says nothing of it.
constexpr double kPairOfFixes_s = 60.0;
/// Two fixes that are further apart for their noise are not both right.
constexpr double kSameFix_sigmas = 3.0;

}  // namespace

std::optional<StartPlace> Starter::place(const StartInputs& in) const {
  using By = StartPlace::By;
  const EngineConfig& config = in.setup.config;
  const AlignmentConfig& alignment = config.alignment;
  const Vector3d output_lever_B_m = geo::vec(config.output_lever_B_m);
  if (const double age_s = in.estimate.since(gps_seen_ns_); age_s <= kFreshFix_s)
    return StartPlace{By::gps, gps_position_, lever_of_gps_B_m(in.setup), gps_sigma_N_m_, age_s};
  if (in.ordered.is_set)
    return StartPlace{By::order, in.ordered.position, output_lever_B_m,
                      Vector3d::Constant(in.ordered.sigma_m)};
  if (alignment.position_given)
    return StartPlace{
        By::configuration,
        {alignment.given_latitude_rad, alignment.given_longitude_rad, alignment.given_altitude_m},
        output_lever_B_m,
        Vector3d::Constant(alignment.position_sigma_m)};
  const double age_s = in.estimate.since(under_way_.usbl_ns);
  if (!under_way_.usbl_agrees || !(age_s <= kFreshFix_s)) return std::nullopt;
  // (ALN-21)
  const double sigma_m = std::max(under_way_.usbl_sigma_m, alignment.position_sigma_m);
  return StartPlace{By::acoustics,
                    {under_way_.usbl_latitude_rad, under_way_.usbl_longitude_rad,
                     config.states.surface_altitude_m - under_way_.usbl_depth_m},
                    under_way_.usbl_lever_B_m,
                    Vector3d::Constant(sigma_m),
                    age_s};
}

void Starter::begin(const StartInputs& in, const StartPlace& place, const FilterState& state,
                    std::array<double, kMaxStates> sigma, Estimate& estimate) const {
  const Setup& setup = in.setup;
  const bool from_usbl = place.by == StartPlace::By::acoustics;
  FilterState start = state;
  // The position is that of the antenna or of the point set; the IMU lies a lever away from it.
  start.nav.position = geo::moved_by(start.nav.position, -(geo::to_matrix(start.nav.q_NB) * place.lever_B_m));
  Vector3d position_sigma = place.sigma_N_m;
  if (from_usbl) {
    const double horizontal = std::hypot(position_sigma.x(), place.age_s * sigma[3]);
    position_sigma = {horizontal, horizontal,
                      std::hypot(horizontal, setup.config.states.surface_altitude_sigma_m)};
  }
  for (int i = 0; i < 3; ++i) sigma[static_cast<std::size_t>(i)] = position_sigma(i);
  const int surface = setup.index.of(Group::surface_altitude);
  if (surface >= 0) {
    // On the surface, unless an acoustic fix has just said how deep below it.
    start.x[static_cast<std::size_t>(surface)] =
        from_usbl ? setup.config.states.surface_altitude_m : start.nav.position.altitude_m;
  }
  estimate.begin(start, sigma);
  if (from_usbl) correlate_usbl(setup, under_way_.usbl_turned_N_m, estimate.filter);
  const int bias = setup.index.of(Group::gps_position_bias);
  if (place.by == StartPlace::By::gps && bias >= 0) {
    // (ALN-7): a position taken from GPS carries the whole of its slow error.
    for (int i = 0; i < 3; ++i) {
      const double variance = estimate.filter(bias + i, bias + i);
      estimate.filter.widen(i, variance);
      estimate.filter.set(i, bias + i, variance);
    }
  }
}

bool Starter::agrees(const Setup& setup, const Estimate& estimate, const geo::Geodetic& place,
                     double sigma_m) const {
  // (ALN-21)
  const double apart_s = estimate.since(under_way_.usbl_ns);
  if (!(apart_s <= kPairOfFixes_s)) return false;
  const bool dvl = estimate.since(under_way_.dvl_ns) <= kFreshVelocity_s;
  const double speed_m_s =
      std::max(setup.config.alignment.max_speed_m_s, dvl ? under_way_.dvl_velocity_B_m_s.norm() : 0.0);
  const geo::Geodetic before{under_way_.usbl_latitude_rad, under_way_.usbl_longitude_rad, place.altitude_m};
  return geo::difference_N(before, place).head<2>().norm() <=
         kSameFix_sigmas * std::hypot(sigma_m, under_way_.usbl_sigma_m) + speed_m_s * apart_s;
}

}  // namespace fathom::estimation
