#include "estimation/output.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace fathom::estimation {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// A surface known worse than this gives no depth.
constexpr double kSurfaceSigma_m = 20.0;

Matrix3d block(const ErrorFilter& filter, int row, int column) {
  Matrix3d p;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) p(i, j) = filter(row + i, column + j);
  return p;
}

/// Covariance of a vector at the end of a lever: its own, and what the attitude error swings.
std::array<double, 9> with_lever(const ErrorFilter& filter, int first, const Vector3d& arm_N) {
  // (OUT-2)
  const Matrix3d swing = geo::skew(arm_N);
  const Matrix3d cross = block(filter, first, 6) * swing.transpose();
  const Matrix3d p = block(filter, first, first) + cross + cross.transpose() +
                     swing * block(filter, 6, 6) * swing.transpose();
  std::array<double, 9> out{};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) out[static_cast<std::size_t>(3 * i + j)] = 0.5 * (p(i, j) + p(j, i));
  return out;
}

void fill_attitude(const Core& core, NavState& out) {
  const geo::Quaternion& q = core.state().nav.q_NB;
  // One sign of the two that mean the same, so that readers may difference it.
  const double sign = q.w < 0.0 ? -1.0 : 1.0;
  out.q_NB = {sign * q.w, sign * q.x, sign * q.y, sign * q.z};
  out.rpy_rad = geo::arr(geo::to_rpy(q));
}

void set_text(std::array<char, 128>& target, const char* text) {
  target.fill('\0');
  std::strncpy(target.data(), text, target.size() - 1);
}

const char* advice(const StartConditions& c, const Core& core, const AlignmentConfig& config,
                   const Vector3d& sigma) {
  switch (core.phase()) {
    case AlignmentPhase::aligned:
    case AlignmentPhase::none:
      return "";
    case AlignmentPhase::fine:
      if (sigma.z() > config.aligned_heading_sigma_rad)
        return "Turn by 90 degrees or more and change speed: the heading is not yet known well enough.";
      return "Hold on: roll and pitch are settling.";
    default:
      break;
  }
  if (config.mode == StartMode::given || config.mode == StartMode::air_drop)
    return "Waiting for the state that it is to start from.";
  if (config.mode == StartMode::in_motion) return "Move straight with a GPS fix until the course is steady.";
  if (!c.slow) return "Stop the vehicle, or let it run straight with GPS.";
  if (!c.quiet) return "Keep the vehicle quiet: it moves too much to be levelled.";
  if (!c.window_full) return "Keep the vehicle quiet.";
  if (!c.position) return "A position is missing: wait for a GPS fix or set one.";
  if (!c.heading) return "A heading is missing: check the compass or give one.";
  return "The gyro is not good enough to find north: give a heading.";
}

const char* drop_advice(const DropAlignment& drop) {
  using C = StabilityCondition;
  switch (drop.phase()) {
    case AlignmentPhase::aligned:
      return "";
    case AlignmentPhase::coarse:
    case AlignmentPhase::fine:
      return drop.consistent() ? "Hold on: roll and pitch are being refined."
                               : "Log, depth and inertial unit contradict each other: run straight.";
    case AlignmentPhase::averaging:
      return "Hold course, depth and speed.";
    default:
      break;
  }
  if (!drop.wet()) return "Waiting for the water: the depth sensor reports none yet.";
  const StabilityGate& gate = drop.gate();
  const auto met = [&gate](C condition) { return gate.watched(condition).met(); };
  switch (drop.missing()) {
    case StabilityReset::no_depth:
      return "The depth is missing: everything begins anew when it is back.";
    case StabilityReset::no_speed:
      return "The propulsor speed is missing: everything begins anew when it is back.";
    default:
      break;
  }
  if (!met(C::depth)) return "Go to the set depth and hold it within the limit.";
  if (!met(C::roll)) return "Hold roll near zero.";
  if (!met(C::pitch) || !met(C::force_x)) return "Level off: hold pitch near zero.";
  if (!met(C::rate_z)) return "Run straight: it turns too fast.";
  if (!met(C::rate_y) || !met(C::gravity)) return "Hold the pitch steady.";
  if (!met(C::speed_slope)) return "Hold the speed steady.";
  switch (gate.last_reset()) {
    case StabilityReset::spread:
      return "Hold on: the last window was too restless.";
    case StabilityReset::disagreement:
      return "Hold on: the last window contradicted the fine solution.";
    case StabilityReset::gap:
    case StabilityReset::repeated:
    case StabilityReset::stale:
    case StabilityReset::not_finite:
      return "Hold on: inertial samples were missing or bad, and the window began anew.";
    default:
      return "Hold on.";
  }
}

