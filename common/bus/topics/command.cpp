#include "idl/command.h"

#include "bus/detail/mapping.hpp"
#include "samples/command.hpp"

namespace fathom::bus::detail {

template <>
struct Mapping<Command> {
  using Wire = v1::Command;
  static constexpr const char* kTopic = "fathom/v1/command";
  static constexpr const char* kType = "fathom::v1::Command";

  static void fields(auto& copy, auto& plain, auto& wire) {
    copy_header(copy, plain.header, wire);
    copy_enum<CommandKind::mark_at_rest, v1::CommandKind::COMMAND_MARK_AT_REST>(copy, plain.kind,
                                                                                wire.kind());
    copy(plain.target, wire.target());
    copy(plain.latitude_rad, wire.latitude_rad());
    copy(plain.longitude_rad, wire.longitude_rad());
    copy(plain.depth_m, wire.depth_m());
    copy(plain.sigma_m, wire.sigma_m());
    copy(plain.value_s, wire.value_s());
    copy(plain.confirmed, wire.confirmed());
  }

  static std::string key_text(const Command& sample) { return sample.header.vehicle.str(); }
};

}  // namespace fathom::bus::detail

FATHOM_BUS_TOPIC(Command)
