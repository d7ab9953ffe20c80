#include "study/engine_run.hpp"

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <variant>

#include <Eigen/LU>

#include "geo/so3.hpp"
#include "geo/wgs84.hpp"
#include "samples/position/gives_position.hpp"

namespace fathom::study {

bool ImuSum::add(ImuSample& sample) {
  if (samples_ <= 1) return true;
  angle_ += geo::vec(sample.delta_angle_B_rad);
  velocity_ += geo::vec(sample.delta_velocity_B_m_s);
  dt_s_ += sample.delta_time_s;
  if (++count_ < samples_) return false;
  sample.delta_angle_B_rad = geo::arr(angle_);
  sample.delta_velocity_B_m_s = geo::arr(velocity_);
  sample.delta_time_s = dt_s_;
  sample.angular_rate_B_rad_s = geo::arr(angle_ / dt_s_);
  sample.specific_force_B_m_s2 = geo::arr(velocity_ / dt_s_);
  sample.header.sequence /= static_cast<std::uint64_t>(samples_);
  count_ = 0;
  dt_s_ = 0.0;
  angle_.setZero();
  velocity_.setZero();
  return true;
}

EngineRun::EngineRun(const estimation::EngineConfig& config, int imu_every)
    : engine_(config), sum_(imu_every) {}

void EngineRun::take(const sim::Measurement& measurement) {
  std::visit(
      [this](const auto& sample) {
        if constexpr (std::is_same_v<std::decay_t<decltype(sample)>, ImuSample>) {
          ImuSample summed = sample;
          if (!sum_.add(summed)) return;
          engine_.add(summed);
          if (at_rest_s_ > 0.0) {
            Command command;
            command.header.stamp_ns = summed.header.stamp_ns + 1;
            command.kind = CommandKind::mark_at_rest;
            command.value_s = at_rest_s_;
            (void)engine_.apply(command);
            at_rest_s_ = 0.0;
          }
        } else {
          engine_.add(sample);
        }
      },
      measurement);
  Verdict verdict;
  while (engine_.next_verdict(verdict)) tally_.add(verdict);
}

bool EngineRun::navigating() const {
  return gives_position(engine_.nav_state().mode);
}

void carry_out(sim::Simulation& simulation, double duration_s, std::span<EngineRun* const> engines,
               const std::function<void(const sim::Measurement&)>& observe) {
  const auto hand_out = [&](const sim::Measurement& measurement) {
    for (EngineRun* engine : engines) engine->take(measurement);
    if (observe) observe(measurement);
  };
  const auto received = [](const sim::Measurement& measurement) {
    return header_of(measurement).received_ns;
  };
  std::vector<sim::Measurement> fresh;
  std::vector<sim::Measurement> under_way;  // sampled, not yet arrived
  while (simulation.time_s() < duration_s - 1e-6) {
    fresh.clear();
    simulation.advance(fresh);
    const TimeNs now_ns = simulation.truth().header.stamp_ns;
    for (const auto& measurement : fresh)
      if (!std::holds_alternative<ImuSample>(measurement)) under_way.push_back(measurement);
    std::stable_sort(under_way.begin(), under_way.end(),
                     [&](const auto& a, const auto& b) { return received(a) < received(b); });
    std::size_t arrived = 0;
    while (arrived < under_way.size() && received(under_way[arrived]) <= now_ns)
      hand_out(under_way[arrived++]);
    under_way.erase(under_way.begin(), under_way.begin() + static_cast<std::ptrdiff_t>(arrived));
    for (const auto& measurement : fresh)
      if (std::holds_alternative<ImuSample>(measurement)) hand_out(measurement);
  }
}

HorizontalError horizontal_error(const NavState& nav, const Truth& truth) {
  HorizontalError out{kUnknown, kUnknown, kUnknown};
  if (!gives_position(nav.mode)) return out;
  const Eigen::Vector3d error = geo::difference_N({truth.latitude_rad, truth.longitude_rad, truth.altitude_m},
                                                  {nav.latitude_rad, nav.longitude_rad, nav.altitude_m});
  const Eigen::Vector2d e = error.head<2>();
  Eigen::Matrix2d p;
  p << nav.position_covariance_N_m2[0], nav.position_covariance_N_m2[1], nav.position_covariance_N_m2[3],
      nav.position_covariance_N_m2[4];
  out.error_m = e.norm();
  out.nees = e.dot(p.inverse() * e);
  out.sigma_m = std::sqrt(p.trace());
  return out;
}

}  // namespace fathom::study
