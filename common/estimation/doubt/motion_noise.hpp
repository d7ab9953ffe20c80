#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "estimation/doubt/followed.hpp"

namespace fathom::estimation {

/// The noise of the inertial unit as the measurements show it (GATE-12): how far the motion strays from one
/// block of some seconds to the next beyond what white noise of the accelerometers and gyros makes of it. One
/// factor for the accelerometers, of velocity, and one for the gyros, of attitude. Neither is below one.
class MotionNoise {
 public:
  static constexpr std::size_t kAccelerometers = 0;
  static constexpr std::size_t kGyros = 1;
  static constexpr std::size_t kKinds = 2;

  explicit MotionNoise(int estimated = 0) : estimated_(estimated) { interrupt(); }

  /// Of the sigma that the noise is said to have.
  [[nodiscard]] double factor(std::size_t kind) const { return std::sqrt(kinds_[kind].square); }
  /// Adds to `noise` what the unit scatters by beyond `said`: m^2/s^3 and rad^2/s.
  void widen(const std::array<double, kKinds>& said, ProcessNoise& noise) const;

  // What the filter does, in its order.
  /// `said` as above; `most`: bound of the factors.
  void propagated(const NavTransition& step, const ProcessNoise& noise,
                  const std::array<double, kKinds>& said, double most);
  void updated(const Observation& observation, const InnovationStatistics& statistics,
               const ErrorFilter& filter);
  void carried(const Carry& carry);
  /// Something else than noise has moved the estimate or its covariance: the block begins anew.
  void interrupt();
  /// A new start: nothing is known of the noise.
  void begin() { *this = MotionNoise(estimated_); }

  /// For archives: see fields/doubt.hpp.
  template <class Archive, class Self>
  static void fields(Archive& archive, Self& self);

 private:
  static constexpr std::size_t kAxes = 3;
  /// Errors that a block may begin with: velocity, then attitude, along N.
  static constexpr std::size_t kErrors = kKinds * kAxes;
  static constexpr std::size_t kFirst = 3;  ///< of them, as a state

  struct Kind {
    double square = 1.0;      ///< of the factor
    double log_ratio = 0.0;   ///< of what the blocks show to what is expected of them
    double share = 0.0;       ///< mean of what the noise that is said has of what a block would show
    std::uint32_t count = 0;  ///< of figures since the factor is what it is

    void add(double ratio, double share_of_said);
    /// By how many sigmas the figures speak for another factor: of a larger one, or of a smaller one where it
    /// is more than one.
    [[nodiscard]] double sigmas() const;
    void forget() {
      log_ratio = share = 0.0;
      count = 0;
    }
    /// The figures leave no doubt that it is another one.
    [[nodiscard]] bool is_wrong() const;
    /// They will, if they go on so.
    [[nodiscard]] bool may_be() const;
    void correct(double most);
    template <class Archive, class Self>
    static void fields(Archive& archive, Self& self);
  };

  /// A block, and for each axis gradient and curvature of the logarithm of the likelihood by the error that
  /// it begins with.
  struct Block {
    double age_s = 0.0;
    std::array<double, kAxes> gradient{};
    std::array<double, kAxes> curvature{};
    Considered<kAxes> considered;  ///< in each gradient

    /// Of the gradient of an axis, where the noise is as is said.
    [[nodiscard]] double variance(std::size_t axis) const {
      return considered.variance(axis, curvature[axis]);
    }
    template <class Archive, class Self>
    static void fields(Archive& archive, Self& self);
  };
  /// Longer than a measurement lasts, and for as long as it takes until noise shows: a tilt takes longer.
  static constexpr std::array<double, kKinds> kBlock_s{2.0, 8.0};
  /// And by velocities of GPS alone a velocity takes longer, too.
  static constexpr std::array<double, kKinds> kLongestBlock_s{8.0, 8.0};

  void begin_block(std::size_t kind);
  /// The noise that is said has its share of what the block would show of an axis.
  [[nodiscard]] double share(std::size_t kind, std::size_t axis, double said) const;
  [[nodiscard]] bool is_over(std::size_t kind, double said) const;
  void end_block(std::size_t kind, double said);
  void judge(double most);

  int estimated_;
  FollowedErrors<kErrors> now_{};  ///< what has become of each error
  std::array<Block, kKinds> blocks_{};
  std::array<Kind, kKinds> kinds_{};
};

}  // namespace fathom::estimation
