#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "base/writer_guid.hpp"
#include "health/alarm_book.hpp"
#include "health/instant.hpp"
#include "samples/verdict.hpp"

namespace fathom::health {

/// Describes a writer as discovery knows it, e.g. "gps_bridge (process 12 on host auv1)". A GUID of zeros is
/// an unknown writer.
using DescribeWriter = std::function<std::string(const WriterGuid&)>;

/// A watch for second writers of a sensor: two writers that publish the same sensor in turn, or an unexpected
/// sensor beside the expected ones of its kind. A restarted bridge is a new writer, but its old writer does
/// not come back. So a second writer is one that comes back after another one wrote, twice within kWindowS.
class WriterWatch {
 public:
  static constexpr double kWindowS = 30.0;  ///< the alarm clears after this time without a second writer

  /// `expected`: the expected sensors. A kind without expected sensors is not checked by name.
  explicit WriterWatch(std::vector<std::pair<SourceKind, Name>> expected) : expected_(std::move(expected)) {}

  void heard(SourceKind kind, const Name& sensor, const WriterGuid& writer, const Instant& now);
  /// "second_writer:<sensor>".
  void report(AlarmBook& book, const Instant& now, const DescribeWriter& describe) const;

 private:
  static constexpr std::size_t kMaxWriters = 4;  ///< remembered per sensor
  struct Writer {
    WriterGuid id{};
    TimeNs last_ns = 0;
    std::uint64_t order = 0;  ///< number of its last sample among those of this sensor
  };
  struct Sensor {
    bool expected = true;
    std::vector<Writer> writers;
    std::uint64_t samples = 0;
    int returns = 0;  ///< times that a writer came back after another one, within the window
    TimeNs first_ns = 0;
    TimeNs returned_ns = 0;
    std::array<WriterGuid, 2> rivals{};
  };

  void note_return(Sensor& sensor, const WriterGuid& other, const WriterGuid& again,
                   const Instant& now) const;

  std::vector<std::pair<SourceKind, Name>> expected_;
  std::map<std::pair<SourceKind, Name>, Sensor> sensors_;
};

}  // namespace fathom::health
