#include "samples/status/intake.hpp"

#include "bus/detail/mapping.hpp"
#include "idl/intake.h"

namespace fathom::bus::detail {

template <>
struct Mapping<IntakeRecord> {
  using Wire = v1::IntakeRecord;
  static constexpr const char* kTopic = "fathom/v1/intake";
  static constexpr const char* kType = "fathom::v1::IntakeRecord";
  static constexpr bool kHasLists = true;

  static void fields(auto& copy, auto& plain, auto& wire) {
    copy_header(copy, plain.header, wire);
    copy(plain.first, wire.first());
    copy.sequence(plain.entries, wire.entries(), IntakeRecord::kMostEntries,
                  [](auto& each, auto& entry, auto& w) {
                    copy_enum<IntakeKind::end, v1::IntakeKind::INTAKE_END>(each, entry.kind, w.kind());
                    copy_enum<kLastKind, v1::SourceKind::SOURCE_FIX>(each, entry.source, w.source());
                    each(entry.sensor, w.sensor());
                    each(entry.writer, w.writer());
                    each(entry.stamp_ns, w.stamp_ns());
                    each(entry.sequence, w.sequence_number());
                    each(entry.again, w.again());
                  });
  }

  static std::string key_text(const IntakeRecord& sample) { return vehicle_and_sensor(sample); }
};

}  // namespace fathom::bus::detail

FATHOM_BUS_TOPIC(IntakeRecord)
