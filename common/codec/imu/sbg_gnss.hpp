#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>

#include "base/device_time.hpp"
#include "base/unknown.hpp"
#include "codec/codec.hpp"
#include "codec/framer.hpp"
#include "samples/gps.hpp"
#include "samples/heading.hpp"

namespace fathom::codec::sbg {

/// Of the status of a position: bits 0 to 5; and its kind, bits 6 to 11.
inline constexpr unsigned kSolutionComputed = 0;
inline constexpr unsigned kInsufficientObservations = 1;
enum class PositionType : std::uint8_t {
  none = 0,
  unknown = 1,
  single = 2,
  differential = 3,
  sbas = 4,
  omnistar = 5,
  rtk_float = 6,
  rtk_fixed = 7,
  ppp_float = 8,
  ppp_fixed = 9,
  told = 10,  ///< somebody has set the position
};
/// The same of a velocity.
enum class VelocityType : std::uint8_t { none = 0, unknown = 1, doppler = 2, differential = 3 };

/// GPS1_POS or GPS2_POS.
struct Position {
  std::uint32_t stamp_us = 0;
  std::uint32_t time_of_week_ms = 0;
  GpsSample sample;
};
[[nodiscard]] std::optional<RejectReason> read_position(Bytes data, Position& into);

/// GPS1_VEL or GPS2_VEL; unknown where there is no solution.
struct Velocity {
  std::uint32_t time_of_week_ms = 0;
  std::array<double, 3> velocity_N_m_s{kUnknown, kUnknown, kUnknown};
  std::array<double, 3> sigma_N_m_s{kUnknown, kUnknown, kUnknown};
  double course_rad = kUnknown;
};
[[nodiscard]] std::optional<RejectReason> read_velocity(Bytes data, Velocity& into);

/// With this accuracy or a larger one there is no heading (sbgEComLogGnssHdt.c of sbgECom).
inline constexpr double kNoHeading_deg = 180.0;

/// GPS1_HDT or GPS2_HDT; unknown where there is no solution.
struct Heading {
  std::uint32_t stamp_us = 0;
  std::uint32_t time_of_week_ms = 0;
  HeadingSample sample;
};
[[nodiscard]] std::optional<RejectReason> read_heading(Bytes data, Heading& into);

/// Joins position and velocity of one receiver, which come in two frames of the same time of the week.
///
/// A position whose velocity came before it is delivered with it. Whether one comes after it is learned:
/// where it did, the next position waits for its own, and no longer after two positions that waited in vain.
/// A position that waits is delivered when the next one comes; nothing is delivered twice.
class Epochs {
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
  bool add_velocity(const Velocity& velocity, const Deliver& deliver);
  /// The stream has ended: a position that waits is delivered.
  void finish(const Deliver& deliver);

 private:
  struct Waiting {
    std::uint32_t time_of_week_ms = 0;
    Fix fix;
  };

  void release(const Deliver& deliver);

  std::optional<Waiting> waiting_;
  std::optional<Velocity> velocity_;                 ///< whose position has not come yet
  std::optional<std::uint32_t> delivered_alone_ms_;  ///< time of the week of the last one without velocity
  int patience_ = 0;                                 ///< how many positions in a row may wait in vain
};

}  // namespace fathom::codec::sbg
