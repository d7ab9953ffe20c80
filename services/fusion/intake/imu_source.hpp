#pragma once

#include <cstdint>

#include "base/name.hpp"
#include "base/time.hpp"
#include "base/writer_guid.hpp"

namespace fathom::fusion {

/// The one source of inertial samples: one unit, as one process writes it. When two processes write in the
/// name of the unit, their samples are never mixed. The first one is used until it has been silent for a
/// while, like a bridge that was started again. Pure and not thread-safe.
class ImuSource {
 public:
  enum class Answer : std::uint8_t {
    taken,
    other_unit,
    other_writer,  ///< while the process that is used still writes
  };

  /// `patience_ns`: how long the process that is used may be silent.
  ImuSource(Name unit, DurationNs patience_ns) : unit_(unit), patience_ns_(patience_ns) {}

  /// Whether a sample of `unit`, published by `writer`, is used. `now_ns` is monotonic.
  [[nodiscard]] Answer take(const Name& unit, const WriterGuid& writer, TimeNs now_ns);
  [[nodiscard]] const Name& unit() const { return unit_; }
  /// How often another process took the place of the one that was used.
  [[nodiscard]] std::uint64_t changes() const { return changes_; }
  /// Samples of other processes in its name that were left out.
  [[nodiscard]] std::uint64_t rivals() const { return rivals_; }

 private:
  Name unit_;
  DurationNs patience_ns_;
  WriterGuid writer_{};
  bool begun_ = false;
  TimeNs last_ns_ = 0;
  std::uint64_t changes_ = 0;
  std::uint64_t rivals_ = 0;
};

}  // namespace fathom::fusion
