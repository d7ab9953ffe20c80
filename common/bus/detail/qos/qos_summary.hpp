#pragma once

#include <cstdint>
#include <limits>
#include <string>

#include "base/time.hpp"

namespace fathom::bus::detail {

/// The policies in which a writer and a reader have to agree.
enum class Policy : std::uint8_t { reliability, durability, deadline, ownership, liveliness, other };

inline constexpr DurationNs kForever = std::numeric_limits<DurationNs>::max();

/// What an endpoint offers or requests. The numbers grow with what is promised.
struct QosSummary {
  int reliability = 0;  ///< 0 best effort, 1 reliable
  int durability = 0;   ///< 0 volatile, 1 transient local, 2 transient, 3 persistent
  int ownership = 0;    ///< 0 shared, 1 exclusive: both sides must be equal
  int liveliness = 0;   ///< 0 automatic, 1 manual by participant, 2 manual by topic
  DurationNs lease_ns = kForever;
  DurationNs deadline_ns = kForever;
};

/// Whether this policy keeps the two apart (DDS 1.4, 2.2.3: requested against offered).
[[nodiscard]] bool conflict(Policy policy, const QosSummary& offered, const QosSummary& requested);

/// The value of one side in words, e.g. "100 ms".
[[nodiscard]] std::string value_text(Policy policy, const QosSummary& qos);
[[nodiscard]] std::string to_string(Policy policy);
/// A duration in words, e.g. "30 ms", "1.5 s", "none" for kForever.
[[nodiscard]] std::string duration_text(DurationNs duration);

}  // namespace fathom::bus::detail
