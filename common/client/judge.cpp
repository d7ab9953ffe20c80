#include <algorithm>
#include <array>
#include <cmath>
#include <cstdarg>
#include <cstdio>

#include <fathom/client.hpp>

#include "base/units.hpp"
#include "samples/position/gives_position.hpp"
#include "samples/uncertainty.hpp"

namespace fathom {
namespace {

std::string sentence(const char* format, ...) __attribute__((format(printf, 1, 2)));
std::string sentence(const char* format, ...) {
  std::array<char, 200> text{};
  va_list arguments;
  va_start(arguments, format);
  // NOLINTNEXTLINE(clang-analyzer-valist.Uninitialized): va_start is just above, the analyser misses it
  std::vsnprintf(text.data(), text.size(), format, arguments);
  va_end(arguments);
  return text.data();
}

template <std::size_t N>
bool all_finite(const std::array<double, N>& values) {
  return std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); });
}

std::string first_fault(const NavHealth& health, const NavState& state, const HealthLimits& limits) {
  if (!health.fresh) {
    return sentence("The navigation state is %.2f s old (limit %.2f s).", health.age_s, limits.max_age_s);
  }
  const std::string mode(to_string(state.mode));
  if (!gives_position(state.mode)) {
    return sentence("Navigation gives no position yet: mode %s.", mode.c_str());
  }
  if (!health.usable) return sentence("The navigation state of mode %s is not finite.", mode.c_str());
  if (limits.need_aligned && !health.aligned) {
    return sentence("Navigation is not aligned: phase %s.", std::string(to_string(state.alignment)).c_str());
  }
  if (!(health.horizontal_95_m <= limits.max_horizontal_95_m)) {
    return sentence("The position is certain only to %.1f m (95 %%, limit %.1f m).", health.horizontal_95_m,
                    limits.max_horizontal_95_m);
  }
  if (!(health.heading_sigma_rad <= limits.max_heading_sigma_rad)) {
    return sentence("The heading is certain only to %.1f deg (1 sigma, limit %.1f deg).",
                    health.heading_sigma_rad / kRadPerDeg, limits.max_heading_sigma_rad / kRadPerDeg);
  }
  return "";
}

}  // namespace

NavHealth judge(const std::optional<NavState>& state, double age_s, const HealthLimits& limits) {
  NavHealth health;
  if (!state) {
    health.reason = "No navigation state has been received.";
    return health;
  }
  health.heard = true;
  health.age_s = age_s;
  health.fresh = age_s <= limits.max_age_s;
  health.mode = state->mode;
  health.usable = gives_position(state->mode) && std::isfinite(state->latitude_rad) &&
                  std::isfinite(state->longitude_rad) && all_finite(state->velocity_N_m_s) &&
                  all_finite(state->q_NB);
  health.aligned = state->alignment == AlignmentPhase::aligned;
  health.horizontal_95_m = horizontal_95_m(state->position_covariance_N_m2);
  health.heading_sigma_rad = state->rpy_sigma_rad[2];
  // Unknown uncertainty is not certain: the comparisons are false for NaN.
  health.certain = health.horizontal_95_m <= limits.max_horizontal_95_m &&
                   health.heading_sigma_rad <= limits.max_heading_sigma_rad;
  health.reason = first_fault(health, *state, limits);
  health.ok = health.reason.empty();
  return health;
}

}  // namespace fathom
