#include "estimation/alignment/motion_level.hpp"

#include <cmath>

#include "base/unknown.hpp"
#include "estimation/alignment/rest_window.hpp"
#include "geo/so3.hpp"

namespace fathom::estimation {
namespace {

// cos(1 degree): nearer to the vertical the sine is too flat to be inverted.
constexpr double kSteepest = 0.99984769515639124;
constexpr double kLeastForce_m_s2 = 1.0;

MotionLevel refuse(LevelFault fault) {
  return {kUnknown, kUnknown, fault};
}

}  // namespace

std::string_view to_string(LevelFault fault) {
  switch (fault) {
    case LevelFault::none:
      return "none";
    case LevelFault::not_finite:
      return "not_finite";
    case LevelFault::forward_force:
      return "forward_force";
    case LevelFault::side_force:
      return "side_force";
    case LevelFault::no_gravity:
      break;
  }
  return "no_gravity";
}

MotionLevel level_printed(const Eigen::Vector3d& f, double rate_z_rad_s, double speed_m_s, double g_m_s2) {
  // (ALN-9)
  if (!f.allFinite() || !std::isfinite(rate_z_rad_s * speed_m_s) || !(g_m_s2 > 0.0))
    return refuse(LevelFault::not_finite);
  if (std::abs(f.x()) >= g_m_s2 * kSteepest) return refuse(LevelFault::forward_force);
  const double pitch = std::asin(f.x() / g_m_s2);
  const double sine = (-f.y() + rate_z_rad_s * speed_m_s) / (g_m_s2 * std::cos(pitch));
  if (std::abs(sine) > 1.0) return refuse(LevelFault::side_force);
  return {std::asin(sine), pitch, LevelFault::none};
}

MotionLevel level_in_motion(const Eigen::Vector3d& f, const Eigen::Vector3d& v_dot,
                            const Eigen::Vector3d& omega, const Eigen::Vector3d& v) {
  // (ALN-10)
  const Eigen::Vector3d still = f - v_dot - geo::cross(omega, v);
  if (!still.allFinite()) return refuse(LevelFault::not_finite);
  if (still.norm() < kLeastForce_m_s2) return refuse(LevelFault::no_gravity);
  const Eigen::Vector2d tilt = level(still);
  return {tilt.x(), tilt.y(), LevelFault::none};
}

}  // namespace fathom::estimation
