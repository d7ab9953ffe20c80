// Where a start is: by GPS, an order or the configuration, by acoustic fixes, or where it was seen last.
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
  const double gps_age_s = in.estimate.since(gps_seen_ns_);
  if (gps_age_s <= kFreshFix_s)
    return StartPlace{StartPlace::By::gps, gps_position_, gps_lever_B_m_, gps_sigma_N_m_, gps_age_s};
  if (in.ordered.is_set) return ordered_place(in);
  const bool seen = gps_seen_ns_ != 0 || last_.seen_ns != 0;
  if (in.setup.config.alignment.position_given && !seen && !out_of_sight_) return given_place(in);
  if (under_way_.usbl_agrees && in.estimate.since(under_way_.usbl_ns) <= kFreshFix_s)
    return acoustic_place(in);
  if (seen) return remembered_place(in);
  return std::nullopt;
}

StartPlace Starter::ordered_place(const StartInputs& in) const {
  const EngineConfig& config = in.setup.config;
  const OrderedPosition& ordered = in.ordered;
  const bool navigated = last_.seen_ns != 0;
  const double drifted_m = config.alignment.max_speed_m_s * in.estimate.since(ordered.set_ns);
  StartPlace out;
  out.by = StartPlace::By::order;
  out.position = ordered.position;
  out.lever_B_m = geo::vec(config.output_lever_B_m);
  out.sigma_N_m.setConstant(std::hypot(ordered.sigma_m, drifted_m));
  out.surface_altitude_m = navigated ? last_.surface_altitude_m : config.states.surface_altitude_m;
  out.surface_sigma_m = navigated ? last_.surface_sigma_m : config.states.surface_altitude_sigma_m;
  const auto heard_m = heard_depth_m(in.estimate);
  if (heard_m || known(ordered.depth_m) || !navigated) {
    out.position.altitude_m =
        out.surface_altitude_m - (known(ordered.depth_m) ? ordered.depth_m : heard_m.value_or(0.0));
    out.sigma_N_m.z() = std::hypot(out.sigma_N_m.z(), out.surface_sigma_m);
  } else {
    const StartPlace seen = remembered_place(in);
    out.position.altitude_m = seen.position.altitude_m;
    out.sigma_N_m.z() = seen.sigma_N_m.z();
  }
  return out;
}

StartPlace Starter::given_place(const StartInputs& in) const {
  const AlignmentConfig& config = in.setup.config.alignment;
  StartPlace out;
  out.by = StartPlace::By::configuration;
  out.position = {config.given_latitude_rad, config.given_longitude_rad, config.given_altitude_m};
  out.lever_B_m = geo::vec(in.setup.config.output_lever_B_m);
  out.sigma_N_m.setConstant(config.position_sigma_m);
  if (const auto depth_m = heard_depth_m(in.estimate))
    out.surface_altitude_m = config.given_altitude_m + *depth_m;
  return out;
}

StartPlace Starter::acoustic_place(const StartInputs& in) const {
  // (ALN-21)
  const EngineConfig& config = in.setup.config;
  StartPlace out;
  out.by = StartPlace::By::acoustics;
  out.surface_altitude_m = config.states.surface_altitude_m;
  out.position = {under_way_.usbl_latitude_rad, under_way_.usbl_longitude_rad,
                  out.surface_altitude_m - under_way_.usbl_depth_m};
  out.lever_B_m = under_way_.usbl_lever_B_m;
  out.sigma_N_m.setConstant(std::max(under_way_.usbl_sigma_m, config.alignment.position_sigma_m));
  out.age_s = in.estimate.since(under_way_.usbl_ns);
  return out;
}

StartPlace Starter::remembered_place(const StartInputs& in) const {
  // (ALN-22)
  const bool by_gps = gps_seen_ns_ > last_.seen_ns;
  const double slow_m_s = in.setup.config.alignment.max_speed_m_s;
  StartPlace out;
  out.by = StartPlace::By::memory;
  double speed_m_s = slow_m_s;
  if (by_gps) {
    out.position = gps_position_;
    out.lever_B_m = gps_lever_B_m_;
    out.sigma_N_m = gps_sigma_N_m_;
    if (known(gps_speed_m_s_)) speed_m_s = std::max(slow_m_s, gps_speed_m_s_);
    out.surface_altitude_m = gps_position_.altitude_m;
  } else {
    out.position = last_.position;
    out.sigma_N_m = last_.sigma_N_m;
    speed_m_s = std::max(slow_m_s, last_.speed_m_s);
    out.surface_altitude_m = last_.surface_altitude_m;
    out.surface_sigma_m = last_.surface_sigma_m;
  }
  const double moved_m = speed_m_s * in.estimate.since(by_gps ? gps_seen_ns_ : last_.seen_ns);
  for (int i = 0; i < 3; ++i) out.sigma_N_m(i) = std::hypot(out.sigma_N_m(i), moved_m);
  return out;
}

std::optional<double> Starter::heard_depth_m(const Estimate& estimate) const {
  if (!(estimate.since(under_way_.depth_ns) <= kFreshFix_s)) return std::nullopt;
  return under_way_.depth_m;
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
    start.x[static_cast<std::size_t>(surface)] =
        known(place.surface_altitude_m) ? place.surface_altitude_m : start.nav.position.altitude_m;
    if (known(place.surface_sigma_m)) sigma[static_cast<std::size_t>(surface)] = place.surface_sigma_m;
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
