#include "estimation/filter/state_index.hpp"

#include <cassert>

namespace fathom::estimation {
namespace {

using Names = std::array<std::string_view, 6>;

struct GroupRow {
  int size;
  Names names;
};

constexpr std::array<GroupRow, kGroups> kGroupRows{{
    {3, {"position_north_m", "position_east_m", "position_down_m"}},
    {3, {"velocity_north_m_s", "velocity_east_m_s", "velocity_down_m_s"}},
    {3, {"attitude_north_rad", "attitude_east_rad", "attitude_down_rad"}},
    {3, {"accel_bias_x_m_s2", "accel_bias_y_m_s2", "accel_bias_z_m_s2"}},
    {3, {"gyro_bias_x_rad_s", "gyro_bias_y_rad_s", "gyro_bias_z_rad_s"}},
    {3, {"accel_scale_x", "accel_scale_y", "accel_scale_z"}},
    {3, {"gyro_scale_x", "gyro_scale_y", "gyro_scale_z"}},
    {6,
     {"accel_misalignment_xy_rad", "accel_misalignment_xz_rad", "accel_misalignment_yx_rad",
      "accel_misalignment_yz_rad", "accel_misalignment_zx_rad", "accel_misalignment_zy_rad"}},
    {6,
     {"gyro_misalignment_xy_rad", "gyro_misalignment_xz_rad", "gyro_misalignment_yx_rad",
      "gyro_misalignment_yz_rad", "gyro_misalignment_zx_rad", "gyro_misalignment_zy_rad"}},
    {1, {"dvl_scale"}},
    {3, {"dvl_scale_x", "dvl_scale_y", "dvl_scale_z"}},
    {3, {"dvl_misalignment_x_rad", "dvl_misalignment_y_rad", "dvl_misalignment_z_rad"}},
    {3, {"dvl_bias_x_m_s", "dvl_bias_y_m_s", "dvl_bias_z_m_s"}},
    {2, {"current_north_m_s", "current_east_m_s"}},
    {1, {"depth_bias_m"}},
    {1, {"surface_altitude_m"}},
    {1, {"heading_bias_rad"}},
    {4,
     {"heading_deviation_b_rad", "heading_deviation_c_rad", "heading_deviation_d_rad",
      "heading_deviation_e_rad"}},
    {2, {"usbl_bias_north_m", "usbl_bias_east_m"}},
    {3, {"usbl_misalignment_x_rad", "usbl_misalignment_y_rad", "usbl_misalignment_z_rad"}},
    {3, {"gps_bias_north_m", "gps_bias_east_m", "gps_bias_down_m"}},
    {1, {"gps_latency_s"}},
    {3, {"gps_lever_x_m", "gps_lever_y_m", "gps_lever_z_m"}},
    {1, {"log_scale"}},
    {1, {"airspeed_bias_m_s"}},
    {1, {"airspeed_scale"}},
    {2, {"sideslip_rad", "angle_of_attack_rad"}},
    {1, {"baro_bias_m"}},
    {2, {"mount_pitch_rad", "mount_yaw_rad"}},
    {3, {"mount_lever_x_m", "mount_lever_y_m", "mount_lever_z_m"}},
    {2, {"model_scale_x", "model_scale_y"}},
    {2, {"model_bias_x_m_s", "model_bias_y_m_s"}},
    {1, {"antenna_bias_rad"}},
    {2 * kPlacedBeacons,
     {"beacon_1_north_m", "beacon_1_east_m", "beacon_2_north_m", "beacon_2_east_m", "beacon_3_north_m",
      "beacon_3_east_m"}},
}};

std::array<bool, kGroups> active(const StateGroups& g) {
  return {true,
          true,
          true,
          true,
          true,
          g.accel_scale,
          g.gyro_scale,
          g.accel_misalignment,
          g.gyro_misalignment,
          g.dvl_scale,
          g.dvl_scale_xyz,
          g.dvl_misalignment,
          g.dvl_bias,
          g.current,
          g.depth_bias,
          g.surface_altitude,
          g.heading_bias,
          g.heading_deviation,
          g.usbl_bias,
          g.usbl_misalignment,
          g.gps_position_bias,
          g.gps_latency,
          g.gps_lever,
          g.log_scale,
          g.airspeed_bias,
          g.airspeed_scale,
          g.flow_angles,
          g.baro_bias,
          g.mount_angles,
          g.mount_lever,
          g.model_scale,
          g.model_bias,
          g.antenna_bias,
          g.beacon_place};
}

}  // namespace

int group_size(Group group) {
  return kGroupRows[static_cast<std::size_t>(group)].size;
}

int state_count(const StateGroups& groups) {
  const auto on = active(groups);
  int count = 0;
  for (std::size_t i = 0; i < on.size(); ++i) count += on[i] ? kGroupRows[i].size : 0;
  return count;
}

StateIndex::StateIndex(const StateGroups& groups, const StateGroups& considered, Considered as) {
  const auto also = active(considered);
  auto on = active(groups);
  for (std::size_t i = 0; i < on.size(); ++i) on[i] = on[i] || (as == Considered::found && also[i]);
  for (std::size_t i = 0; i < on.size(); ++i) {
    start_[i] = on[i] ? size_ : -1;
    if (on[i]) size_ += kGroupRows[i].size;
    if (i == static_cast<std::size_t>(Group::gyro_misalignment)) imu_end_ = size_;
  }
  estimated_ = size_;
  // What came later stands behind what an older archive holds.
  const auto consider = [&](auto&& comes_now) {
    for (std::size_t i = 0; i < also.size(); ++i) {
      if (on[i] || !also[i] || !comes_now(static_cast<Group>(i))) continue;
      start_[i] = size_;
      size_ += kGroupRows[i].size;
    }
    return size_;
  };
  const auto since_19 = [](Group one) { return one == Group::usbl_bias || one == Group::antenna_bias; };
  const auto since_20 = [](Group one) { return one == Group::dvl_bias || one == Group::beacon_place; };
  held_.until_3 = estimated_;
  held_.until_18 = consider([&](Group one) { return !since_19(one) && !since_20(one); });
  held_.until_19 = consider(since_19);
  held_.now = consider(since_20);
  assert(size_ <= kMaxStates);
}

std::string_view StateIndex::name(int state) const {
  for (std::size_t i = 0; i < start_.size(); ++i) {
    if (start_[i] >= 0 && state >= start_[i] && state < start_[i] + kGroupRows[i].size)
      return kGroupRows[i].names[static_cast<std::size_t>(state - start_[i])];
  }
  return "";
}

}  // namespace fathom::estimation
