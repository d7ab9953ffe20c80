#include "samples/forecast.hpp"

#include "bus/detail/mapping.hpp"
#include "idl/navigation.h"

namespace fathom::bus::detail {

template <>
struct Mapping<Forecast> {
  using Wire = v1::Forecast;
  static constexpr const char* kTopic = "fathom/v1/forecast";
  static constexpr const char* kType = "fathom::v1::Forecast";
  static constexpr bool kHasLists = true;

  static void fields(auto& copy, auto& plain, auto& wire) {
    copy_header(copy, plain.header, wire);
    copy(plain.horizontal_95_m, wire.horizontal_95_m());
    copy(plain.vertical_95_m, wire.vertical_95_m());
    copy(plain.heading_95_rad, wire.heading_95_rad());
    copy(plain.horizontal_growth_m_s, wire.horizontal_growth_m_s());
    copy.sequence(plain.limits, plain.limit_count, wire.limits(), [](auto& each, auto& limit, auto& w) {
      each(limit.name, w.name());
      each(limit.without, w.without());
      each(limit.limit, w.limit());
      each(limit.now, w.now());
      each(limit.time_to_limit_s, w.time_to_limit_s());
      each(limit.time_expected_s, w.time_expected_s());
    });
  }

  static std::string key_text(const Forecast& sample) { return sample.header.vehicle.str(); }
};

}  // namespace fathom::bus::detail

FATHOM_BUS_TOPIC(Forecast)
