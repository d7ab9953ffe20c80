#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "estimation/engine_config.hpp"

namespace fathom::estimation {

/// Room for error states. All storage is of this size; loops run over the active ones.
inline constexpr int kMaxStates = 64;

/// States that belong together, in the order in which they stand in the error vector. Everything from
/// accel_bias to gyro_misalignment drives the navigation error (see error_dynamics.hpp); what follows is only
/// seen by measurements. Groups that are considered (KF-6) stand behind all that are estimated, in this order
/// again.
enum class Group : std::uint8_t {
  position,
  velocity,
  attitude,
  accel_bias,
  gyro_bias,
  accel_scale,
  gyro_scale,
  accel_misalignment,
  gyro_misalignment,
  dvl_scale,
  dvl_scale_xyz,
  dvl_misalignment,
  dvl_bias,
  current,
  depth_bias,
  surface_altitude,
  heading_bias,
  heading_deviation,
  usbl_bias,
  usbl_misalignment,
  gps_position_bias,
  gps_latency,
  gps_lever,
  log_scale,
  airspeed_bias,
  airspeed_scale,
  flow_angles,
  baro_bias,
  mount_angles,
  mount_lever,
  model_scale,
  model_bias,
  antenna_bias,
  beacon_place,
};
inline constexpr int kGroups = 34;
inline constexpr int kPlacedBeacons = 3;  ///< that may each lie elsewhere than they are said to
inline constexpr int kNavStates = 9;      ///< position, velocity, attitude

[[nodiscard]] int group_size(Group group);
/// How many states these groups make; a configuration with more than kMaxStates is refused.
[[nodiscard]] int state_count(const StateGroups& groups);

/// How many states are held by archives of older versions, and by those of today: what is considered came
/// later, and stands behind.
struct HeldStates {
  int until_3 = 0;
  int until_18 = 0;
  int until_19 = 0;
  int now = 0;

  /// By `archive`, which says since which version it is.
  template <class Archive>
  [[nodiscard]] int of(const Archive& archive) const {
    return archive.since(20) ? now : archive.since(19) ? until_19 : archive.since(4) ? until_18 : until_3;
  }
};

/// Where each active group begins.
class StateIndex {
 public:
  /// What is considered, or `found` like what is estimated.
  enum class Considered : std::uint8_t { kept, found };
  explicit StateIndex(const StateGroups& groups, const StateGroups& considered = {},
                      Considered as = Considered::kept);

  /// Estimated and considered.
  [[nodiscard]] int size() const { return size_; }
  /// The first ones, which are estimated.
  [[nodiscard]] int estimated() const { return estimated_; }
  [[nodiscard]] const HeldStates& held() const { return held_; }
  /// One past the last estimated state that drives the navigation error.
  [[nodiscard]] int imu_end() const { return imu_end_; }
  /// Index of the group's first state, -1 when it is neither estimated nor considered.
  [[nodiscard]] int of(Group group) const { return start_[static_cast<std::size_t>(group)]; }
  [[nodiscard]] bool has(Group group) const { return of(group) >= 0; }
  /// E.g. "gyro_bias_x_rad_s" for a state index below size().
  [[nodiscard]] std::string_view name(int state) const;

 private:
  std::array<int, kGroups> start_{};
  int size_ = 0;
  int estimated_ = 0;
  HeldStates held_;
  int imu_end_ = 0;
};

}  // namespace fathom::estimation
