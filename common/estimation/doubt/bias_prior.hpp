#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "base/units.hpp"
#include "estimation/doubt/certainty.hpp"
#include "estimation/filter/error_filter.hpp"
#include "estimation/filter/state_drift.hpp"

namespace fathom::estimation {

/// A bias of an inertial unit is not larger than this: what seems so has another cause.
inline constexpr double kMostAccelBias_m_s2 = 0.05 * kStandardGravity_m_s2;
inline constexpr double kMostGyroBias_rad_s = 1.0 * kRadPerDeg;

/// What would be known of the biases of gyro and accelerometer without a measurement since the start. The
/// filter has learned the rest; where that puts a bias far outside of what is said of it, what is said is
/// wrong, and can be taken back (GATE-11). Else what is missing of the bias goes into tilt, heading and
/// velocity, of which the filter is then far too sure.
class BiasPrior {
 public:
  /// Gyro x, y, z, then accelerometer x, y, z, of B: as kBiasAxes of samples/alignment/help.hpp.
  static constexpr std::size_t kBiases = 6;

  /// A bias that is larger than is said of it.
  struct Wrong {
    std::size_t bias = 0;
    int state = 0;          ///< its index in the filter
    double beyond = 0.0;    ///< the estimate less what was expected
    double variance = 0.0;  ///< that it is said to have from now on
    double share = 0.0;     ///< P grows by this times the square of the bias's column
  };

  explicit BiasPrior(const StateIndex& index);

  /// From a start on: what is estimated is what is said.
  void begin(const FilterState& state, const ErrorFilter& filter);

  // What the filter does, in its order.
  void propagated(const StateDrift& drift, double dt_s, const FilterState& state, const ErrorFilter& filter);
  void widen(int state, double variance);
  /// Something else than a measurement has moved the estimate: that is no evidence.
  void interrupt();

  /// The worst of those that leave no doubt.
  [[nodiscard]] std::optional<Wrong> wrong(const FilterState& state, const ErrorFilter& filter) const;
  /// What was said of it has been taken back.
  void corrected(const Wrong& wrong);
  /// Its index in the filter; -1 where it is not estimated.
  [[nodiscard]] int state_of(std::size_t bias) const { return biases_[bias].state; }
  /// It was larger than is said of it, at least once since the start.
  [[nodiscard]] bool is_found(std::size_t bias) const { return biases_[bias].corrections > 0; }

  /// For archives: see fields/doubt.hpp.
  template <class Archive, class Self>
  static void fields(Archive& archive, Self& self);

 private:
  /// Of the mean of a bias, gradient and curvature of the logarithm of the likelihood.
  struct Evidence {
    double gradient = 0.0;
    double curvature = 0.0;
  };
  /// Evidence by blocks of one length.
  struct Blocks {
    Evidence before{};  ///< as the last block began
    double curvature = 0.0;
    Scatter scatter;

    void end(const Evidence& now, bool whole);
    [[nodiscard]] bool are_enough() const { return scatter.are_enough(curvature); }
    /// How many times as much they scatter about a mean of `found` as they would by chance.
    [[nodiscard]] double scatters(double found) const { return scatter.about(found) / curvature; }
    template <class Archive, class Self>
    static void fields(Archive& archive, Self& self);
  };
  /// Short ones for what is soon found, long ones for what takes some manoeuvres.
  static constexpr std::array<double, 2> kBlocks_s{1.0, 16.0};
  struct Bias {
    int state = -1;  ///< none: it is not estimated
    double mean = 0.0;
    double variance = 0.0;
    std::uint32_t corrections = 0;
    std::array<Blocks, kBlocks_s.size()> blocks{};

    [[nodiscard]] Evidence evidence(const FilterState& state, const ErrorFilter& filter) const;
    template <class Archive, class Self>
    static void fields(Archive& archive, Self& self);
  };

  std::array<Bias, kBiases> biases_{};
  std::array<double, kBlocks_s.size()> block_s_{};  ///< since the last block began
  std::array<bool, kBlocks_s.size()> open_{};       ///< one has begun
};

}  // namespace fathom::estimation
