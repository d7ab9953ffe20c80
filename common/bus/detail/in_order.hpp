#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "base/time.hpp"
#include "bus/detail/network/peer_book.hpp"

namespace fathom::bus::detail {

/// A sample as it arrived: by whom, and its number among those of that writer. The first ones of a writer
/// that goes on in the place of another say so: they come after the last one of that writer.
struct Arrival {
  struct Place {
    WriterGuid writer{};
    std::uint64_t number = 0;
  };
  Place place;
  std::optional<Place> after{};
};

/// Hands over what several writers wrote one after the other in the order in which they did. Each of them is
/// heard in order and completely, but one whose samples had to be sent again is overtaken by its successor.
/// What the successor wrote waits for it here: as long as this reader knows the predecessor, which is kept
/// until all it wrote has arrived, and no longer than `kMost_ns`. Not thread-safe.
template <class Sample>
class InOrder {
 public:
  static constexpr DurationNs kMost_ns = 6 * kNsPerSecond;
  static constexpr std::size_t kRoom = 4096;  ///< twice the depth of the highest rate

  void matched(const WriterGuid& writer) { writers_.try_emplace(writer); }
  void unmatched(const WriterGuid& writer) { writers_.erase(writer); }

  /// True: to be handed over at once. Else it is to be kept.
  [[nodiscard]] bool may_pass(const Arrival& arrival) {
    if (waits(arrival)) return false;
    const auto writer = writers_.find(arrival.place.writer);
    if (writer != writers_.end()) writer->second.taken = std::max(writer->second.taken, arrival.place.number);
    return true;
  }
  void keep(const Arrival& arrival, Sample sample, TimeNs now_ns) {
    kept_.push_back({arrival, std::move(sample), now_ns});
  }
  [[nodiscard]] bool keeps() const { return !kept_.empty(); }

  /// All that has arrived was looked at. Between the samples of different instances there is no order before
  /// that.
  void settle() {
    for (auto& [guid, writer] : writers_) writer.settled = writer.taken;
  }
  /// One whose turn has come; again until there is none.
  [[nodiscard]] std::optional<Sample> next(TimeNs now_ns) {
    std::set<WriterGuid> waiting;
    for (auto one = kept_.begin(); one != kept_.end(); ++one) {
      const WriterGuid& guid = one->arrival.place.writer;
      if (waiting.contains(guid)) continue;
      const bool enough = now_ns - one->since_ns >= kMost_ns || kept_.size() > kRoom;
      if (!enough && is_early(one->arrival)) {
        waiting.insert(guid);
        continue;
      }
      const auto writer = writers_.find(guid);
      if (writer != writers_.end()) writer->second.taken = writer->second.settled = one->arrival.place.number;
      std::optional<Sample> sample = std::move(one->sample);
      kept_.erase(one);
      return sample;
    }
    return std::nullopt;
  }
  /// All of them left: nobody is waited for any longer.
  void all_unmatched() { writers_.clear(); }

 private:
  struct Writer {
    std::uint64_t taken = 0;
    std::uint64_t settled = 0;
  };
  struct Kept {
    Arrival arrival;
    Sample sample;
    TimeNs since_ns;
  };

  [[nodiscard]] bool is_early(const Arrival& arrival) const {
    // Nobody speaks for the writers of another participant.
    if (!arrival.after || prefix_of(arrival.after->writer) != prefix_of(arrival.place.writer)) return false;
    const auto before = writers_.find(arrival.after->writer);
    return before != writers_.end() && before->second.settled < arrival.after->number;
  }
  [[nodiscard]] bool waits(const Arrival& arrival) const {
    const auto of_same = [&](const Kept& one) { return one.arrival.place.writer == arrival.place.writer; };
    return is_early(arrival) || std::any_of(kept_.begin(), kept_.end(), of_same);
  }

  std::map<WriterGuid, Writer> writers_;
  std::deque<Kept> kept_;
};

}  // namespace fathom::bus::detail
