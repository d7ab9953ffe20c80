#pragma once

#include <optional>

#include "estimation/alignment/drop_alignment.hpp"
#include "estimation/navigator/estimate.hpp"
#include "estimation/navigator/measurement.hpp"
#include "estimation/navigator/start/alignment_watch.hpp"

namespace fathom::estimation {

/// In-motion alignment after a drop. While it lasts, the attitude is that of
/// DropAlignment, and position and velocity are what the specific force has
/// made of the release since; then the filter takes over.
class Descent {
 public:
  Descent() = default;
  Descent(const Descent& other) { *this = other; }
  /// A copy costs little where nothing was ever released.
  Descent& operator=(const Descent& other) {
    if (this == &other) return *this;
    if (fall_.released || other.fall_.released) drop_ = other.drop_;
    fall_ = other.fall_;
    return *this;
  }
  ~Descent() = default;

  /// From an aircraft; what is lost after that is found again by whatever there
  /// is.
  [[nodiscard]] bool released() const { return fall_.released; }
  /// Roll and pitch are still those of the in-motion alignment.
  [[nodiscard]] bool aligning() const { return fall_.aligning; }
  [[nodiscard]] const DropAlignment& alignment() const { return drop_; }
  /// Sigmas of roll, pitch and yaw: of the alignment while it lasts, else of
  /// the filter.
  [[nodiscard]] Eigen::Vector3d rpy_sigma_rad(const Setup& setup, const Estimate& estimate) const {
    return fall_.aligning ? drop_.rpy_sigma_rad() : estimation::rpy_sigma_rad(setup, estimate);
  }

  /// The release, of which the estimate is `initial`.
  void start(const Setup& setup, const InitialState& initial, const Estimate& estimate,
             AlignmentWatch& alignment);
  /// Tilt is found again under way; heading, velocity and position are carried
  /// on, over `unobserved_s` without inertial samples as they were, and so is
  /// what the attitude until now has made uncertain of them.
  void restart(const Setup& setup, double tilt_sigma_rad, double unobserved_s, const Estimate& estimate,
               AlignmentWatch& alignment);
  /// (ALN-19) After a gap in which the attitude was lost; false where the
  /// heading is lost with it.
  [[nodiscard]] bool resume(const Setup& setup, double gap_s, Estimate& estimate, AlignmentWatch& alignment);
  /// The attitude is lost for good.
  void give_up() { fall_.aligning = false; }

  void widen(const Setup& setup, const GapSigma& sigma);
  void advance(const Setup& setup, const ImuStep& step, Estimate& estimate, AlignmentWatch& alignment);
  /// What the alignment says to a measurement; none when it has no use for it.
  [[nodiscard]] std::optional<Judgement> feed(const Setup& setup, const Measurement& measurement,
                                              Estimate& estimate);
  /// The position was set from outside along the first `axes` of N.
  void place(const Setup& setup, int axes, double sigma_m);

  /// For archives: see fields/navigator.hpp.
  template <class Archive, class Self>
  static void fields(Archive& archive, Self& self, const Setup& setup);

 private:
  void begin(const DropConfig& config, const Estimate& estimate, AlignmentWatch& alignment);
  /// (ALN-16) The attitude was turned: what was integrated with it turns along.
  void turn(const Eigen::Vector3d& rotation_N_rad, Estimate& estimate);
  void carry_covariance(const Setup& setup);
  /// What an attitude error does to position and velocity, once they have been carried on for `further_s`.
  [[nodiscard]] Eigen::Matrix<double, 6, 3> arm(double further_s = 0.0) const;
  /// (ALN-17)
  void hand_over(const Setup& setup, Estimate& estimate, AlignmentWatch& alignment);

  /// What is remembered beside the alignment itself.
  struct Fall {
    bool released = false;
    bool aligning = false;
    bool regained = false;  ///< begun anew after a loss: the velocity is then
                            ///< that through the water
    // Since the release: integrals of C f, once and twice; covariance of
    // position and velocity as if the attitude were known, at the instant
    // given.
    Eigen::Vector3d dv_N = Eigen::Vector3d::Zero();
    Eigen::Vector3d dp_N = Eigen::Vector3d::Zero();
    Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
    double s = 0.0;
    double carried_s = 0.0;
  };
  Fall fall_;
  DropAlignment drop_;  ///< as constructed before a release
};

}  // namespace fathom::estimation
