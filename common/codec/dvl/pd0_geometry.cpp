#include "codec/dvl/pd0_geometry.hpp"

#include <cmath>

namespace fathom::codec::pd0 {
namespace {

/// X, Y, Z and error in instrument axes from beam velocities towards the transducer. X runs from beam 1 to
/// beam 2, Y from beam 4 to beam 3, Z towards the transducer.
std::array<double, 4> janus(std::array<double, 4> b, double angle_rad, bool convex) {
  const double across = (convex ? 1.0 : -1.0) / (2.0 * std::sin(angle_rad));
  const double along = 1.0 / (2.0 * std::cos(angle_rad));
  int missing = 0;
  std::size_t which = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    if (known(b[i])) continue;
    ++missing;
    which = i;
  }
  std::array<double, 4> v{kUnknown, kUnknown, kUnknown, kUnknown};
  if (missing == 0) {
    v[3] = (b[0] + b[1] - b[2] - b[3]) * std::abs(across) / std::sqrt(2.0);
  } else if (missing == 1) {
    // Both pairs measure the same vertical velocity: b1 + b2 = b3 + b4.
    const bool first_pair = which < 2;
    const double other_pair = first_pair ? b[2] + b[3] : b[0] + b[1];
    b[which] = other_pair - b[which ^ 1U];
  }
  v[0] = (b[0] - b[1]) * across;
  v[1] = (b[3] - b[2]) * across;
  const double z12 = (b[0] + b[1]) * along;
  const double z34 = (b[2] + b[3]) * along;
  v[2] = known(z12) && known(z34) ? 0.5 * (z12 + z34) : known(z12) ? z12 : z34;
  return v;
}

}  // namespace

std::array<double, 4> beams_from_frd(const std::array<double, 3>& v_D_m_s, double beam_angle_rad) {
  const double s = std::sin(beam_angle_rad);
  const double c = std::cos(beam_angle_rad);
  const auto [forward, right, down] = v_D_m_s;
  return {-s * right + c * down, s * right + c * down, s * forward + c * down, -s * forward + c * down};
}

std::array<double, 9> earth_from_ship(double heading_rad, double recorded_pitch_rad, double roll_rad) {
  const double pitch = std::atan(std::tan(recorded_pitch_rad) * std::cos(roll_rad));
  const double ch = std::cos(heading_rad);
  const double sh = std::sin(heading_rad);
  const double cp = std::cos(pitch);
  const double sp = std::sin(pitch);
  const double cr = std::cos(roll_rad);
  const double sr = std::sin(roll_rad);
  return {ch * cr + sh * sp * sr,
          sh * cp,
          ch * sr - sh * sp * cr,  // east
          -sh * cr + ch * sp * sr,
          ch * cp,
          -sh * sr - ch * sp * cr,  // north
          -cp * sr,
          sp,
          cp * cr};  // up
}

void set_velocity(DvlSample& sample, const Ensemble& ensemble, const Velocity& velocity,
                  double heading_alignment_rad) {
  std::array<double, 4> v = velocity.recorded_m_s;
  if (ensemble.frame == DvlFrame::beam) {
    sample.beam_velocity_m_s = v;
    v = janus(v, ensemble.beam_angle_rad, ensemble.convex);
  }
  std::array<double, 3> ship{v[0], v[1], v[2]};  // starboard, forward, up
  if (ensemble.frame == DvlFrame::earth) {
    const bool tilts = ensemble.tilts_used;
    const auto R = earth_from_ship(ensemble.heading_rad, tilts ? ensemble.pitch_rad : 0.0,
                                   tilts ? ensemble.roll_rad : 0.0);
    for (std::size_t i = 0; i < 3; ++i) ship[i] = R[i] * v[0] + R[3 + i] * v[1] + R[6 + i] * v[2];
  } else if (ensemble.frame != DvlFrame::ship && ensemble.upward) {
    ship[0] = -ship[0];
    ship[2] = -ship[2];
  }
  double forward = -ship[1];
  double right = -ship[0];
  const double down = ship[2];
  const bool own_axes = ensemble.frame == DvlFrame::beam || ensemble.frame == DvlFrame::instrument;
  if (own_axes && heading_alignment_rad != 0.0) {
    const double c = std::cos(heading_alignment_rad);
    const double s = std::sin(heading_alignment_rad);
    const double beam3 = forward;
    forward = c * beam3 - s * right;
    right = s * beam3 + c * right;
  }
  sample.velocity_D_m_s = {forward, right, down};
  sample.error_velocity_m_s = v[3];
  // One axis then rests on 2 b_k - (b_i + b_j) in place of b_k - b_l: variance 6 to 2.
  const bool three_beams = known(v[0]) && known(v[1]) && known(v[2]) && !known(v[3]);
  sample.sigma_m_s = three_beams ? std::sqrt(3.0) * velocity.sigma_m_s : velocity.sigma_m_s;
}

}  // namespace fathom::codec::pd0
