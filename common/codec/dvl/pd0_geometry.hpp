#pragma once

#include "codec/dvl/pd0_ensemble.hpp"
#include "samples/dvl.hpp"

namespace fathom::codec::pd0 {

/// Fills velocity, error velocity, beam velocities and sigma of `sample` from a velocity as recorded; the
/// conventions are those of make_pd0.
void set_velocity(DvlSample& sample, const Ensemble& ensemble, const Velocity& velocity,
                  double heading_alignment_rad);

/// Velocity along the outward direction of each beam of a downward-looking convex DVL from a
/// forward-right-down velocity in its own axes: the inverse of the Janus transformation.
[[nodiscard]] std::array<double, 4> beams_from_frd(const std::array<double, 3>& v_D_m_s,
                                                   double beam_angle_rad);

/// East-north-up from starboard-forward-mast, with heading, pitch as a pendulum records it, and roll.
/// Row-major; its transpose is its inverse.
[[nodiscard]] std::array<double, 9> earth_from_ship(double heading_rad, double recorded_pitch_rad,
                                                    double roll_rad);

}  // namespace fathom::codec::pd0
