#include "samples/alignment/help.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <span>
#include <utility>

#include "base/units.hpp"

namespace fathom {
namespace {

using Help = std::pair<std::string_view, std::string_view>;

// By the names that the engine gives: estimation/engine/output_alignment.cpp.
constexpr std::array kHelp{
    Help{"rate_spread_rad_s",
         "hold the vehicle still: it turns and vibrates too much to be levelled at rest"},
    Help{"force_spread_m_s2", "hold the vehicle still: it is shaken too much to be levelled at rest"},
    Help{"gps_speed_m_s", "stop for a start at rest; a start in motion needs no stop"},
    Help{"heading_known", "a compass, two antennas or a given heading serve; or a start in motion"},
    Help{"course_sigma_rad",
         "run straight and faster with GPS velocity, or with a DVL on the bottom beside it"},
    Help{"acceleration_heading_sigma_rad",
         "speed up, brake and turn with GPS velocity: what is felt and how the velocity changes tell the "
         "heading"},
    Help{"position_known", "a GPS fix, two acoustic fixes that agree or an order of the position serves"},
    Help{"instruments_contradict",
         "go on turning: it takes some turns to say which instrument is wrong; a vehicle "
         "that turns on the spot needs a compass"},
    Help{"imu_unjudged_s", "wait: gravity and the rate of the inertial unit are looked at first"},
    Help{"roll_sigma_rad", "change speed and course: accelerations separate tilt from bias"},
    Help{"pitch_sigma_rad", "change speed and course: accelerations separate tilt from bias"},
    Help{"yaw_sigma_rad", "turn by 90 degrees or more and change speed with GPS"},
    Help{"roll_rad", "level the vehicle in roll"},
    Help{"pitch_rad", "level the vehicle in pitch"},
    Help{"depth_error_m", "hold the set depth"},
    Help{"rate_y_rad_s", "hold the pitch steady"},
    Help{"rate_z_rad_s", "run straight"},
    Help{"force_x_m_s2", "hold the speed"},
    Help{"gravity_defect_m_s2", "hold the depth rate steady"},
    Help{"speed_slope_m_s2", "hold the speed steady"},
};

// By the names of what is implausible: estimation/navigator/plausibility/findings.cpp.
constexpr std::array kBlames{
    std::pair{std::string_view("force_in_g"), Blame{SourceKind::imu, "unit"}},
    std::pair{std::string_view("force_downwards"), Blame{SourceKind::imu, "sign"}},
    std::pair{std::string_view("force_along_x"), Blame{SourceKind::imu, "axes"}},
    std::pair{std::string_view("force_along_y"), Blame{SourceKind::imu, "axes"}},
    std::pair{std::string_view("imu_rate"), Blame{SourceKind::imu, "rate"}},
    std::pair{std::string_view("gyro_negated"), Blame{SourceKind::imu, "sign"}},
    std::pair{std::string_view("gyro_axes"), Blame{SourceKind::imu, "axes"}},
    std::pair{std::string_view("gyro_in_degrees"), Blame{SourceKind::imu, "unit"}},
    std::pair{std::string_view("gyro_too_slow"), Blame{SourceKind::imu, "unit"}},
    std::pair{std::string_view("gps_axes"), Blame{SourceKind::gps, "axes"}},
    std::pair{std::string_view("gps_unit"), Blame{SourceKind::gps, "unit"}},
    std::pair{std::string_view("dvl_unit"), Blame{SourceKind::dvl, "unit"}},
    std::pair{std::string_view("dvl_turned"), Blame{SourceKind::dvl, "mounting"}},
    std::pair{std::string_view("dvl_mirrored"), Blame{SourceKind::dvl, "axes"}},
    std::pair{std::string_view("depth_unit"), Blame{SourceKind::depth, "unit"}},
    std::pair{std::string_view("depth_upwards"), Blame{SourceKind::depth, "sign"}},
    std::pair{std::string_view("heading_unit"), Blame{SourceKind::heading, "unit"}},
    std::pair{std::string_view("heading_negated"), Blame{SourceKind::heading, "sign"}},
    std::pair{std::string_view("gps_place_unit"), Blame{SourceKind::gps, "unit"}},
};

std::span<const AlignmentCondition> conditions(const AlignmentStatus& status) {
  return std::span(status.conditions)
      .first(std::min<std::size_t>(status.condition_count, AlignmentStatus::kMaxConditions));
}

/// nullptr where there is none.
template <class Is>
const AlignmentCondition* find_condition(const AlignmentStatus& status, const Is& is) {
  const auto all = conditions(status);
  const auto found = std::find_if(all.begin(), all.end(), is);
  return found == all.end() ? nullptr : &*found;
}

}  // namespace

bool is_implausible(const AlignmentCondition& condition) {
  return condition.name.view().starts_with(kImplausiblePrefix);
}

const AlignmentCondition* implausible(const AlignmentStatus& status) {
  return find_condition(status, is_implausible);
}

double start_heading_error_rad(const AlignmentStatus& status) {
  const AlignmentCondition* found =
      find_condition(status, [](const AlignmentCondition& one) { return one.name == kStartHeadingError; });
  return found == nullptr ? 0.0 : found->value;
}

std::vector<NoiseFactor> noise_factors(const AlignmentStatus& status) {
  std::vector<NoiseFactor> out;
  for (const AlignmentCondition& one : conditions(status))
    if (one.name.view().starts_with(kNoiseFactorPrefix))
      out.push_back({one.name.view().substr(kNoiseFactorPrefix.size()), one.value});
  return out;
}

std::string_view FoundBias::unit() const {
  return axis.starts_with("gyro") ? "deg/h" : "mg";
}

double FoundBias::in_unit(double si) const {
  return axis.starts_with("gyro") ? si / kDegPerHour_rad_s : si / kMilliG_m_s2;
}

std::array<char, 96> FoundBias::text() const {
  std::array<char, 96> out{};
  const std::size_t split = std::min(axis.find('_'), axis.size());
  const std::string_view number = axis.substr(std::min(split + 1, axis.size()));
  std::snprintf(out.data(), out.size(), "bias of %.*s %.*s is %.1f %s, and a sigma of %.4g %s is configured",
                static_cast<int>(split), axis.data(), static_cast<int>(number.size()), number.data(),
                in_unit(value), unit().data(), in_unit(said_sigma), unit().data());
  return out;
}

std::vector<FoundBias> found_biases(const AlignmentStatus& status) {
  std::vector<FoundBias> out;
  for (const AlignmentCondition& one : conditions(status)) {
    const std::string_view name = one.name.view();
    if (!name.starts_with(kBiasPrefix)) continue;
    const auto* const axis = std::find(kBiasAxes.begin(), kBiasAxes.end(), name.substr(kBiasPrefix.size()));
    if (axis != kBiasAxes.end()) out.push_back({*axis, one.value, one.limit});
  }
  return out;
}

std::vector<SlowFixes> slow_fixes(const AlignmentStatus& status) {
  std::vector<SlowFixes> out;
  for (const AlignmentCondition& one : conditions(status))
    if (one.name.view().starts_with(kSlowErrorPrefix))
      out.push_back({one.name.view().substr(kSlowErrorPrefix.size()), one.value, one.limit});
  return out;
}

Blame blame_of(const AlignmentCondition& condition) {
  if (!is_implausible(condition)) return {};
  const std::string_view name = condition.name.view().substr(kImplausiblePrefix.size());
  const auto* const found =
      std::find_if(kBlames.begin(), kBlames.end(), [&](const auto& one) { return one.first == name; });
  return found == kBlames.end() ? Blame{} : found->second;
}

std::string_view help_of(const AlignmentCondition& condition) {
  if (is_implausible(condition)) return "put the instrument right as the advice says";
  const auto* const found = std::find_if(kHelp.begin(), kHelp.end(),
                                         [&](const Help& one) { return one.first == condition.name.view(); });
  return found == kHelp.end() ? std::string_view() : found->second;
}

}  // namespace fathom
