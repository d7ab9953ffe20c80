#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "bus/participant.hpp"
#include "samples/header.hpp"
#include "samples/verdict.hpp"

namespace fathom::fusion {

/// Remembers who wrote the measurements of the last seconds: a verdict may come long after its measurement,
/// and says whose it was. Bounded: the oldest entry makes room.
class ArrivalBook {
 public:
  void note(SourceKind source, const SampleHeader& header, const bus::WriterGuid& writer);
  /// The writer of the newest measurement with the source, sensor and sequence of the verdict.
  [[nodiscard]] std::optional<bus::WriterGuid> writer_of(const Verdict& verdict) const;

 private:
  // 10 s of the busiest vehicle: more than any measurement waits for its verdict.
  static constexpr std::size_t kEntries = 512;
  struct Entry {
    SourceKind source = SourceKind::imu;
    Name sensor;
    std::uint64_t sequence = 0;
    bus::WriterGuid writer{};
  };
  std::array<Entry, kEntries> entries_{};
  std::size_t noted_ = 0;
};

}  // namespace fathom::fusion
