#include "bus/detail/mapping.hpp"
#include "idl/navigation.h"
#include "samples/alignment_status.hpp"

namespace fathom::bus::detail {

template <>
struct Mapping<AlignmentStatus> {
  using Wire = v1::AlignmentStatus;
  static constexpr const char* kTopic = "fathom/v1/alignment";
  static constexpr const char* kType = "fathom::v1::AlignmentStatus";
  static constexpr bool kHasLists = true;

  static void fields(auto& copy, auto& plain, auto& wire) {
    copy_header(copy, plain.header, wire);
    copy_enum<AlignmentPhase::lost, v1::AlignmentPhase::ALIGNMENT_PHASE_LOST>(copy, plain.phase,
                                                                              wire.phase());
    copy(plain.in_phase_s, wire.in_phase_s());
    copy.sequence(plain.conditions, plain.condition_count, wire.conditions(),
                  [](auto& each, auto& condition, auto& w) {
                    each(condition.name, w.name());
                    each(condition.value, w.value());
                    each(condition.limit, w.limit());
                    each(condition.held_s, w.held_s());
                    each(condition.needed_s, w.needed_s());
                    each(condition.met, w.met());
                  });
    copy(plain.rpy_sigma_rad, wire.rpy_sigma_rad());
    copy(plain.time_to_aligned_s, wire.time_to_aligned_s());
    copy.text(plain.advice, wire.advice());
  }

  static std::string key_text(const AlignmentStatus& sample) { return sample.header.vehicle.str(); }
};

}  // namespace fathom::bus::detail

FATHOM_BUS_TOPIC(AlignmentStatus)
