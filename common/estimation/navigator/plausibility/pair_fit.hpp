#pragma once

#include <Eigen/Core>

namespace fathom::estimation {

/// The mean of `count` squares of standard normal figures that is exceeded as seldom as one figure exceeds
/// `sigmas`, by Wilson and Hilferty.
[[nodiscard]] double chi_square_mean(double count, double sigmas);
inline constexpr double kRefutedSigmas = 4.75;  ///< once in a million
inline constexpr double kAgreesSigmas = 2.75;   ///< once in three hundred
/// What was longer ago than some hundred pairs is forgotten: an instrument may have been put right.
inline constexpr double kPairsKept = 0.99;
inline constexpr double kFewestPairs = 4.0;
/// Of the noise: what does not stand out of it says nothing.
inline constexpr double kPairStandsOut = 4.0;

/// What is asked of another hypothesis beside that the configured one is refuted (PLAUS-1).
struct Proof {
  double fewest;     ///< components
  double most_left;  ///< the share of the misfit that it may leave
  double claim;      ///< the log likelihood ratio that it has to exceed
  /// An instrument is said to be wrong, as against relied on or not.
  [[nodiscard]] bool accuses() const { return claim > 0.0; }
};

/// Log of the likelihood of another hypothesis over that of the configured one, where the scatter is not
/// known better than that it is no less than expected (PLAUS-1). Zero unless the configured one is refuted
/// and the other one leaves no more than `most_left` of it. The squares that are expected, and left by either
/// hypothesis, are sums over so many components.
[[nodiscard]] double evidence_for_other(double components, double expected, double configured, double other,
                                        double most_left);

/// Sums over pairs of figures in the plane that should be the same, fading: what each hypothesis `b = M a`
/// leaves over. A value of fixed size; figures of one dimension stand in the first.
class PairFit {
 public:
  /// Of b - a where all is as configured, each component: `noise`, and `share` of their length for what is
  /// not modelled. A pair that does not stand out of the noise says nothing and is left out.
  void add(const Eigen::Vector2d& a, const Eigen::Vector2d& b, double noise, double share);
  /// Of figures in one dimension.
  void add(double a, double b, double noise, double share);
  void reset() { *this = PairFit(); }

  /// Sum of |b - M a|^2.
  [[nodiscard]] double left_over(const Eigen::Matrix2d& M) const;
  /// The angle by which a has to be turned into b (from the first axis to the second), rad.
  [[nodiscard]] double turn_rad() const;
  /// Of `M` over the identity: see evidence_for_other().
  [[nodiscard]] double evidence(const Eigen::Matrix2d& M, const Proof& proof) const {
    return evidence_of(left_over(M), proof);
  }
  [[nodiscard]] double evidence(double factor, const Proof& proof) const {
    return evidence_of(left_over(factor * Eigen::Matrix2d::Identity()), proof);
  }
  /// The same with what another hypothesis leaves over of the same pairs.
  [[nodiscard]] double evidence_of(double left_over, const Proof& proof) const;
  /// `b = factor a` is a thousand times as likely as figures that have nothing to do with one another, the
  /// scatter not known as in evidence_for_other().
  [[nodiscard]] bool is_related(double factor) const;
  /// b stands out of its noise by itself, so that it would show what it is related to.
  [[nodiscard]] bool moves() const;
  /// Enough was added, and it is as expected: only then can the figures speak against a third one.
  [[nodiscard]] bool agrees() const;
  /// What is configured is refuted, by however few.
  [[nodiscard]] bool refutes() const;
  [[nodiscard]] bool is_empty() const { return count_ <= 0.0; }

  /// For archives: see fields/plausibility.hpp.
  template <class Archive, class Self>
  static void fields(Archive& archive, Self& self);

 private:
  void add(const Eigen::Vector2d& a, const Eigen::Vector2d& b, double components, double noise, double share);

  double count_ = 0.0;                            ///< of components
  double expected_ = 0.0;                         ///< sum of sigma^2
  Eigen::Matrix2d aa_ = Eigen::Matrix2d::Zero();  ///< sum of a a'
  Eigen::Matrix2d ba_ = Eigen::Matrix2d::Zero();  ///< sum of b a'
  double bb_ = 0.0;                               ///< sum of |b|^2
};

}  // namespace fathom::estimation
