#include "estimation/doubt/adaptive_noise.hpp"

#include "base/time.hpp"

namespace fathom::estimation {

void AdaptiveNoise::note(const Judged& judged) {
  constexpr double kLongest_s = 30.0;  // the state has moved on without the instrument
  const auto fresh = [&](TimeNs at_ns) {
    return at_ns != 0 && to_seconds(judged.now_ns - at_ns) <= kLongest_s;
  };
  const bool last = fresh(last_ns_);
  const bool used = fresh(used_ns_);
  const Observation& rows = judged.rows;
  std::array<Left, Observation::kMaxRows> left{};
  for (std::size_t i = 0; i < static_cast<std::size_t>(rows.rows); ++i) {
    Component& one = components_[rows.component[i]];
    const double scale = factor(rows.component[i]);
    const double noise = rows.sigma[i] * rows.sigma[i];
    const double said_variance = noise / (scale * scale);
    const double state_variance =
        std::max(0.0, judged.innovation_sigma[i] * judged.innovation_sigma[i] - noise);
    // A measurement that agrees with the last one, or with the last that was used, is as it should be.
    const double off_last = last ? std::abs(rows.innovation[i] - one.last.residual) : kUnknown;
    const double off_used = used ? std::abs(rows.innovation[i] - one.used.residual) : kUnknown;
    if (std::isfinite(off_last) || std::isfinite(off_used))
      one.compare(rows.innovation[i], state_variance, said_variance,
                  off_used <= off_last || !std::isfinite(off_last) ? one.used : one.last, judged.most);
    Left& mine = left[rows.component[i]];
    mine.residual = rows.innovation[i];
    for (int j = 0; j < rows.column_count; ++j) {
      const std::size_t state = rows.columns[static_cast<std::size_t>(j)];
      mine.residual -= rows.h[i][state] * judged.moved[state];
    }
    mine.state_variance = judged.used ? state_variance * noise / (state_variance + noise) : state_variance;
    mine.said_variance = said_variance;
  }
  last_ns_ = judged.now_ns;
  if (judged.used) used_ns_ = judged.now_ns;
  for (std::size_t i = 0; i < left.size(); ++i) {
    components_[i].last = left[i];
    if (judged.used) components_[i].used = left[i];
  }
}

void AdaptiveNoise::Component::compare(double innovation, double state_variance, double said_variance,
                                       const Left& with, double most) {
  // The mean of min(q, 1) for q the square of a standard normal figure, and its slope by the logarithm of q.
  constexpr double kMean = 0.516059;
  constexpr double kSlope = 0.385;
  // What the mean of n such figures, each of which shares its noise with the next, makes the logarithm
  // uncertain by, times the root of n; and for how many there is enough doubt.
  constexpr double kSpread = 2.5;
  constexpr double kSigmas = 4.0;
  constexpr double kSlowest = 0.01;
  constexpr double kLeast = 0.5;      // a noise larger by a quarter is none that anybody would correct
  constexpr double kQuietest = -9.0;  // a hundredth of the sigma
  constexpr int kStart = 4;
  constexpr int kCounted = 1000;
  // An error of the state that stays is in both; so much of it does not, as the vehicle turns.
  constexpr double kStateShare = 0.05;
  constexpr double kTrendGain = 0.1;
  // Nearly four times what chance makes of the last twenty or so: the noise is another one, and is learned
  // anew.
  constexpr double kRecentGain = 0.05;
  constexpr double kMore = 0.8;
  constexpr double kLess = 0.2;
  constexpr int kAnew = 25;
  // The trend has a share of the noise of the measurement that is compared with.
  constexpr double kShared = (1.0 + kTrendGain) * (1.0 + kTrendGain);
  const double said = kShared * with.said_variance + said_variance;
  const double of_state =
      std::abs(state_variance - with.state_variance) + kStateShare * (state_variance + with.state_variance);
  const double noise = std::exp(log_square) * said;
  const double expected = noise + of_state;
  if (!std::isfinite(expected)) return;
  const double beside = innovation - with.residual - trend;
  trend += kTrendGain * std::clamp(beside, -3.0 * std::sqrt(expected), 3.0 * std::sqrt(expected));
  const double clipped = std::min(beside * beside / expected, 1.0);
  recent += kRecentGain * (clipped - recent);
  const bool changed = recent > kMore || (recent < kLess && log_square > kLeast);
  count = std::min(count + 1, changed ? kAnew : kCounted);
  const double gain = std::max(kSlowest, 1.0 / (kSlope * (count + kStart)));
  log_square += noise / expected * gain * (clipped / kMean - 1.0);
  log_square = std::clamp(log_square, 0.0, 2.0 * std::log(most));
  const double doubt = std::max(kLeast, kSigmas * kSpread / std::sqrt(static_cast<double>(count)));
  noisy = log_square > (noisy ? 0.5 * kLeast : doubt);
  // (GATE-13): the same from below.
  const double white = std::exp(log_white) * said;
  const double least = white + of_state;
  log_white += white / least * gain * (std::min(beside * beside / least, 1.0) / kMean - 1.0);
  log_white = std::clamp(log_white, kQuietest, 0.0);
  quiet = log_white < -(quiet ? 0.5 * kLeast : doubt);
}

}  // namespace fathom::estimation
