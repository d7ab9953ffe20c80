#include "samples/nav_state.hpp"

#include "bus/detail/mapping.hpp"
#include "idl/navigation.h"

namespace fathom::bus::detail {

template <>
struct Mapping<NavState> {
  using Wire = v1::NavState;
  static constexpr const char* kTopic = "fathom/v1/nav_state";
  static constexpr const char* kType = "fathom::v1::NavState";

  static void fields(auto& copy, auto& plain, auto& wire) {
    copy_header(copy, plain.header, wire);
    copy_enum<NavMode::inertial, v1::NavMode::NAV_MODE_INERTIAL>(copy, plain.mode, wire.mode());
    copy_enum<AlignmentPhase::lost, v1::AlignmentPhase::ALIGNMENT_PHASE_LOST>(copy, plain.alignment,
                                                                              wire.alignment());
    copy(plain.latitude_rad, wire.latitude_rad());
    copy(plain.longitude_rad, wire.longitude_rad());
    copy(plain.altitude_m, wire.altitude_m());
    copy(plain.depth_m, wire.depth_m());
    copy(plain.altitude_above_bottom_m, wire.altitude_above_bottom_m());
    copy(plain.velocity_N_m_s, wire.velocity_N_m_s());
    copy(plain.q_NB, wire.q_NB());
    copy(plain.rpy_rad, wire.rpy_rad());
    copy(plain.angular_rate_B_rad_s, wire.angular_rate_B_rad_s());
    copy(plain.specific_force_B_m_s2, wire.specific_force_B_m_s2());
    copy(plain.position_covariance_N_m2, wire.position_covariance_N_m2());
    copy(plain.velocity_covariance_N_m2_s2, wire.velocity_covariance_N_m2_s2());
    copy(plain.rpy_sigma_rad, wire.rpy_sigma_rad());
    copy(plain.gps_outage_s, wire.gps_outage_s());
    copy(plain.dvl_outage_s, wire.dvl_outage_s());
    copy(plain.reset_counter, wire.reset_counter());
    copy(plain.last_reset_delta_N_m, wire.last_reset_delta_N_m());
  }

  static std::string key_text(const NavState& sample) { return sample.header.vehicle.str(); }
};

}  // namespace fathom::bus::detail

FATHOM_BUS_TOPIC(NavState)
