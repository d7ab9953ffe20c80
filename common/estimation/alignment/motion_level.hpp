#pragma once

#include <cstdint>
#include <string_view>

#include <Eigen/Core>

namespace fathom::estimation {

/// Why a roll and pitch could not be computed. Nothing is ever clamped into the domain of a formula: a
/// specific force outside it is no gravity seen from a tilted vehicle.
enum class LevelFault : std::uint8_t {
  none = 0,
  not_finite = 1,
  forward_force = 2,  ///< |f_x| so near to g that pitch means nothing
  side_force = 3,     ///< roll would need a sine above one
  no_gravity = 4,     ///< hardly any force is left after the motion is taken off
};
[[nodiscard]] std::string_view to_string(LevelFault fault);

/// Roll and pitch, rad; unknown (NaN) with a fault.
struct MotionLevel {
  double roll_rad;
  double pitch_rad;
  LevelFault fault;
};

/// As printed (ALN-9): right for a steady run along the x axis at |roll| < 90 degrees. Specific force and
/// turn rate along B, `speed_m_s` along x through the water, `g_m_s2` plumb gravity.
[[nodiscard]] MotionLevel level_printed(const Eigen::Vector3d& force_B_m_s2, double rate_z_rad_s,
                                        double speed_m_s, double g_m_s2);

/// Free of those limits (ALN-10): the acceleration of the vehicle, `v_dot_B + omega x v`, is taken off the
/// specific force and what is left points up. All vectors along B.
[[nodiscard]] MotionLevel level_in_motion(const Eigen::Vector3d& force_B_m_s2,
                                          const Eigen::Vector3d& velocity_dot_B_m_s2,
                                          const Eigen::Vector3d& rate_B_rad_s,
                                          const Eigen::Vector3d& velocity_B_m_s);

}  // namespace fathom::estimation
