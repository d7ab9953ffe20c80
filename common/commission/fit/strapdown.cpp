#include "commission/fit/strapdown.hpp"

#include <algorithm>

#include "geo/so3.hpp"

namespace fathom::commission {

using Eigen::Vector3d;

namespace {

constexpr double kStep_s = 0.02;
// A turn by a bias that has moved. The derivatives leave out half its square: of gravity felt for half a
// minute, 0.15 mm/s.
constexpr double kLinear_rad = 1e-3;

}  // namespace

Strapdown::Strapdown(const ImuSeries& imu, const ImuReading& reading, double from_s, double to_s,
                     Integrate what) {
  const bool with_biases = what == Integrate::motion_and_biases;
  auto i =
      static_cast<std::size_t>(std::lower_bound(imu.t_s.begin(), imu.t_s.end(), from_s) - imu.t_s.begin());
  if (i >= imu.size()) return;
  const double span_s = std::min(to_s, imu.t_s.back()) - imu.t_s[i];
  const auto most = static_cast<std::size_t>(std::clamp(span_s / kStep_s, 0.0, 1e6)) + 2;
  t_s_.reserve(most);
  steps_.reserve(most);
  if (with_biases) of_bias_.reserve(most);
  Step now;
  OfBias of_bias;
  t_s_.push_back(imu.t_s[i]);
  steps_.push_back(now);
  if (with_biases) of_bias_.push_back(of_bias);
  // As recorded: they are read right once a step.
  Vector3d sum_of_rate = Vector3d::Zero();
  Vector3d sum_of_force = Vector3d::Zero();
  double span = 0.0;
  for (++i; i < imu.size() && imu.t_s[i] <= to_s; ++i) {
    const double dt = imu.t_s[i] - imu.t_s[i - 1];
    if (dt > 0.5) break;
    sum_of_rate += imu.rate[i] * dt;
    sum_of_force += imu.force[i] * dt;
    span += dt;
    if (span < kStep_s - 1e-6) continue;
    const Vector3d angle = reading.rate * (sum_of_rate - reading.rate_bias * span);
    const Vector3d velocity = reading.force * sum_of_force;
    const geo::Quaternion half = geo::exp(0.5 * angle);
    const geo::Quaternion middle = now.q_WB * half;
    now.q_WB = geo::normalized(middle * half);
    const Eigen::Matrix3d C_middle = geo::to_matrix(middle);
    const Vector3d velocity_W = C_middle * velocity;
    now.S += velocity_W;
    now.rate = angle / span;
    t_s_.push_back(imu.t_s[i]);
    steps_.push_back(now);
    if (with_biases) {
      of_bias.IFC += geo::skew(velocity_W) * (of_bias.IC + 0.5 * span * C_middle);
      of_bias.IC += C_middle * span;
      of_bias_.push_back(of_bias);
    }
    sum_of_rate.setZero();
    sum_of_force.setZero();
    span = 0.0;
  }
}

Strapdown::Place Strapdown::place_of(double t_s) const {
  const auto later = std::lower_bound(t_s_.begin() + 1, t_s_.end() - 1, t_s);
  const auto next = static_cast<std::size_t>(later - t_s_.begin());
  return {next, (t_s - t_s_[next - 1]) / (t_s_[next] - t_s_[next - 1])};
}

Strapdown::State Strapdown::state_at(const Place& place) const {
  const Step& a = steps_[place.next - 1];
  const Step& b = steps_[place.next];
  State out;
  out.S = a.S + place.share * (b.S - a.S);
  out.rate = b.rate;
  const double since_s = place.share * (t_s_[place.next] - t_s_[place.next - 1]);
  out.C_WB = geo::to_matrix(a.q_WB * geo::exp(since_s * b.rate));
  return out;
}

Strapdown::State Strapdown::at(double t_s) const {
  return state_at(place_of(t_s));
}

Strapdown::Both Strapdown::both_at(double t_s) const {
  const Place place = place_of(t_s);
  const OfBias& a = of_bias_[place.next - 1];
  const OfBias& b = of_bias_[place.next];
  return {state_at(place), {a.IC + place.share * (b.IC - a.IC), a.IFC + place.share * (b.IFC - a.IFC)}};
}

MovedStrapdown::MovedStrapdown(const ImuSeries& imu, const ImuReading& reading, double from_s, double to_s)
    : imu_(imu),
      integrated_(reading),
      from_s_(from_s),
      to_s_(to_s),
      strapdown_(imu, reading, from_s, to_s, Strapdown::Integrate::motion_and_biases) {}

void MovedStrapdown::move_to(const Vector3d& rate_bias) {
  moved_ = integrated_.rate * (rate_bias - integrated_.rate_bias);
  if (moved_.norm() * (to_s_ - from_s_) <= kLinear_rad) return;
  integrated_.rate_bias = rate_bias;
  strapdown_ = Strapdown(imu_, integrated_, from_s_, to_s_, Strapdown::Integrate::motion_and_biases);
  moved_.setZero();
}

Strapdown::Both MovedStrapdown::at(double t_s) const {
  Strapdown::Both out = strapdown_.both_at(t_s);
  out.state.C_WB = geo::to_matrix(geo::exp(-out.of_bias.IC * moved_)) * out.state.C_WB;
  out.state.S += out.of_bias.IFC * moved_;
  out.state.rate -= moved_;
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
