#pragma once

#include <array>
#include <string_view>
#include <vector>

#include "samples/alignment_status.hpp"
#include "samples/kinds.hpp"

namespace fathom {

/// Conditions of this kind name an instrument that cannot be right; `value` is the factor, angle (rad) or
/// rate (Hz) that would make it right, and the status's advice says how.
inline constexpr std::string_view kImplausiblePrefix = "implausible_";
[[nodiscard]] bool is_implausible(const AlignmentCondition& condition);
/// The first of them in a status; nullptr when all is plausible.
[[nodiscard]] const AlignmentCondition* implausible(const AlignmentStatus& status);

/// This condition says by how much the heading of the start was wrong, and that it was corrected (rad):
/// always met, and absent where nothing was found.
inline constexpr std::string_view kStartHeadingError = "start_heading_error_rad";
/// 0 where nothing was found.
[[nodiscard]] double start_heading_error_rad(const AlignmentStatus& status);

/// A condition of this kind says how many times as much an instrument scatters as is said of it, which
/// navigation counts with; its name goes on with the sensor's, as far as there is room. Always met, and
/// absent where it does as is said.
inline constexpr std::string_view kNoiseFactorPrefix = "noise_of_";
/// Parts of the inertial unit whose noise is seen by how far the motion strays; instead of a sensor.
inline constexpr std::array<std::string_view, 2> kInertialNoise{"accelerometers", "gyros"};
[[nodiscard]] constexpr bool is_inertial(std::string_view sensor) {
  return sensor == kInertialNoise[0] || sensor == kInertialNoise[1];
}
struct NoiseFactor {
  std::string_view sensor;  ///< or one of kInertialNoise
  double factor = 1.0;
};
/// All of a status. The names are its own.
[[nodiscard]] std::vector<NoiseFactor> noise_factors(const AlignmentStatus& status);

/// A condition of this kind says that a bias of the inertial unit is larger than is said of it, and that
/// navigation counts with that: `value` the bias and `limit` the sigma that is configured, rad/s or m/s^2.
/// Its name goes on with the axis. Always met, and absent where a bias is as is said.
inline constexpr std::string_view kBiasPrefix = "bias_of_";
/// Of B.
inline constexpr std::array<std::string_view, 6> kBiasAxes{
    "gyro_x", "gyro_y", "gyro_z", "accelerometer_x", "accelerometer_y", "accelerometer_z"};
struct FoundBias {
  std::string_view axis;  ///< one of kBiasAxes
  double value = 0.0;
  double said_sigma = 0.0;

  [[nodiscard]] std::string_view unit() const;  ///< "deg/h" or "mg", as data sheets have it
  [[nodiscard]] double in_unit(double si) const;
  /// "bias of gyro x is 21.3 deg/h, and a sigma of 1 deg/h is configured", zero-terminated.
  [[nodiscard]] std::array<char, 96> text() const;
};
/// All of a status.
[[nodiscard]] std::vector<FoundBias> found_biases(const AlignmentStatus& status);

/// A condition of this kind says that the fixes of GPS or USBL are off slowly by more than is configured, and
/// that navigation counts with that: `value` the sigma, `limit` the one that is configured, m, of the worse
/// of north and east. Its name goes on with the kind. Always met, and absent where it is as configured.
inline constexpr std::string_view kSlowErrorPrefix = "slow_error_of_";
struct SlowFixes {
  std::string_view kind;
  double sigma_m = 0.0;
  double configured_m = 0.0;
};
/// All of a status. The kinds are its own.
[[nodiscard]] std::vector<SlowFixes> slow_fixes(const AlignmentStatus& status);

/// Which instrument is meant and in what it is wrong: "unit", "sign", "axes", "rate" or "mounting", as
/// findings of commissioning are named.
struct Blame {
  SourceKind source = SourceKind::imu;
  std::string_view kind;
};
/// Of a condition that is implausible; without a kind for one that is not known.
[[nodiscard]] Blame blame_of(const AlignmentCondition& condition);

/// What brings a condition about, as a part of a sentence: "hold still, away from waves". Empty for a name
/// that is not known.
[[nodiscard]] std::string_view help_of(const AlignmentCondition& condition);

}  // namespace fathom
