#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>

#include "base/unknown.hpp"

namespace fathom::estimation {

/// A complete horizontal position that navigation may live on.
enum class Fix : std::uint8_t { none, satellite, acoustic };

/// What a velocity is relative to.
enum class VelocityOver : std::uint8_t { none, ground, medium };

/// What a measurement means beyond its rows: which of the navigator's rules hold for it. Each aiding model
/// says it beside its rows, so that no rule has to know the kinds of instrument.
struct AidingPolicy {
  /// Its first rows are those of a horizontal position.
  bool position = false;
  /// Navigation that used it has a position; a part of one (a range, a depth) is none.
  Fix fix = Fix::none;
  /// A person or a modem told the position, perhaps minutes after it was taken: it comes alone.
  bool told = false;
  /// The position is one that is refused or believed by how it agrees with the motion (GATE-4).
  bool follows_motion = false;
  /// Navigation that used it has a velocity.
  VelocityOver velocity = VelocityOver::none;
  /// The velocity is that of a Doppler log, whose outage is published.
  bool doppler = false;
  /// A velocity that goes wrong by a level that is wrong: room for it is room for the tilt (GATE-3).
  bool shows_level = false;
  /// Its rows tell of the heading alone, however they look when the vehicle is pitched (GATE-3).
  bool heading_alone = false;
  /// A frozen instrument shows itself by the path that was travelled meanwhile; else by its own innovation.
  bool frozen_by_path = false;
  /// No live instrument repeats a reading to the last bit while the vehicle travels so far.
  double frozen_path_m = std::numeric_limits<double>::infinity();
  /// What a frozen instrument would keep repeating; unknown where the sample has nothing to say.
  std::array<double, 3> reading{kUnknown, kUnknown, kUnknown};

  /// Of all models that took rows from one sample.
  void merge(const AidingPolicy& other);
};

inline void AidingPolicy::merge(const AidingPolicy& other) {
  position = position || other.position;
  if (other.fix != Fix::none) fix = other.fix;
  told = told || other.told;
  follows_motion = follows_motion || other.follows_motion;
  if (other.velocity != VelocityOver::none) velocity = other.velocity;
  doppler = doppler || other.doppler;
  shows_level = shows_level || other.shows_level;
  heading_alone = heading_alone || other.heading_alone;
  frozen_by_path = frozen_by_path || other.frozen_by_path;
  frozen_path_m = std::min(frozen_path_m, other.frozen_path_m);
}

}  // namespace fathom::estimation
