#include <array>

#include "samples/command.hpp"
#include "samples/nav_state.hpp"
#include "samples/status/health.hpp"
#include "samples/verdict.hpp"

namespace fathom {
namespace {

template <std::size_t N, class Enum>
std::string_view pick(const std::array<std::string_view, N>& words, Enum value) {
  const auto index = static_cast<std::size_t>(value);
  return index < N ? words[index] : std::string_view("unknown");
}

}  // namespace

std::string_view to_string(VerdictKind kind) {
  static constexpr std::array<std::string_view, kVerdictKinds> kWords{
      "used",        "rejected",        "late",          "duplicate",       "frozen", "out_of_range",
      "not_aligned", "source_disabled", "unknown_frame", "from_the_future", "no_fix", "disputed"};
  return pick(kWords, kind);
}

std::string_view to_string(NavMode mode) {
  static constexpr std::array<std::string_view, 6> kWords{"none",           "aligning",       "gps_aided",
                                                          "acoustic_aided", "dead_reckoning", "inertial"};
  return pick(kWords, mode);
}

std::string_view to_string(AlignmentPhase phase) {
  static constexpr std::array<std::string_view, 8> kWords{"none", "waiting", "averaging", "coarse",
                                                          "fine", "aligned", "timed_out", "lost"};
  return pick(kWords, phase);
}

std::string_view to_string(Severity severity) {
  static constexpr std::array<std::string_view, 3> kWords{"notice", "warning", "critical"};
  return pick(kWords, severity);
}

std::string_view to_string(Presence presence) {
  static constexpr std::array<std::string_view, 4> kWords{"never_seen", "present", "stale", "missing"};
  return pick(kWords, presence);
}

std::string_view to_string(ServiceState state) {
  static constexpr std::array<std::string_view, 4> kWords{"starting", "healthy", "degraded", "stopping"};
  return pick(kWords, state);
}

std::string_view to_string(CommandKind kind) {
  static constexpr std::array<std::string_view, 6> kWords{
      "set_position", "realign", "enable_source", "disable_source", "acknowledge_alarm", "mark_at_rest"};
  return pick(kWords, kind);
}

}  // namespace fathom
