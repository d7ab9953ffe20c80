#include "estimation/doubt/bias_prior.hpp"

#include <algorithm>
#include <cmath>

namespace fathom::estimation {
namespace {

/// Of the variance that is said: where less has been learned, an instant decides.
constexpr double kLeastLearned = 1e-3;
/// Smaller, in whatever unit, it is said to be none: nothing is learned.
constexpr double kLeastVariance = 1e-30;

constexpr std::size_t kGyros = 3;

double most_of(std::size_t bias) {
  return bias < kGyros ? kMostGyroBias_rad_s : kMostAccelBias_m_s2;
}

}  // namespace

BiasPrior::BiasPrior(const StateIndex& index) {
  for (std::size_t i = 0; i < kBiases; ++i) {
    const int first = index.of(i < kGyros ? Group::gyro_bias : Group::accel_bias);
    const int state = first + static_cast<int>(i % kGyros);
    if (first >= 0 && state < index.estimated()) biases_[i].state = state;
  }
}

void BiasPrior::begin(const FilterState& state, const ErrorFilter& filter) {
  for (Bias& one : biases_) {
    if (one.state < 0) continue;
    one.mean = state.x[static_cast<std::size_t>(one.state)];
    one.variance = filter(one.state, one.state);
    one.corrections = 0;
  }
  interrupt();
}

void BiasPrior::interrupt() {
  open_ = {};
  block_s_ = {};
  for (Bias& one : biases_) one.blocks = {};
}

BiasPrior::Evidence BiasPrior::Bias::evidence(const FilterState& now, const ErrorFilter& filter) const {
  if (!(variance > kLeastVariance)) return {};
  const double beyond = now.x[static_cast<std::size_t>(state)] - mean;
  return {beyond / variance, (variance - filter(state, state)) / (variance * variance)};
}

void BiasPrior::Blocks::end(const Evidence& now, bool whole) {
  if (whole) {
    const double g = now.gradient - before.gradient;
    const double j = now.curvature - before.curvature;
    curvature += j;
    scatter.add(g, j);
  }
  before = now;
}

void BiasPrior::propagated(const StateDrift& drift, double dt_s, const FilterState& state,
                           const ErrorFilter& filter) {
  for (Bias& one : biases_) {
    if (one.state < 0) continue;
    const double kept = drift.kept(one.state, dt_s);
    one.mean *= kept;
    one.variance = kept * kept * one.variance + dt_s * drift.walk(one.state);
  }
  for (std::size_t length = 0; length < kBlocks_s.size(); ++length) {
    block_s_[length] += dt_s;
    if (block_s_[length] < kBlocks_s[length]) continue;
    for (Bias& one : biases_)
      if (one.state >= 0) one.blocks[length].end(one.evidence(state, filter), open_[length]);
    open_[length] = true;
    block_s_[length] = 0.0;
  }
}

void BiasPrior::widen(int state, double variance) {
  for (Bias& one : biases_)
    if (one.state == state) one.variance += variance;
}

std::optional<BiasPrior::Wrong> BiasPrior::wrong(const FilterState& state, const ErrorFilter& filter) const {
  // (GATE-11)
  std::optional<Wrong> out;
  double most = kCertain * kCertain;
  for (std::size_t i = 0; i < kBiases; ++i) {
    const Bias& one = biases_[i];
    if (one.state < 0 || one.corrections == kMostCorrections) continue;
    const Evidence now = one.evidence(state, filter);
    if (!(now.curvature * one.variance > kLeastLearned)) continue;
    const double found = now.gradient / now.curvature;
    // The blocks that have begun count as far as they go.
    std::array<Blocks, kBlocks_s.size()> blocks = one.blocks;
    double scatters = 1.0;
    for (std::size_t length = 0; length < blocks.size(); ++length) {
      blocks[length].end(now, open_[length]);
      if (blocks[length].are_enough()) scatters = std::max(scatters, blocks[length].scatters(found));
    }
    if (!one.blocks[0].are_enough() || !blocks[0].are_enough()) continue;
    const double squared = now.gradient * found / scatters;
    if (!(squared > most) || !(std::abs(one.mean + found) < most_of(i))) continue;
    most = squared;
    const double taken_back = 1.0 / one.variance - 1.0 / (found * found);
    out = {.bias = i,
           .state = one.state,
           .beyond = state.x[static_cast<std::size_t>(one.state)] - one.mean,
           .variance = found * found,
           .share = taken_back / (1.0 - taken_back * filter(one.state, one.state))};
  }
  return out;
}

void BiasPrior::corrected(const Wrong& wrong) {
  Bias& one = biases_[wrong.bias];
  one.variance = wrong.variance;
  ++one.corrections;
  interrupt();
}

}  // namespace fathom::estimation
