#pragma once

#include "archive/values.hpp"
#include "estimation/doubt/adaptive_noise.hpp"
#include "estimation/doubt/bias_prior.hpp"
#include "estimation/doubt/motion_noise.hpp"
#include "estimation/doubt/slow_error.hpp"
#include "estimation/doubt/start_heading.hpp"

/// Fields of what is found to be other than was said.
namespace fathom::estimation {

template <class Archive, class Self>
void AdaptiveNoise::Left::fields(Archive& archive, Self& self) {
  archive("residual", self.residual, fathom::archive::any_number());  // unknown without a measurement
  archive("state_variance", self.state_variance, fathom::archive::at_least_zero());
  archive("said_variance", self.said_variance, fathom::archive::at_least_zero());
}

template <class Archive, class Self>
void AdaptiveNoise::Component::fields(Archive& archive, Self& self) {
  archive("last", self.last);
  archive("used", self.used);
  archive("trend", self.trend, fathom::archive::finite());
  archive("log_square", self.log_square, fathom::archive::within(0.0, 10.0));
  archive("count", self.count, fathom::archive::kCount);
  archive("recent", self.recent, fathom::archive::within(0.0, 1.0));
  archive("noisy", self.noisy);
  if (!archive.since(19)) return;
  archive("log_white", self.log_white, fathom::archive::within(-10.0, 0.0));
  archive("quiet", self.quiet);
}

template <class Archive, class Self>
void AdaptiveNoise::fields(Archive& archive, Self& self) {
  archive("last_ns", self.last_ns_, fathom::archive::kInstant);
  archive("used_ns", self.used_ns_, fathom::archive::kInstant);
  archive("components", self.components_);
}

template <class Archive, class Self>
void StartHeading::fields(Archive& archive, Self& self) {
  archive("open", self.open_);
  archive("corrections", self.corrections_, fathom::archive::kCount);
  constexpr double kMost = 1e12;
  archive("found_rad", self.found_rad_, fathom::archive::within(-10.0, 10.0));
  archive("gradient", self.gradient_, fathom::archive::within(-kMost, kMost));
  archive("curvature", self.curvature_, fathom::archive::within(0.0, kMost));
  archive("together", self.together_, fathom::archive::within(-kMost, kMost));
  archive("together_s", self.together_s_, fathom::archive::within(0.0, 10.0));
  archive("scatter", self.scatter_.sums, fathom::archive::within(-kMost * kMost, kMost * kMost));
  archive("column", self.column_, fathom::archive::within(-kMost, kMost));
  if (archive.since(17)) archive("considered", self.considered_.sums, fathom::archive::within(-kMost, kMost));
}

template <class Archive, class Self>
void BiasPrior::Blocks::fields(Archive& archive, Self& self) {
  archive("gradient_before", self.before.gradient, fathom::archive::finite());
  archive("curvature_before", self.before.curvature, fathom::archive::finite());
  archive("curvature", self.curvature, fathom::archive::finite());
  archive("scatter", self.scatter.sums, fathom::archive::finite());
}

template <class Archive, class Self>
void BiasPrior::Bias::fields(Archive& archive, Self& self) {
  archive.left_out(self.state);
  archive("mean", self.mean, fathom::archive::finite());
  archive("variance", self.variance, fathom::archive::at_least_zero());
  archive("corrections", self.corrections, fathom::archive::kCount);
  archive("blocks", self.blocks);
}

template <class Archive, class Self>
void BiasPrior::fields(Archive& archive, Self& self) {
  archive("biases", self.biases_);
  archive("open", self.open_);
  archive("block_s", self.block_s_, fathom::archive::at_least_zero());
}

template <class Archive, class Self>
void MotionNoise::Kind::fields(Archive& archive, Self& self) {
  archive("square", self.square, fathom::archive::within(1.0, 1e4));
  archive("log_ratio", self.log_ratio, fathom::archive::within(-1e3, 1e3));
  archive("share", self.share, fathom::archive::at_least_zero());
  archive("count", self.count, fathom::archive::kCount);
}

template <class Archive, class Self>
void MotionNoise::Block::fields(Archive& archive, Self& self) {
  archive("age_s", self.age_s, fathom::archive::at_least_zero());
  archive("gradient", self.gradient, fathom::archive::finite());
  archive("curvature", self.curvature, fathom::archive::at_least_zero());
  if (archive.since(17)) archive("considered", self.considered.sums, fathom::archive::finite());
}

template <class Archive, class Self>
void MotionNoise::fields(Archive& archive, Self& self) {
  archive.left_out(self.estimated_);
  archive("now", self.now_, fathom::archive::finite());
  archive("blocks", self.blocks_);
  archive("kinds", self.kinds_);
}

template <class Archive, class Self>
void SlowError::fields(Archive& archive, Self& self) {
  archive.left_out(self.first_);
  archive.left_out(self.axes_);
  archive.left_out(self.said_);
  archive("variance", self.variance_, fathom::archive::within(0.0, 1e12));
}

}  // namespace fathom::estimation
