#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "base/unknown.hpp"
#include "estimation/filter/observation.hpp"
#include "samples/header.hpp"

namespace fathom::estimation {

/// The noise of an instrument as its innovations show it (GATE-10): by how much it scatters from one
/// measurement to the next beyond what it is said to. What is wrong for longer than that, of the instrument
/// or of the estimate, is no noise and does not count; nor do a few wild ones among many. It is never less
/// than what is said.
class AdaptiveNoise {
 public:
  /// Multiplies the sigma of each row by its factor.
  void widen(Observation& rows) const {
    for (std::size_t i = 0; i < static_cast<std::size_t>(rows.rows); ++i)
      rows.sigma[i] *= factor(rows.component[i]);
  }
  /// Of the sigma that the component is said to have; 1 as long as it may have that.
  [[nodiscard]] double factor(std::size_t component) const {
    const Component& one = components_[component];
    return one.noisy ? std::exp(0.5 * one.log_square) : 1.0;
  }
  /// Of the variance that the component is said to have, the share by which it scatters from one measurement
  /// to the next; 1 as long as it may be all of it. The rest is no noise.
  [[nodiscard]] double white_share(std::size_t component) const {
    const Component& one = components_[component];
    return one.quiet ? std::exp(one.log_white) : 1.0;
  }
  /// What of it is no noise has been taken for something else: is it noise now?
  void expect_noise(std::size_t component) {
    components_[component].log_white = 0.0;
    components_[component].quiet = false;
  }
  /// The largest of all components.
  [[nodiscard]] double largest_factor() const {
    double out = 1.0;
    for (std::size_t i = 0; i < components_.size(); ++i) out = std::max(out, factor(i));
    return out;
  }

  /// What became of a measurement.
  struct Judged {
    TimeNs now_ns = 0;
    bool used = false;
    const Observation& rows;  ///< as widen() left them
    /// Of each row, before it was taken in.
    const std::array<double, Observation::kMaxRows>& innovation_sigma;
    const std::array<double, kMaxStates>& moved;  ///< the error that was taken out of the state
    double most = 1.0;                            ///< bound of the factor
  };
  void note(const Judged& judged);

  /// Visits each instant that is remembered.
  template <class Self, class Visit>
  static void for_each_instant(Self& self, Visit&& visit) {
    visit(self.last_ns_);
    visit(self.used_ns_);
  }
  /// For archives: see fields/doubt.hpp.
  template <class Archive, class Self>
  static void fields(Archive& archive, Self& self);

 private:
  /// What an earlier measurement left of one component.
  struct Left {
    double residual = kUnknown;   ///< its innovation with the state put right; unknown: it had none
    double state_variance = 0.0;  ///< of that, what comes from the state
    double said_variance = 0.0;   ///< and what is said of the noise

    template <class Archive, class Self>
    static void fields(Archive& archive, Self& self);
  };
  struct Component {
    Left last;  ///< whatever became of it
    Left used;
    // What has been learned.
    double trend = 0.0;       ///< mean of the differences: a motion that is wrong, and no noise
    double log_square = 0.0;  ///< of the factor, as far as it is known
    int count = 0;            ///< of comparisons; the estimate gets slower with them, down to a limit
    double recent = 0.5;      ///< mean of the last comparisons: far off, the noise has changed
    bool noisy = false;       ///< so many cannot be wrong
    double log_white = 0.0;   ///< of the share that scatters, where that is less than what is said
    bool quiet = false;       ///< likewise

    void compare(double innovation, double state_variance, double said_variance, const Left& with,
                 double most);
    template <class Archive, class Self>
    static void fields(Archive& archive, Self& self);
  };

  TimeNs last_ns_ = 0;
  TimeNs used_ns_ = 0;
  std::array<Component, Observation::kMaxRows> components_{};
};

}  // namespace fathom::estimation
