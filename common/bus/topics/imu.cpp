#include "samples/imu.hpp"

#include "bus/detail/mapping.hpp"
#include "idl/sensors.h"
#include "samples/kinds.hpp"

namespace fathom::bus::detail {

template <>
struct Mapping<ImuSample> {
  using Wire = v1::ImuSample;
  static constexpr const char* kTopic = KindOf<ImuSample>::kTopic.data();
  static constexpr const char* kType = "fathom::v1::ImuSample";

  static void fields(auto& copy, auto& plain, auto& wire) {
    copy_header(copy, plain.header, wire);
    copy(plain.angular_rate_B_rad_s, wire.angular_rate_B_rad_s());
    copy(plain.specific_force_B_m_s2, wire.specific_force_B_m_s2());
    copy(plain.delta_angle_B_rad, wire.delta_angle_B_rad());
    copy(plain.delta_velocity_B_m_s, wire.delta_velocity_B_m_s());
    copy(plain.delta_time_s, wire.delta_time_s());
    copy(plain.temperature_degC, wire.temperature_degC());
  }

  static std::string key_text(const ImuSample& sample) { return vehicle_and_sensor(sample); }
};

}  // namespace fathom::bus::detail

FATHOM_BUS_TOPIC(ImuSample)
