#pragma once

#include <array>
#include <cstdint>

#include "estimation/doubt/certainty.hpp"
#include "estimation/doubt/followed.hpp"

namespace fathom::estimation {

/// Whether a measurement that agrees with the estimate may say that its start was wrong. A velocity over
/// ground along the vehicle's axes does not see which way they point: a wrong heading shows in it by the
/// Earth's rate alone, which errors of gyros and accelerometers look like.
enum class ShowsStart : std::uint8_t { no, yes };

/// The heading of the start may have been wrong by more than its sigma says: a compass beside the steel of a
/// ship, a number that was mistyped. By a likelihood ratio over all innovations since then this is told from
/// noise (GATE-9): how an error of one radian at the start has become one of now is carried along with the
/// filter, as a column of errors. Costs next to nothing once the start does not matter any more.
class StartHeading {
 public:
  using Column = FollowedErrors<1>;

  /// From a start on, which would be wrong by `column` per radian.
  void begin(const Column& column) {
    *this = {};
    column_ = column;
    open_ = true;
  }
  /// Nothing is looked for any more. What was found stays known.
  void end() {
    const double found_rad = found_rad_;
    *this = {};
    found_rad_ = found_rad;
  }
  /// By so much it was taken to be wrong, altogether: heading of the start less the true one. 0: not at all.
  [[nodiscard]] double found_rad() const { return found_rad_; }

  // What the filter does, in its order. `turn_rad_s`: about down, by then.
  void propagated(const NavTransition& transition, const ProcessNoise& noise);
  void updated(const Observation& observation, const InnovationStatistics& statistics,
               const ErrorFilter& filter, double turn_rad_s, ShowsStart shows = ShowsStart::yes);
  /// A measurement was not taken in. `statistics` with the noise that it says it has.
  void refused(const Observation& observation, const InnovationStatistics& statistics,
               const ErrorFilter& filter, double turn_rad_s);
  void carried(const Carry& carry);
  /// P has grown by `share` times the square of `column`, that of a state whose prior was wrong (GATE-11):
  /// what was seen until now was seen with that.
  void shifted(const Column& column, double share, std::size_t state);
  void forgot(std::size_t state) { column_[state] = 0.0; }

  [[nodiscard]] bool is_open() const { return open_; }
  /// The error at the start that the innovations speak for, rad, and its variance.
  [[nodiscard]] double error_rad() const { return gradient_ / curvature_; }
  [[nodiscard]] double variance_rad2() const;
  /// They leave no doubt that there was one.
  [[nodiscard]] bool is_wrong() const;
  /// The error has been taken out; the innovations from here on may say that it was more.
  void corrected();
  [[nodiscard]] const Column& column() const { return column_; }

  /// For archives: see fields/doubt.hpp.
  template <class Archive, class Self>
  static void fields(Archive& archive, Self& self);

 private:
  void forget_evidence();
  void add(const Evidence<1>& evidence, const InnovationStatistics& statistics, const ErrorFilter& filter,
           double turn_rad_s);

  bool open_ = false;
  std::uint32_t corrections_ = 0;
  double found_rad_ = 0.0;
  double gradient_ = 0.0;             ///< of the logarithm of the likelihood by the error, at none
  double curvature_ = 0.0;            ///< and how fast that falls
  std::array<double, 2> together_{};  ///< gradient and curvature of the last measurements
  double together_s_ = 0.0;
  Scatter scatter_;           ///< of those that were taken together
  Considered<1> considered_;  ///< in the gradient
  Column column_{};
};

}  // namespace fathom::estimation
