#include "estimation/doubt/motion_noise.hpp"

namespace fathom::estimation {
namespace {

/// Of what a block would show the noise has at least this share; else the block says nothing of it.
constexpr double kLeastShare = 0.01;
/// So many figures at least, and at most so many have a say.
constexpr std::uint32_t kFewest = 12;
constexpr std::uint32_t kMostCounted = 200;
/// So many sigmas of the ratio leave no doubt that it is not one.
constexpr double kEnough = 4.0;

}  // namespace

void MotionNoise::widen(const std::array<double, kKinds>& said, ProcessNoise& noise) const {
  noise.velocity.diagonal().array() += (kinds_[kAccelerometers].square - 1.0) * said[kAccelerometers];
  noise.attitude.diagonal().array() += (kinds_[kGyros].square - 1.0) * said[kGyros];
}

void MotionNoise::interrupt() {
  blocks_ = {};
  now_ = {};
  for (std::size_t kind = 0; kind < kKinds; ++kind) begin_block(kind);
}

void MotionNoise::begin_block(std::size_t kind) {
  blocks_[kind] = {};
  for (std::size_t axis = 0; axis < kAxes; ++axis) {
    const std::size_t error = kind * kAxes + axis;
    for (std::size_t i = 0; i < kMaxStates; ++i) now_[i * kErrors + error] = kFirst + error == i ? 1.0 : 0.0;
  }
}

void MotionNoise::propagated(const NavTransition& step, const ProcessNoise& noise,
                             const std::array<double, kKinds>& said, double most) {
  follow<kErrors>(step, noise, now_);
  bool ended = false;
  for (std::size_t kind = 0; kind < kKinds; ++kind) {
    blocks_[kind].age_s += step.dt_s();
    if (!is_over(kind, said[kind])) continue;
    end_block(kind, said[kind]);
    ended = true;
  }
  if (ended) judge(most);
}

void MotionNoise::updated(const Observation& observation, const InnovationStatistics& statistics,
                          const ErrorFilter& filter) {
  // (GATE-12)
  const Evidence<kErrors> evidence(now_, observation, statistics);
  for (std::size_t j = 0; j < kErrors; ++j) {
    Block& block = blocks_[j / kAxes];
    block.gradient[j % kAxes] += evidence.gradient[j];
    block.curvature[j % kAxes] += evidence.curvature[j];
    block.considered.add(j % kAxes, evidence, j, statistics, filter);
  }
  follow(evidence, statistics, estimated_, now_);
}

void MotionNoise::carried(const Carry& carry) {
  follow<kErrors>(carry, now_);
}

double MotionNoise::share(std::size_t kind, std::size_t axis, double said) const {
  const Block& block = blocks_[kind];
  return block.curvature[axis] > 0.0
             ? block.curvature[axis] * block.curvature[axis] / block.variance(axis) * said * block.age_s
             : 0.0;
}

bool MotionNoise::is_over(std::size_t kind, double said) const {
  const double age_s = blocks_[kind].age_s;
  if (age_s < kBlock_s[kind] || age_s >= kLongestBlock_s[kind]) return age_s >= kBlock_s[kind];
  for (std::size_t axis = 0; axis < kAxes; ++axis)
    if (share(kind, axis, said) > kLeastShare) return true;
  return false;
}

void MotionNoise::end_block(std::size_t kind, double said) {
  const Block& block = blocks_[kind];
  for (std::size_t axis = 0; axis < kAxes; ++axis)
    if (const double shown = share(kind, axis, said); shown > kLeastShare)
      kinds_[kind].add(block.gradient[axis] * block.gradient[axis] / block.variance(axis), shown);
  begin_block(kind);
}

void MotionNoise::judge(double most) {
  // None is judged before the other can be: what is wrong of one shows in the other, too.
  for (const Kind& one : kinds_)
    if (one.count < kFewest) return;
  Kind& velocity = kinds_[kAccelerometers];
  Kind& attitude = kinds_[kGyros];
  if (!velocity.is_wrong() && !attitude.is_wrong()) return;
  // That of the gyros makes much of the attitude and less of the velocity, the other as much of both.
  constexpr double kAsMuch = 0.75;
  Kind& likelier = velocity.log_ratio > kAsMuch * attitude.log_ratio ? velocity : attitude;
  Kind& other = &likelier == &velocity ? attitude : velocity;
  if (!likelier.is_wrong() && likelier.may_be()) return;
  (likelier.is_wrong() ? likelier : other).correct(most);
  velocity.forget();
  attitude.forget();
}

void MotionNoise::Kind::add(double ratio, double share_of_said) {
  // The mean of min(q, 3) for q the square of a standard normal figure, and by what share of itself it grows
  // with the logarithm of q.
  constexpr double kClip = 3.0;
  constexpr double kMean = 0.858336;
  constexpr double kSlope = 0.708769;
  constexpr std::uint32_t kStart = 4;
  count = std::min(count + 1, kMostCounted);
  const double clipped = std::min(ratio / std::exp(log_ratio), kClip);
  log_ratio += (clipped / kMean - 1.0) / (kSlope * (count + kStart));
  share += (share_of_said - share) / count;
}

double MotionNoise::Kind::sigmas() const {
  constexpr double kSpread = 1.571;  // of the logarithm of the ratio, by one figure
  if (count < kFewest) return 0.0;
  const double sigmas = log_ratio * std::sqrt(static_cast<double>(count)) / kSpread;
  return square > 1.0 ? sigmas : std::max(sigmas, 0.0);
}

bool MotionNoise::Kind::is_wrong() const {
  return std::abs(sigmas()) > kEnough;
}

bool MotionNoise::Kind::may_be() const {
  return sigmas() > 0.5 * kEnough;
}

void MotionNoise::Kind::correct(double most) {
  // By what makes the blocks show what is expected; in steps, as that is known roughly.
  constexpr double kStep = 16.0;
  constexpr double kNone = 1.2;
  const double wanted = square + (std::exp(log_ratio) - 1.0) / share;
  square = std::clamp(std::clamp(wanted, square / kStep, square * kStep), 1.0, most * most);
  if (square < kNone) square = 1.0;
}

}  // namespace fathom::estimation