void add_condition(AlignmentStatus& out, const char* name, double value, double limit, bool met,
                   double held_s = 0.0, double needed_s = 0.0) {
  if (out.condition_count >= AlignmentStatus::kMaxConditions) return;
  AlignmentCondition& one = out.conditions[out.condition_count++];
  one.name = name;
  one.value = value;
  one.limit = limit;
  one.met = met;
  one.held_s = held_s;
  one.needed_s = needed_s;
}

/// Each condition of the run, then how far the averages and the fine solution are.
void fill_drop(const DropAlignment& drop, AlignmentStatus& out) {
  for (std::size_t i = 0; i < kStabilityConditions; ++i) {
    const auto condition = static_cast<StabilityCondition>(i);
    const StabilityGate::Watched& one = drop.gate().watched(condition);
    add_condition(out, to_string(condition).data(), one.value, one.limit, one.met(), one.held_s,
                  one.needed_s);
  }
  const Vector3d sigma = drop.rpy_sigma_rad();
  const double limit = drop.config().aligned_tilt_sigma_rad;
  const double hold = drop.config().aligned_hold_s;
  add_condition(out, "roll_sigma_rad", sigma.x(), limit, sigma.x() <= limit, drop.held_s(), hold);
  add_condition(out, "pitch_sigma_rad", sigma.y(), limit, sigma.y() <= limit, drop.held_s(), hold);
  out.time_to_aligned_s = drop.time_to_aligned_s();
  set_text(out.advice, drop_advice(drop));
}

}  // namespace

void fill(const Setup& setup, const Core& core, NavState& out) {
  out.mode = core.mode();
  out.alignment = core.phase();
  out.gps_outage_s = core.gps_outage_s();
  out.dvl_outage_s = core.dvl_outage_s();
  out.reset_counter = core.reset_counter();
  out.last_reset_delta_N_m = geo::arr(core.last_reset_N_m());
  out.angular_rate_B_rad_s = geo::arr(core.rate_B_rad_s());
  out.specific_force_B_m_s2 = geo::arr(core.force_B_m_s2());
  if (!core.navigating()) {
    const NavState blank;
    out.latitude_rad = out.longitude_rad = out.altitude_m = out.depth_m = kUnknown;
    out.velocity_N_m_s = blank.velocity_N_m_s;
    out.position_covariance_N_m2 = blank.position_covariance_N_m2;
    out.velocity_covariance_N_m2_s2 = blank.velocity_covariance_N_m2_s2;
    out.q_NB = blank.q_NB;
    out.rpy_rad = out.rpy_sigma_rad = blank.rpy_rad;
    if (core.levelled()) {
      const Vector3d rpy = geo::to_rpy(core.state().nav.q_NB);
      out.rpy_rad = {rpy.x(), rpy.y(), kUnknown};
    }
    return;
  }
  const NavSolution& nav = core.state().nav;
  const Matrix3d c = geo::to_matrix(nav.q_NB);
  const Vector3d lever = geo::vec(setup.config.output_lever_B_m);
  const Vector3d arm = c * lever;
  const Vector3d rate_nb =
      core.rate_B_rad_s() - c.transpose() * (geo::earth_rate_N(nav.position.latitude_rad) +
                                             geo::transport_rate_N(nav.position, nav.v_N_m_s));
  const Vector3d swing = c * geo::cross(rate_nb, lever);
  const geo::Geodetic at = geo::moved_by(nav.position, arm);
  out.latitude_rad = at.latitude_rad;
  out.longitude_rad = at.longitude_rad;
  out.altitude_m = at.altitude_m;
  const int surface = setup.index.of(Group::surface_altitude);
  if (surface < 0) {
    out.depth_m = setup.config.states.surface_altitude_m - at.altitude_m;
  } else {
    const bool good = core.filter()(surface, surface) < kSurfaceSigma_m * kSurfaceSigma_m;
    out.depth_m = good ? core.state().x[static_cast<std::size_t>(surface)] - at.altitude_m : kUnknown;
  }
  out.velocity_N_m_s = geo::arr(nav.v_N_m_s + swing);
  fill_attitude(core, out);
  out.position_covariance_N_m2 = with_lever(core.filter(), 0, arm);
  out.velocity_covariance_N_m2_s2 = with_lever(core.filter(), 3, swing);
  out.rpy_sigma_rad = geo::arr(core.rpy_sigma_rad());
}

