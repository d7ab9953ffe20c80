#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "base/unknown.hpp"
#include "samples/verdict.hpp"

namespace fathom {

/// How far measurements lay from what was predicted just before, each component in its own predicted sigma.
/// Counts what was used and what was rejected for it. Where sigmas hold, the mean square is one.
class InnovationTally {
 public:
  static constexpr std::size_t kComponents = 6;

  void add(const Verdict& verdict) {
    constexpr double kDeviation95 = 1.959963984540054;
    const bool used = verdict.kind == VerdictKind::used;
    if (!used && verdict.kind != VerdictKind::rejected) return;
    ++measurements_;
    for (std::size_t i = 0; i < verdict.dimensions && i < kComponents; ++i) {
      const double ratio = verdict.innovation[i] / verdict.innovation_sigma[i];
      if (!std::isfinite(ratio)) continue;
      ++all_.count;
      all_.squares += ratio * ratio;
      if (std::abs(ratio) <= kDeviation95) ++within_95_;
      if (!used) continue;
      ++used_.count;
      used_.squares += ratio * ratio;
      ++counts_[i];
      sums_[i] += ratio;
    }
  }

  [[nodiscard]] std::uint64_t measurements() const { return measurements_; }
  [[nodiscard]] std::uint64_t components() const { return all_.count; }
  /// Unknown where there is nothing, as all that follow.
  [[nodiscard]] double mean_square() const { return all_.mean(); }
  [[nodiscard]] double share_within_95() const { return ratio(within_95_, all_.count); }
  /// Root mean square of those that were used.
  [[nodiscard]] double used_rms() const { return std::sqrt(used_.mean()); }
  /// Mean of a component of those that were used.
  [[nodiscard]] double used_mean(std::size_t component) const {
    return ratio(sums_.at(component), counts_.at(component));
  }

 private:
  struct Sum {
    std::uint64_t count = 0;
    double squares = 0.0;
    [[nodiscard]] double mean() const { return ratio(squares, count); }
  };
  template <class Part>
  [[nodiscard]] static double ratio(Part part, std::uint64_t whole) {
    return whole > 0 ? static_cast<double>(part) / static_cast<double>(whole) : kUnknown;
  }

  std::uint64_t measurements_ = 0;
  std::uint64_t within_95_ = 0;
  Sum all_;
  Sum used_;
  std::array<double, kComponents> sums_{};
  std::array<std::uint64_t, kComponents> counts_{};
};

}  // namespace fathom
