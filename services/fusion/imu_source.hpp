#pragma once

#include <cstdint>

#include "base/name.hpp"
#include "base/time.hpp"
#include "bus/participant.hpp"

namespace fathom::fusion {

/// Which inertial samples are integrated: those of one unit, as one process writes them. Two that write in
/// its name are never mixed: the first one is listened to until it has been silent for a while, as a bridge
/// is that was started again. Pure and not thread-safe.
class ImuSource {
 public:
  enum class Hearing : std::uint8_t {
    taken,
    other_unit,
    other_writer,  ///< while the one listened to is there
  };

  /// `patience_ns`: for so long the one listened to may be silent.
  ImuSource(Name unit, DurationNs patience_ns) : unit_(unit), patience_ns_(patience_ns) {}

  /// `now_ns` is monotonic.
  [[nodiscard]] Hearing hear(const Name& unit, const WriterGuid& writer, TimeNs now_ns);
  [[nodiscard]] const Name& unit() const { return unit_; }
  /// How often another one was listened to from then on.
  [[nodiscard]] std::uint64_t changes() const { return changes_; }
  /// Samples of others in its name that were left out.
  [[nodiscard]] std::uint64_t rivals() const { return rivals_; }

 private:
  Name unit_;
  DurationNs patience_ns_;
  WriterGuid writer_{};
  bool heard_ = false;
  TimeNs last_ns_ = 0;
  std::uint64_t changes_ = 0;
  std::uint64_t rivals_ = 0;
};

}  // namespace fathom::fusion
