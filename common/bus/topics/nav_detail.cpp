#include "samples/nav_detail.hpp"

#include "bus/detail/mapping.hpp"
#include "idl/navigation.h"

namespace fathom::bus::detail {

template <>
struct Mapping<NavDetail> {
  using Wire = v1::NavDetail;
  static constexpr const char* kTopic = "fathom/v1/nav_detail";
  static constexpr const char* kType = "fathom::v1::NavDetail";
  static constexpr bool kHasLists = true;

  static void fields(auto& copy, auto& plain, auto& wire) {
    copy_header(copy, plain.header, wire);
    copy(plain.configuration, wire.configuration());
    copy.sequence(plain.states, plain.count, wire.states(), [](auto& each, auto& state, auto& wire_state) {
      each(state.name, wire_state.name());
      each(state.value, wire_state.value());
      each(state.sigma, wire_state.sigma());
    });
  }

  static std::string key_text(const NavDetail& sample) { return sample.header.vehicle.str(); }
};

}  // namespace fathom::bus::detail

FATHOM_BUS_TOPIC(NavDetail)
