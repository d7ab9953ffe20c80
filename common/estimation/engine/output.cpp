#include "estimation/engine/output.hpp"

#include <algorithm>
#include <cmath>

namespace fathom::estimation {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// A surface known worse than this gives no depth.
constexpr double kSurfaceSigma_m = 20.0;

/// Covariance of a vector at the end of a lever: its own, and what the attitude error swings.
std::array<double, 9> with_lever(const ErrorFilter& filter, int first, const Vector3d& arm_N) {
  // (OUT-2)
  Matrix3d p = filter.block3(first, first);
  if (!arm_N.isZero(0.0)) {
    const Matrix3d swing = geo::skew(arm_N);
    const Matrix3d cross = filter.block3(first, 6) * swing.transpose();
    p += cross + cross.transpose() + swing * filter.block3(6, 6) * swing.transpose();
  }
  std::array<double, 9> out{};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) out[static_cast<std::size_t>(3 * i + j)] = 0.5 * (p(i, j) + p(j, i));
  return out;
}

void fill_attitude(const geo::Quaternion& q, NavState& out) {
  // One sign of the two that mean the same, so that readers may difference it.
  const double sign = q.w < 0.0 ? -1.0 : 1.0;
  out.q_NB = {sign * q.w, sign * q.x, sign * q.y, sign * q.z};
  out.rpy_rad = geo::arr(geo::to_rpy(q));
}

/// The filter knows the attitude of the unit against the plumb line (OUT-4).
std::array<double, 3> published_sigma_rad(const Setup& setup, const Navigator& navigator,
                                          const OutputAttitude& attitude) {
  const bool by_filter = !navigator.descent().aligning();
  std::array<double, 3> out = geo::arr(by_filter ? rpy_sigma_rad(attitude) : navigator.rpy_sigma_rad());
  const double deflection = setup.config.states.vertical_deflection_sigma_rad;
  const double mounting = setup.config.states.mounting_sigma_rad;
  for (std::size_t i = 0; i < 2; ++i)
    out[i] = std::sqrt(out[i] * out[i] + deflection * deflection + mounting * mounting);
  return out;
}

}  // namespace

void fill(const Setup& setup, const Navigator& navigator, NavState& out) {
  out.mode = navigator.mode();
  out.alignment = navigator.alignment().phase;
  out.gps_outage_s = navigator.gps_outage_s();
  out.dvl_outage_s = navigator.dvl_outage_s();
  out.reset_counter = navigator.reacquisition().reset_counter();
  out.last_reset_delta_N_m = geo::arr(navigator.reacquisition().last_reset_N_m());
  const OutputAttitude attitude = navigator.output_attitude();
  out.angular_rate_B_rad_s = geo::arr(attitude.along(navigator.rate_B_rad_s()));
  out.specific_force_B_m_s2 = geo::arr(attitude.along(navigator.force_B_m_s2()));
  if (!navigator.navigating()) {
    const NavState blank;
    out.latitude_rad = out.longitude_rad = out.altitude_m = out.depth_m = kUnknown;
    out.velocity_N_m_s = blank.velocity_N_m_s;
    out.position_covariance_N_m2 = blank.position_covariance_N_m2;
    out.velocity_covariance_N_m2_s2 = blank.velocity_covariance_N_m2_s2;
    out.q_NB = blank.q_NB;
    out.rpy_rad = out.rpy_sigma_rad = blank.rpy_rad;
    if (navigator.estimate().levelled) {
      const Vector3d rpy = geo::to_rpy(attitude.q_NO);
      out.rpy_rad = {rpy.x(), rpy.y(), kUnknown};
    }
    return;
  }
  const NavSolution& nav = navigator.state().nav;
  const Vector3d lever = geo::vec(setup.config.output_lever_B_m);
  Vector3d arm = Vector3d::Zero();
  Vector3d swing = Vector3d::Zero();
  geo::Geodetic at = nav.position;
  if (!lever.isZero(0.0)) {
    const Matrix3d c = geo::to_matrix(nav.q_NB);
    const geo::LocalEarth earth(nav.position);
    const Vector3d rate_nb =
        navigator.rate_B_rad_s() - c.transpose() * (earth.earth_rate_N + earth.transport_rate_N(nav.v_N_m_s));
    arm = c * lever;
    swing = c * geo::cross(rate_nb, lever);
    at = geo::moved_by(nav.position, arm);
  }
  out.latitude_rad = at.latitude_rad;
  out.longitude_rad = at.longitude_rad;
  out.altitude_m = at.altitude_m;
  const int surface = setup.index.of(Group::surface_altitude);
  if (surface < 0) {
    out.depth_m = setup.config.states.surface_altitude_m - at.altitude_m;
  } else {
    const bool good = navigator.filter()(surface, surface) < kSurfaceSigma_m * kSurfaceSigma_m;
    out.depth_m = good ? navigator.state().x[static_cast<std::size_t>(surface)] - at.altitude_m : kUnknown;
  }
  out.velocity_N_m_s = geo::arr(nav.v_N_m_s + swing);
  fill_attitude(attitude.q_NO, out);
  out.position_covariance_N_m2 = with_lever(navigator.filter(), 0, arm);
  out.velocity_covariance_N_m2_s2 = with_lever(navigator.filter(), 3, swing);
  out.rpy_sigma_rad = published_sigma_rad(setup, navigator, attitude);
}

void fill(const Setup& setup, const Navigator& navigator, NavDetail& out) {
  out.configuration = std::string_view(setup.config.configuration);
  out.count = 0;
  if (!navigator.navigating()) return;
  const NavSolution& nav = navigator.state().nav;
  const Vector3d rpy = geo::to_rpy(nav.q_NB);
  for (int i = 0; i < setup.index.estimated() && i < static_cast<int>(NavDetail::kMaxStates); ++i) {
    StateEstimate& one = out.states[out.count++];
    one.name = setup.index.name(i);
    one.sigma = std::sqrt(std::max(navigator.filter()(i, i), 0.0));
    if (i < 3) {
      one.value = 0.0;  // the position error after its correction; the position itself is in NavState
    } else if (i < 6) {
      one.value = nav.v_N_m_s(i - 3);
    } else if (i < kNavStates) {
      one.value = rpy(i - 6);
    } else {
      one.value = navigator.state().x[static_cast<std::size_t>(i)];
    }
  }
}

Verdict verdict_of(const SampleHeader& header, SourceKind source, const Judgement& judgement) {
  Verdict verdict;
  verdict.header = header;
  verdict.source = source;
  verdict.model = judgement.model;
  verdict.kind = verdict.previous = judgement.kind;
  verdict.dimensions = judgement.dimensions;
  for (std::size_t i = 0; i < judgement.dimensions; ++i) {
    verdict.innovation[i] = judgement.innovation[i];
    verdict.innovation_sigma[i] = judgement.innovation_sigma[i];
  }
  verdict.test_ratio = judgement.test_ratio;
  verdict.limit = judgement.limit;
  return verdict;
}

}  // namespace fathom::estimation
