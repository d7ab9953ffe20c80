#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "base/time.hpp"
#include "base/unknown.hpp"
#include "codec/codec.hpp"
#include "codec/framer.hpp"
#include "samples/gps.hpp"
#include "samples/heading.hpp"

namespace fathom::codec::sbf {

/// Whole blocks with their header. Each reader gives why a block is refused, nothing when it is good.

/// Since the GPS epoch; nothing where the receiver does not know its time yet.
using GpsInstant = std::optional<DurationNs>;
[[nodiscard]] std::optional<RejectReason> read_instant(Bytes block, GpsInstant& into);

struct Pvt {
  GpsSample sample;
  std::optional<DurationNs> age_ns;  ///< at its transmission
};
[[nodiscard]] std::optional<RejectReason> read_pvt(Bytes block, unsigned revision, Pvt& into);

/// North, east, vertical; unknown where there is no solution or the receiver gives none.
using Sigmas = std::array<double, 3>;
[[nodiscard]] std::optional<RejectReason> read_position_covariance(Bytes block, Sigmas& sigma_m);
[[nodiscard]] std::optional<RejectReason> read_velocity_covariance(Bytes block, Sigmas& sigma_m_s);

[[nodiscard]] std::optional<RejectReason> read_att_euler(Bytes block, HeadingSample& into);
[[nodiscard]] std::optional<RejectReason> read_att_covariance(Bytes block, double& heading_sigma_rad);

/// How far GPS time is ahead of UTC; unchanged where the receiver does not know it.
[[nodiscard]] std::optional<RejectReason> read_leap_seconds(Bytes block, DurationNs& ahead_of_utc_ns);

}  // namespace fathom::codec::sbf
