#pragma once

// What codecs of satellite receivers share, alone or inside inertial units.

#include <cmath>
#include <numbers>
#include <optional>

#include "base/units.hpp"
#include "base/unknown.hpp"
#include "codec/codec.hpp"

namespace fathom::codec {

// Beyond every receiver.
inline constexpr double kMostHeight_m = 1e5;
inline constexpr double kMostVelocity_m_s = 1e4;
inline constexpr double kMostAccuracy = 1e9;  ///< of anything; some say "no idea" with a large number

/// Numbers of a message, and the first reason to refuse it.
class NumberCheck {
 public:
  /// The number as it is; unknown where the message does not call it valid.
  double take(bool valid, double value, double least, double most) {
    if (!valid) return kUnknown;
    if (!reason_ && !std::isfinite(value)) reason_ = RejectReason::field;
    if (!reason_ && (value < least || value > most)) reason_ = RejectReason::out_of_range;
    return value;
  }
  /// A standard deviation; 0 is none.
  double take_sigma(bool valid, double value) {
    const double sigma = take(valid, value, 0.0, kMostAccuracy);
    return sigma == 0.0 ? kUnknown : sigma;
  }
  [[nodiscard]] const std::optional<RejectReason>& reason() const { return reason_; }

 private:
  std::optional<RejectReason> reason_;
};

/// From degrees of 0 to 360; a whole turn is none.
[[nodiscard]] inline double heading_of(double heading_deg) {
  return heading_deg == 360.0 ? 0.0 : kRadPerDeg * heading_deg;
}
/// An angle of -2 pi to 2 pi as one of 0 to 2 pi.
[[nodiscard]] inline double as_course(double angle_rad) {
  return angle_rad < 0.0 ? angle_rad + 2.0 * std::numbers::pi : angle_rad;
}

}  // namespace fathom::codec
