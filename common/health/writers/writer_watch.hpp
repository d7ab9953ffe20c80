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

/// "gps_bridge (process 12 on host auv1)": what discovery knows of a writer.
using DescribeWriter = std::function<std::string(const WriterGuid&)>;

/// Second writers of a sensor: two that publish the same sensor in turn, or a sensor that nobody expects
/// beside the expected ones of its kind. A restarted bridge is a new writer, but the old one does not come
/// back: only one that is heard again after another was is a second one, twice within kWindowS.
class WriterWatch {
 public:
  static constexpr double kWindowS = 30.0;  ///< and the alarm clears after as long without

  /// `expected`: the sensors that have to be there. A kind without any is not judged by name.
  explicit WriterWatch(std::vector<std::pair<SourceKind, Name>> expected) : expected_(std::move(expected)) {}

  void heard(SourceKind kind, const Name& sensor, const WriterGuid& writer, const Instant& now);
  /// "second_writer:<sensor>".
  void report(AlarmBook& book, const Instant& now, const DescribeWriter& describe) const;

 private:
  static constexpr std::size_t kMaxWriters = 4;  ///< remembered per sensor
  struct Writer {
    WriterGuid id{};
    TimeNs last_ns = 0;
    std::uint64_t order = 0;  ///< of its last sample among this sensor's
  };
  struct Sensor {
    bool expected = true;
    std::vector<Writer> writers;
    std::uint64_t samples = 0;
    int returns = 0;  ///< of a writer after another one, within the window
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
