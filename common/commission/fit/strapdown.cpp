#include "commission/fit/strapdown.hpp"

#include <algorithm>

#include "geo/so3.hpp"

namespace fathom::commission {

using Eigen::Vector3d;

Strapdown::Strapdown(const ImuSeries& imu, const ImuReading& reading, double from_s, double to_s,
                     double step_s) {
  auto i =
      static_cast<std::size_t>(std::lower_bound(imu.t_s.begin(), imu.t_s.end(), from_s) - imu.t_s.begin());
  if (i >= imu.size()) return;
  const double span_s = std::min(to_s, imu.t_s.back()) - imu.t_s[i];
  const auto most = static_cast<std::size_t>(std::clamp(span_s / step_s, 0.0, 1e6)) + 2;
  t_s_.reserve(most);
  states_.reserve(most);
  State state;
  geo::Quaternion q;
  t_s_.push_back(imu.t_s[i]);
  states_.push_back(state);
  Vector3d angle = Vector3d::Zero();
  Vector3d velocity = Vector3d::Zero();
  double span = 0.0;
  for (++i; i < imu.size() && imu.t_s[i] <= to_s; ++i) {
    const double dt = imu.t_s[i] - imu.t_s[i - 1];
    if (dt > 0.5) break;
    angle += reading.rate * (imu.rate[i] - reading.rate_bias) * dt;
    velocity += reading.force * imu.force[i] * dt;
    span += dt;
    if (span < step_s - 1e-6) continue;
    const geo::Quaternion half = geo::exp(0.5 * angle);
    const geo::Quaternion middle = q * half;
    q = geo::normalized(middle * half);
    const Eigen::Matrix3d C_middle = geo::to_matrix(middle);
    const Vector3d velocity_W = C_middle * velocity;
    state.S += velocity_W;
    state.IFC += geo::skew(velocity_W) * (state.IC + 0.5 * span * C_middle);
    state.IC += C_middle * span;
    state.C_WB = geo::to_matrix(q);
    state.rate = angle / span;
    t_s_.push_back(imu.t_s[i]);
    states_.push_back(state);
    angle.setZero();
    velocity.setZero();
    span = 0.0;
  }
  if (states_.size() > 1) states_.front().rate = states_[1].rate;
}

Strapdown::State Strapdown::at(double t_s) const {
  const auto next = std::lower_bound(t_s_.begin() + 1, t_s_.end() - 1, t_s);
  const auto i = static_cast<std::size_t>(next - t_s_.begin());
  const double share = (t_s - t_s_[i - 1]) / (t_s_[i] - t_s_[i - 1]);
  const State& a = states_[i - 1];
  const State& b = states_[i];
  State out;
  out.S = a.S + share * (b.S - a.S);
  out.IC = a.IC + share * (b.IC - a.IC);
  out.IFC = a.IFC + share * (b.IFC - a.IFC);
  out.rate = b.rate;
  // The turn within one step is small.
  const Vector3d turn = geo::log(geo::from_matrix(a.C_WB.transpose() * b.C_WB));
  out.C_WB = a.C_WB * geo::to_matrix(geo::exp(share * turn));
  return out;
}

Vector3d rate_about(const ImuSeries& imu, const ImuReading& reading, double t_s) {
  constexpr double kHalf_s = 0.1;
  Vector3d sum = Vector3d::Zero();
  double count = 0.0;
  auto i = static_cast<std::size_t>(std::lower_bound(imu.t_s.begin(), imu.t_s.end(), t_s - kHalf_s) -
                                    imu.t_s.begin());
  for (; i < imu.size() && imu.t_s[i] <= t_s + kHalf_s; ++i, count += 1.0)
    sum += imu.rate[i] - reading.rate_bias;
  return count > 0.0 ? Vector3d(reading.rate * sum / count) : Vector3d::Zero();
}

}  // namespace fathom::commission
