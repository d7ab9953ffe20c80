#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "health/alarm_book.hpp"
#include "health/instant.hpp"
#include "health/writers/writer_watch.hpp"
#include "samples/nav_state.hpp"

namespace fathom::health {

/// Who speaks on the two topics that decide where the vehicle believes to be: its inertial units and its
/// navigation state. Another process there is an alarm that names both: "imu_writer_changed:<sensor>" and
/// "nav_writer_changed", each an event that stays until it is acknowledged. "nav_writer_unexpected" is held
/// while the navigation state comes from a service that is not among the expected ones.
class WriterChange {
 public:
  static constexpr double kFreshS = 5.0;  ///< for so long a navigation state counts as the present one

  /// `services`: those expected; where there is none, any may write.
  explicit WriterChange(std::vector<Name> services) : services_(std::move(services)) {}

  void heard_imu(const Name& sensor, const WriterGuid& writer, const Instant& now);
  void heard(const NavState& state, const WriterGuid& writer, const Instant& now);
  void report(AlarmBook& book, const Instant& now, const DescribeWriter& describe);

 private:
  static constexpr std::size_t kMostUnits = 16;  ///< names come from the network: bounded
  struct Stream {
    WriterGuid writer{};
    std::string words;        ///< of the writer, as known while it was there
    TimeNs described_ns = 0;  ///< monotonic
    TimeNs last_ns = 0;       ///< monotonic
    std::string before;       ///< words of the one before, until the change is reported
    bool changed = false;
  };
  static void note(Stream& stream, const WriterGuid& writer, const Instant& now);
  static void tell(Stream& stream, const Name& key, const std::string& what, AlarmBook& book,
                   const Instant& now, const DescribeWriter& describe);

  std::vector<Name> services_;
  std::map<Name, Stream> units_;
  Stream navigation_;
  Name instance_;  ///< that the navigation state comes from
};

}  // namespace fathom::health
