#pragma once

#include "base/name.hpp"
#include "base/time.hpp"
#include "base/writer_guid.hpp"
#include "samples/kinds.hpp"

namespace fathom::fusion {

/// A sample as it arrived: what it is, who published it and when it was received. The reader's handler makes
/// it, and the intake, the log of arrivals, the engine and the verdict of the sample all use this one record.
struct Arrival {
  AnySample sample;
  WriterGuid writer_guid{};
  /// Name of the participant that published it. It is looked up once, at the arrival, because the participant
  /// may be gone when the last verdict is given.
  Name writer;
  TimeNs received_ns = 0;  ///< monotonic

  [[nodiscard]] SourceKind source() const { return source_of(sample); }
  [[nodiscard]] const SampleHeader& header() const { return header_of(sample); }
};

}  // namespace fathom::fusion
