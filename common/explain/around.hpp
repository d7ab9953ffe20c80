#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "explain/explain.hpp"

namespace fathom::explain {

/// What became of one source's measurements in the seconds before an instant.
struct SourceThen {
  std::string sensor;
  SourceKind kind = SourceKind::imu;
  std::array<std::uint64_t, kVerdictKinds> counts{};
  double last_used_s = kUnknown;  ///< before the instant; unknown: not yet
  double last_heard_s = kUnknown;
  double worst_sigmas = kUnknown;  ///< largest innovation over its sigma among those that were refused

  [[nodiscard]] std::uint64_t used() const { return counts[static_cast<std::size_t>(VerdictKind::used)]; }
  [[nodiscard]] std::uint64_t all() const;
  /// Why most of the others were not used; `used` where there are none.
  [[nodiscard]] VerdictKind main_reason() const;
};

struct Around {
  static constexpr DurationNs kWindow_ns = 10 * kNsPerSecond;
  TimeNs at_ns = 0;
  const StateRow* state = nullptr;    ///< null: none within two seconds
  const StateRow* earlier = nullptr;  ///< a minute before, or the first one
  std::vector<SourceThen> sources;
};

[[nodiscard]] Around around(const History& history, TimeNs at_ns);

/// Numbers of the findings that were under way at an instant, or over less than half a minute before.
[[nodiscard]] std::vector<std::size_t> under_way(const Findings& all, TimeNs at_ns);

/// The finding that led to an alarm; nothing where none did.
[[nodiscard]] std::optional<std::size_t> behind(const Findings& all, const AlarmRow& alarm);

}  // namespace fathom::explain
