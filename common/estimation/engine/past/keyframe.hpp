#pragma once

#include <array>
#include <cstdint>

#include "estimation/filter/passage.hpp"

namespace fathom::estimation {

/// A point of the way, as the velocity has it.
struct Knot {
  TimeNs now_ns = 0;
  Eigen::Vector3d travelled_N_m = Eigen::Vector3d::Zero();  ///< integral of the velocity
  Eigen::Vector3d v_N_m_s = Eigen::Vector3d::Zero();
  geo::Quaternion q_NB;
};

/// Points of the way from one keyframe to the next, without both ends.
struct Track {
  static constexpr std::size_t kKnots = 15;
  std::array<Knot, kKnots> knots{};
  std::uint32_t count = 0;
};

/// The error states that a fix sees: position, attitude (its lever), altitude of the surface (its depth).
inline constexpr int kFixStates = 7;
/// Rows that a fix has at most: north, east, down.
inline constexpr int kFixRows = 3;

/// A late fix that was used: it sees a sum of the errors of two keyframes that follow each other (LATE-3).
struct LateFix {
  std::uint64_t after = 0;  ///< number of the first of the two
  double share = 0.0;       ///< of the second of them
  int rows = 0;
  std::array<std::array<double, kFixStates>, kFixRows> h{};
  std::array<double, kFixRows> sigma{};
  std::array<double, kFixRows> innovation{};  ///< against all that was known when it acted
};

/// The filter at an instant, and what it did from there to the next keyframe.
struct Keyframe {
  explicit Keyframe(int states = 0) : onward(states) {}

  Knot here;
  geo::Geodetic position;
  std::array<double, kMaxStates> x{};
  /// Rows of P: of the states that a fix sees.
  std::array<std::array<double, kMaxStates>, kFixStates> p{};
  bool acted = false;  ///< a late fix did, at this instant, behind all that is said above
  LateFix fix;
  Track track;
  Passage onward;
};

/// The way of a filter since its newest keyframe. A part of the state of a navigator, and copied with it.
struct Leg {
  explicit Leg(int states = 0) : passage(states) {}

  std::uint64_t count = 0;   ///< of keyframes that were made; the newest has the number below
  std::uint64_t oldest = 0;  ///< number of the first from which a way leads to the present
  TimeNs begun_ns = 0;       ///< instant of the newest keyframe
  TimeNs knot_ns = 0;        ///< of the newest knot, or of that
  Track track;
  Passage passage;

  [[nodiscard]] bool under_way() const { return count > oldest; }
};

}  // namespace fathom::estimation
