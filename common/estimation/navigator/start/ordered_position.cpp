#include "estimation/navigator/start/ordered_position.hpp"

#include <cmath>

#include "samples/departure.hpp"

namespace fathom::estimation {
namespace {

geo::Geodetic wanted_by(const Command& command, const Setup& setup, const Estimate& estimate) {
  geo::Geodetic wanted = estimate.state.nav.position;
  wanted.latitude_rad = command.latitude_rad;
  wanted.longitude_rad = command.longitude_rad;
  const int at = setup.index.of(Group::surface_altitude);
  const double surface_m =
      at < 0 ? setup.config.states.surface_altitude_m : estimate.state.x[static_cast<std::size_t>(at)];
  if (known(command.depth_m)) wanted.altitude_m = surface_m - command.depth_m;
  return wanted;
}

}  // namespace

void OrderedPosition::keep(const Estimate& estimate, const Command& command) {
  is_set = true;
  set_ns = estimate.now_ns;
  position = {command.latitude_rad, command.longitude_rad, 0.0};
  depth_m = command.depth_m;
  sigma_m = command.sigma_m;
}

OrderedPosition::Step OrderedPosition::propose(const Setup& setup, const Estimate& estimate,
                                               const Command& command) {
  Step out;
  const geo::Geodetic& here = estimate.state.nav.position;
  const ErrorFilter& filter = estimate.filter;
  out.judgement.kind = VerdictKind::used;
  const Eigen::Matrix3d c = geo::to_matrix(estimate.state.nav.q_NB);
  out.wanted =
      geo::moved_by(wanted_by(command, setup, estimate), -(c * geo::vec(setup.config.output_lever_B_m)));
  if (!known(command.depth_m)) out.wanted.altitude_m = here.altitude_m;
  out.axes = known(command.depth_m) ? 3 : 2;
  out.step_N_m = geo::difference_N(here, out.wanted);
  Judgement& judgement = out.judgement;
  judgement.dimensions = 2;
  judgement.limit = allowed_departure_m(filter(0, 0), filter(1, 1), command.sigma_m);
  for (int i = 0; i < 2; ++i) {
    const auto axis = static_cast<std::size_t>(i);
    judgement.innovation[axis] = out.step_N_m[i];
    judgement.innovation_sigma[axis] = std::sqrt(filter(i, i) + command.sigma_m * command.sigma_m);
  }
  judgement.test_ratio = out.step_N_m.head<2>().norm() / judgement.limit;
  const geo::Geodetic ordered{command.latitude_rad, command.longitude_rad, 0.0};
  if (judgement.test_ratio > 1.0 && !is_confirmed(estimate, command, ordered)) {
    held_ns = estimate.now_ns;
    held_position = ordered;
    judgement.kind = VerdictKind::rejected;
    return out;
  }
  held_ns = 0;
  return out;
}

bool OrderedPosition::is_confirmed(const Estimate& estimate, const Command& command,
                                   const geo::Geodetic& ordered) const {
  constexpr double kTimeToConfirm_s = 60.0;
  constexpr double kSamePlace_m = 1.0;  // written with fewer digits
  return command.confirmed && held_ns != 0 && estimate.since(held_ns) <= kTimeToConfirm_s &&
         geo::difference_N(held_position, ordered).head<2>().norm() <= kSamePlace_m;
}

}  // namespace fathom::estimation
