#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "base/few_at_once.hpp"
#include "health/alarm_book.hpp"
#include "health/instant.hpp"
#include "health/writers/writer_watch.hpp"
#include "samples/nav_state.hpp"

namespace fathom::health {

/// A watch over who writes the two topics that decide where the vehicle believes it is: the inertial samples
/// and the navigation state. When another process writes there, an alarm names both processes:
/// "imu_writer_changed:<sensor>" or "nav_writer_changed", each an event that stays until it is acknowledged.
/// "nav_writer_unexpected" is active while an unexpected service writes the navigation state.
class WriterChange {
 public:
  static constexpr double kFreshS = 5.0;  ///< how long a navigation state counts as the present one

  /// `services`: the expected services. When the list is empty, any service may write.
  explicit WriterChange(std::vector<Name> services) : services_(std::move(services)) {}

  void heard_imu(const Name& sensor, const WriterGuid& writer, const Instant& now);
  void heard(const NavState& state, const WriterGuid& writer, const Instant& now);
  void report(AlarmBook& book, const Instant& now, const DescribeWriter& describe);

 private:
  static constexpr std::size_t kMostUnits = 16;  ///< names come from the network: bounded
  static constexpr int kFew = 4;                 ///< changes that are told at once: two may write by turns
  static constexpr DurationNs kPeriod_ns = 10 * kNsPerSecond;
  struct Stream {
    WriterGuid writer{};
    std::string words;        ///< describe the writer, as it was known while it was present
    TimeNs described_ns = 0;  ///< monotonic
    TimeNs last_ns = 0;       ///< monotonic
    std::string before;       ///< words of the writer before it, until the change is reported
    WriterGuid first{};       ///< that writer
    WriterGuid other{};       ///< the last one since that is of another process
    bool changed = false;
    FewAtOnce pace{kFew, kPeriod_ns};
  };
  static void note(Stream& stream, const WriterGuid& writer, const Instant& now);
  static void tell(Stream& stream, const Name& key, const std::string& what, AlarmBook& book,
                   const Instant& now, const DescribeWriter& describe);

  std::vector<Name> services_;
  std::map<Name, Stream> units_;
  Stream navigation_;
  Name instance_;  ///< the service that the navigation state comes from
};

}  // namespace fathom::health
