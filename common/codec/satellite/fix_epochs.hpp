#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>

#include "base/device_time.hpp"
#include "base/unknown.hpp"
#include "samples/gps.hpp"

namespace fathom::codec {

/// What a receiver says of velocity in a frame of its own; unknown where there is no solution.
struct EpochVelocity {
  std::uint32_t time_of_week_ms = 0;
  std::array<double, 3> velocity_N_m_s{kUnknown, kUnknown, kUnknown};
  std::array<double, 3> sigma_N_m_s{kUnknown, kUnknown, kUnknown};
  double course_rad = kUnknown;
};

/// Joins position and velocity of one receiver, which come in two frames of the same time of the week.
///
/// A position whose velocity came before it is delivered with it. Whether one comes after it is learned:
/// where it did, the next position waits for its own, and no longer after two positions that waited in vain.
/// A position that waits is delivered when the next one comes; nothing is delivered twice.
class FixEpochs {
 public:
  struct Fix {
    GpsSample sample;
    DeviceTime time;
    std::uint64_t offset = 0;  ///< of the position's frame
    std::uint64_t length = 0;
  };
  using Deliver = std::function<void(const Fix&)>;

  void add_position(std::uint32_t time_of_week_ms, const Fix& fix, const Deliver& deliver);
  /// Whether it completed a fix.
  bool add_velocity(const EpochVelocity& velocity, const Deliver& deliver);
  /// The stream has ended: a position that waits is delivered.
  void finish(const Deliver& deliver);

 private:
  struct Waiting {
    std::uint32_t time_of_week_ms = 0;
    Fix fix;
  };

  void release(const Deliver& deliver);

  std::optional<Waiting> waiting_;
  std::optional<EpochVelocity> velocity_;            ///< whose position has not come yet
  std::optional<std::uint32_t> delivered_alone_ms_;  ///< time of the week of the last one without velocity
  int patience_ = 0;                                 ///< how many positions in a row may wait in vain
};

}  // namespace fathom::codec
