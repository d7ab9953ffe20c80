#include "samples/verdict.hpp"

#include "bus/detail/mapping.hpp"
#include "idl/navigation.h"

namespace fathom::bus::detail {

template <>
struct Mapping<Verdict> {
  using Wire = v1::Verdict;
  static constexpr const char* kTopic = "fathom/v1/verdict";
  static constexpr const char* kType = "fathom::v1::Verdict";

  static void fields(auto& copy, auto& plain, auto& wire) {
    copy_header(copy, plain.header, wire);
    copy_enum<kLastKind, v1::SourceKind::SOURCE_FIX>(copy, plain.source, wire.source());
    copy(plain.model, wire.model());
    copy(plain.writer, wire.writer());
    copy_enum<VerdictKind::disputed, v1::VerdictKind::VERDICT_DISPUTED>(copy, plain.kind, wire.kind());
    copy(plain.dimensions, wire.dimensions());
    copy(plain.innovation, wire.innovation());
    copy(plain.innovation_sigma, wire.innovation_sigma());
    copy(plain.test_ratio, wire.test_ratio());
    copy(plain.limit, wire.limit());
    copy(plain.revision, wire.revision());
    copy_enum<VerdictKind::disputed, v1::VerdictKind::VERDICT_DISPUTED>(copy, plain.previous,
                                                                        wire.previous());
    copy(plain.is_final, wire.is_final());
  }

  static std::string key_text(const Verdict& sample) { return vehicle_and_sensor(sample); }
};

}  // namespace fathom::bus::detail

FATHOM_BUS_TOPIC(Verdict)