void fill(const Setup& setup, const Core& core, NavDetail& out) {
  out.configuration = std::string_view(setup.config.configuration);
  out.count = 0;
  if (!core.navigating()) return;
  const NavSolution& nav = core.state().nav;
  const Vector3d rpy = geo::to_rpy(nav.q_NB);
  for (int i = 0; i < setup.index.size() && i < static_cast<int>(NavDetail::kMaxStates); ++i) {
    StateEstimate& one = out.states[out.count++];
    one.name = setup.index.name(i);
    one.sigma = std::sqrt(std::max(core.filter()(i, i), 0.0));
    if (i < 3) {
      one.value = 0.0;  // the position error after its correction; the position itself is in NavState
    } else if (i < 6) {
      one.value = nav.v_N_m_s(i - 3);
    } else if (i < kNavStates) {
      one.value = rpy(i - 6);
    } else {
      one.value = core.state().x[static_cast<std::size_t>(i)];
    }
  }
}

void fill(const Setup& setup, const Core& core, AlignmentStatus& out) {
  const AlignmentConfig& config = setup.config.alignment;
  out.phase = core.phase();
  out.in_phase_s = to_seconds(core.now_ns() - core.phase_since_ns());
  out.condition_count = 0;
  const Vector3d sigma = core.rpy_sigma_rad();
  out.rpy_sigma_rad = geo::arr(sigma);
  out.time_to_aligned_s = kUnknown;
  if (core.dropping()) {
    fill_drop(core.drop(), out);
    return;
  }
  const StartConditions c = core.conditions();
  if (core.navigating()) {
    const double held =
        core.aligned_hold_since_ns() == 0 ? 0.0 : to_seconds(core.now_ns() - core.aligned_hold_since_ns());
    const auto sigma_condition = [&](const char* name, double value, double limit) {
      add_condition(out, name, value, limit, value <= limit, held, config.aligned_hold_s);
    };
    sigma_condition("roll_sigma_rad", sigma.x(), config.aligned_tilt_sigma_rad);
    sigma_condition("pitch_sigma_rad", sigma.y(), config.aligned_tilt_sigma_rad);
    sigma_condition("yaw_sigma_rad", sigma.z(), config.aligned_heading_sigma_rad);
    if (core.phase() == AlignmentPhase::aligned) {
      out.time_to_aligned_s = 0.0;
    } else if (core.aligned_hold_since_ns() != 0) {
      out.time_to_aligned_s = std::max(0.0, config.aligned_hold_s - held);
    }
  } else if (config.mode != StartMode::given && config.mode != StartMode::air_drop) {
    const RestWindow& window = core.window();
    const double held = window.duration_s();
    const auto rest_condition = [&](const char* name, double value, double limit, bool met) {
      add_condition(out, name, value, limit, met, held, config.averaging_s);
    };
    rest_condition("rate_spread_rad_s", window.rate_spread_rad_s(), config.rate_spread_rad_s,
                   window.rate_spread_rad_s() <= config.rate_spread_rad_s);
    rest_condition("force_spread_m_s2", window.force_spread_m_s2(), config.force_spread_m_s2,
                   window.force_spread_m_s2() <= config.force_spread_m_s2);
    rest_condition("gps_speed_m_s", core.gps_speed_m_s(), config.max_speed_m_s, c.slow);
    add_condition(out, "heading_known", c.heading ? 1.0 : 0.0, 1.0, c.heading);
    add_condition(out, "position_known", c.position ? 1.0 : 0.0, 1.0, c.position);
    if (c.quiet && c.slow && c.heading && c.position)
      out.time_to_aligned_s = std::max(0.0, config.averaging_s - held) + config.aligned_hold_s;
  }
  set_text(out.advice, advice(c, core, config, sigma));
}

Verdict verdict_of(const SampleHeader& header, SourceKind source, const Judgement& judgement) {
  Verdict verdict;
  verdict.header = header;
  verdict.source = source;
  verdict.model = judgement.model;
  verdict.kind = judgement.kind;
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
