#pragma once

#include "estimation/navigator/navigator.hpp"
#include "samples/imu.hpp"

namespace fathom::estimation {

/// Turns inertial samples into steps and keeps the time axis straight. Samples that are not finite, out of
/// range, repeated, older than the newest or absurdly far ahead are refused and change nothing. Only when ten
/// refused stamps in a row make a sound time axis of their own, as after a restart or clock step of the
/// instrument, does that axis become the valid one.
class ImuPreprocessor {
 public:
  enum class Outcome : std::uint8_t {
    first,    ///< nothing to integrate yet
    step,     ///< `step` is filled
    rebased,  ///< the time axis changed; nothing to integrate
    refused,  ///< `refusal` says why
  };
  struct Result {
    Outcome outcome = Outcome::refused;
    VerdictKind refusal = VerdictKind::out_of_range;
    double unobserved_s = 0.0;  ///< rebased: how long nothing was measured
    ImuStep step;
  };

  explicit ImuPreprocessor(const Setup& setup) : setup_(&setup) {}
  [[nodiscard]] Result take(const ImuSample& sample);
  /// The newest sample that was taken, 0 before the first.
  [[nodiscard]] TimeNs newest_ns() const { return last_ns_; }
  /// For archives: see fields/imu_preprocessor.hpp.
  template <class Archive, class Self>
  static void fields(Archive& archive, Self& self);

 private:
  static constexpr int kNewAxis = 10;  ///< refused stamps in a row that make an axis

  /// Mean rate and force of a sample along B; false when it is not usable.
  bool read(const ImuSample& sample);
  /// The stretch of an interval that its increments do not cover. Negative: as much was filled in before and
  /// proves to be theirs.
  [[nodiscard]] double stretch_to_fill_s(double dt_s);

  const Setup* setup_;
  bool started_ = false;
  TimeNs last_ns_ = 0;
  TimeNs last_received_ns_ = 0;
  Eigen::Vector3d rate_ = Eigen::Vector3d::Zero();  ///< of the sample being read
  Eigen::Vector3d force_ = Eigen::Vector3d::Zero();
  double covered_s_ = 0.0;  ///< the increments' own interval, 0 for rates
  Eigen::Vector3d last_rate_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d last_force_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d mean_rate_before_ = Eigen::Vector3d::Zero();  ///< over the last interval
  Eigen::Vector3d mean_force_before_ = Eigen::Vector3d::Zero();
  bool has_before_ = false;
  // Of increments: by how much the stamps are ahead of what they and the filled stretches cover, which fades,
  // and how long those stretches are together.
  double uncovered_s_ = 0.0;
  double filled_s_ = 0.0;
  ImuFault fault_ = ImuFault::none;  ///< since the last sample that was taken
  TimeNs refused_ns_ = 0;
  int refused_in_a_row_ = 0;
};

}  // namespace fathom::estimation
