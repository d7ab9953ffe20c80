#include "estimation/alignment/moving_start.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

namespace fathom::estimation {
namespace {

using Eigen::Matrix3d;
using Eigen::RowVector3d;
using Eigen::Vector3d;

constexpr double kLeastFelt_m_s2 = 1.0;
/// The horizontal part of the forward axis: a vehicle that points within 15 degrees of the vertical has no
/// heading to speak of.
constexpr double kLeastForward = 0.26;
/// How much of a turn about the force is a turn of the heading.
constexpr double kLeastYaw = 0.2;

/// Attitude of the start axes: the force points along `up_N`, and this axis has this heading.
std::optional<Matrix3d> attitude(const Vector3d& up_start, const Vector3d& up_N, const Vector3d& axis_start,
                                 double heading_rad) {
  const Matrix3d c = geo::to_matrix(geo::turn_between(up_start, up_N));
  const Vector3d w = c * axis_start;
  const Vector3d along = up_N * up_N.dot(w);
  const Vector3d across = w - along;
  const Vector3d third = geo::cross(up_N, w);
  const Vector3d side(-std::sin(heading_rad), std::cos(heading_rad), 0.0);
  const Vector3d ahead(std::cos(heading_rad), std::sin(heading_rad), 0.0);
  const double a = side.dot(across);
  const double b = side.dot(third);
  const double length = std::hypot(a, b);
  const double needed = -side.dot(along);
  if (!(std::abs(needed) < length)) return std::nullopt;
  const double middle = std::atan2(b, a);
  const double half = std::acos(needed / length);
  std::optional<Matrix3d> best;
  double most = kLeastForward;
  for (const double angle : {middle + half, middle - half}) {
    const Matrix3d turned = Eigen::AngleAxisd(angle, up_N).toRotationMatrix() * c;
    const double forward = ahead.dot(turned * axis_start);
    if (forward <= most) continue;
    most = forward;
    best = turned;
  }
  return best;
}

Vector3d antenna(const VelocityMark& mark, const Matrix3d& C_NS, const Vector3d& lever_B_m) {
  return C_NS * (geo::to_matrix(mark.span.q_start_now) * geo::cross(mark.rate_B_rad_s, lever_B_m));
}

}  // namespace

std::optional<MovingStart> start_moving(const VelocityWindow& window, const MovingStartInputs& in) {
  const VelocityMark& first = window.first();
  const VelocityMark& last = window.last();
  const double t_s = last.span.duration_s;
  const Vector3d felt = last.span.dv_m_s / t_s;
  if (!felt.allFinite() || felt.norm() < kLeastFelt_m_s2) return std::nullopt;
  const Matrix3d C_S_now = geo::to_matrix(window.now().q_start_now);
  const Matrix3d C_S_last = geo::to_matrix(last.span.q_start_now);
  const Vector3d forward_start = in.heading_rad ? Vector3d(C_S_now.col(0)) : C_S_last * in.course_axis_B;

  // The antenna's velocity about the inertial unit depends on the attitude: twice is enough.
  Matrix3d C_NS = Matrix3d::Identity();
  Vector3d v_first = first.v_N_m_s;
  Vector3d v_last = last.v_N_m_s;
  Vector3d up_N_m_s2;
  for (int round = 0; round < 3; ++round) {
    up_N_m_s2 = (v_last - v_first) / t_s - in.gravity_N_m_s2;
    if (!up_N_m_s2.allFinite() || up_N_m_s2.norm() < kLeastFelt_m_s2) return std::nullopt;
    const double heading = in.heading_rad.value_or(std::atan2(v_last.y(), v_last.x()));
    const auto found = attitude(felt.normalized(), up_N_m_s2.normalized(), forward_start, heading);
    if (!found) return std::nullopt;
    C_NS = *found;
    v_first = first.v_N_m_s - antenna(first, C_NS, in.lever_B_m);
    v_last = last.v_N_m_s - antenna(last, C_NS, in.lever_B_m);
  }

  MovingStart out;
  const Matrix3d C_NB = C_NS * C_S_now;
  out.q_NB = geo::normalized(geo::from_matrix(C_NB));
  const double since_s = window.now().duration_s - t_s;
  out.v_N_m_s = v_last + C_NS * (window.now().dv_m_s - last.span.dv_m_s) + since_s * in.gravity_N_m_s2;

  // Velocities that do not lie on the way between them are worse than they say.
  Vector3d variance = last.sigma_m_s.cwiseAbs2();
  Vector3d first_variance = first.sigma_m_s.cwiseAbs2();
  if (const VelocityMark* middle = window.middle()) {
    const Vector3d v_middle = middle->v_N_m_s - antenna(*middle, C_NS, in.lever_B_m);
    const double share = middle->span.duration_s / t_s;
    const Vector3d way = C_NS * (middle->span.dv_m_s - share * last.span.dv_m_s);
    const Vector3d off = v_middle - ((1.0 - share) * v_first + share * v_last + way);
    const double parts = 1.0 + share * share + (1.0 - share) * (1.0 - share);
    const Vector3d more = (off.cwiseAbs2() / parts - 4.0 * variance).cwiseMax(0.0);
    variance += more;
    first_variance += more;
  }

  // How a wrong velocity, force, bias and heading turn the attitude.
  const Matrix3d level = geo::skew(up_N_m_s2) / up_N_m_s2.squaredNorm();
  const Vector3d up = up_N_m_s2.normalized();
  const Vector3d x = C_NB.col(0);
  const double rho2 = x.x() * x.x() + x.y() * x.y();
  const RowVector3d yaw(-x.x() * x.z() / rho2, -x.y() * x.z() / rho2, 1.0);
  const double yaw_by_turn = yaw * up;
  if (std::abs(yaw_by_turn) < kLeastYaw) return std::nullopt;
  const Matrix3d keep = Matrix3d::Identity() - up * yaw / yaw_by_turn;
  out.by_accel_bias = keep * level * C_NS * last.span.by_accel_bias / t_s;
  out.by_gyro_bias =
      keep * (level * C_NS * last.span.dv_by_gyro_bias / t_s - C_NS * window.now().turn_by_bias);
  Matrix3d by_last = -keep * level / t_s;
  const Matrix3d by_first = -by_last;
  const Vector3d by_heading = -up / yaw_by_turn;
  const bool joint = in.joint_course && !in.heading_rad;
  if (joint) {
    // A velocity that is wrong across the course turns it.
    const double speed2 = v_last.head<2>().squaredNorm();
    by_last += by_heading * RowVector3d(-v_last.y() / speed2, v_last.x() / speed2, 0.0);
  }

  // The force must be as long as it was felt.
  const double strange = std::abs(felt.norm() - up_N_m_s2.norm());
  const double explained = std::hypot(in.force_sigma_m_s2, in.accel_bias_sigma_m_s2,
                                      std::sqrt((variance + first_variance).maxCoeff()) / t_s);
  const double unexplained = std::max(0.0, strange - 3.0 * explained);
  const double force_variance = in.force_sigma_m_s2 * in.force_sigma_m_s2 + unexplained * unexplained;

  double heading_variance = in.heading_sigma_rad * in.heading_sigma_rad;
  if (!in.heading_rad && !joint)
    heading_variance += variance.head<2>().maxCoeff() / v_last.head<2>().squaredNorm();
  const Matrix3d tilting = keep * level;
  out.P_vv = variance.asDiagonal();
  // v true = v found - e where the last velocity is wrong by e.
  out.P_vp = -(variance.asDiagonal() * by_last.transpose());
  const Matrix3d by_velocities =
      joint ? Matrix3d(by_last * variance.asDiagonal() * by_last.transpose() +
                       by_first * first_variance.asDiagonal() * by_first.transpose())
            : Matrix3d(by_last * (variance + first_variance).asDiagonal() * by_last.transpose());
  out.P_pp = by_velocities + force_variance * tilting * tilting.transpose() +
             heading_variance * by_heading * by_heading.transpose();
  out.by_heading = by_heading;
  out.mean_force_B_m_s2 = C_S_now.transpose() * felt;
  out.mean_rate_B_rad_s = geo::log(last.span.q_start_now) / t_s;
  return out;
}

}  // namespace fathom::estimation
