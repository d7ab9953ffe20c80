#pragma once

#include <optional>

#include <Eigen/Core>

#include "base/units.hpp"
#include "commission/assumed.hpp"
#include "commission/fit/dvl_fit.hpp"

namespace fathom::commission {

/// What the windows of a log tell of the DVL.
struct DvlFound {
  /// How far what the log tells goes of the turn about the way that the vehicle goes.
  enum class AboutTheWay {
    told,
    but_for_half_a_turn,  ///< with the lever on the other side it explains the log as well
    untold,               ///< a quarter of a turn does, too
  };
  DvlFigures fit;
  bool mirrored = false;
  bool mirror_told = false;
  AboutTheWay about_the_way = AboutTheWay::told;
  Eigen::Vector3d way_D =
      Eigen::Vector3d::UnitX();  ///< where most of the velocity is, in the axes of the DVL
  // Of those mountings that explain the log as well, at most.
  Eigen::Vector3d turn_apart_rad = Eigen::Vector3d::Zero();  ///< from `fit`, about the axes of the DVL
  Eigen::Vector3d lever_apart_m = Eigen::Vector3d::Zero();
  double latency_apart_s = 0.0;
};
/// What is configured is kept unless the log refutes it. The mountings that a turn about the way makes of
/// what is kept are held against it, each with a lever, a latency and a scale of its own: those that are
/// refuted are told apart. From windows as long as serves them best: longer ones hold more motion and more of
/// the drift of the gyro.
[[nodiscard]] DvlFound find_dvl(const Series& series, const Assumed& assumed, const ImuReading& reading,
                                double latency_s);

/// Sigmas of the turn about the axes of the DVL, with what is apart.
[[nodiscard]] Eigen::Vector3d turn_sigma_rad(const DvlFound& found);

/// The mounting that may be written. Turns that the log does not tell are as configured, where what it does
/// tell is next to that. Else the log refutes what is configured, which then says nothing of those turns
/// either: it is as found where the log tells it from the next of the 24 mountings of a box, and not at all
/// where not.
[[nodiscard]] std::optional<Eigen::Matrix3d> mounting_found(const DvlFound& found,
                                                            const Eigen::Matrix3d& configured_C_BD);

inline constexpr double kToldTurn_rad = 2.0 * kRadPerDeg;

}  // namespace fathom::commission
