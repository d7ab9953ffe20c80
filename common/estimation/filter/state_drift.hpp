#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <span>

#include "estimation/filter/state_index.hpp"

namespace fathom::estimation {

/// How the states from index 9 on move by themselves, each for itself: random walk and first-order decay.
class StateDrift {
 public:
  StateDrift() = default;
  /// By state: walk in unit^2/s; decay 1/time constant, 0 for a constant or walk.
  StateDrift(const std::array<double, kMaxStates>& walk, const std::array<double, kMaxStates>& decay_per_s,
             int states)
      : walk_(walk), decay_per_s_(decay_per_s) {
    for (int i = kNavStates; i < states; ++i) {
      const auto at = static_cast<std::size_t>(i);
      if (decay_per_s[at] > 0.0)
        decaying_[static_cast<std::size_t>(decaying_count_++)] = static_cast<std::uint8_t>(i);
      if (walk[at] > 0.0) walking_[static_cast<std::size_t>(walking_count_++)] = static_cast<std::uint8_t>(i);
    }
  }

  [[nodiscard]] std::span<const std::uint8_t> decaying() const {
    return std::span(decaying_).first(static_cast<std::size_t>(decaying_count_));
  }
  [[nodiscard]] std::span<const std::uint8_t> walking() const {
    return std::span(walking_).first(static_cast<std::size_t>(walking_count_));
  }
  [[nodiscard]] double walk(int state) const { return walk_[static_cast<std::size_t>(state)]; }
  [[nodiscard]] double decay_per_s(int state) const { return decay_per_s_[static_cast<std::size_t>(state)]; }
  /// What is left of the state after dt_s: exp(-decay dt).
  [[nodiscard]] double kept(int state, double dt_s) const {
    const double x = decay_per_s(state) * dt_s;
    if (x > 1e-3) return std::exp(-x);
    // Exact to rounding, and most steps are this short beside the time constant.
    return 1.0 - x * (1.0 - x * (1.0 / 2.0) * (1.0 - x * (1.0 / 3.0) * (1.0 - x * (1.0 / 4.0))));
  }

 private:
  std::array<double, kMaxStates> walk_{};
  std::array<double, kMaxStates> decay_per_s_{};
  std::array<std::uint8_t, kMaxStates> decaying_{};
  std::array<std::uint8_t, kMaxStates> walking_{};
  int decaying_count_ = 0;
  int walking_count_ = 0;
};

}  // namespace fathom::estimation
