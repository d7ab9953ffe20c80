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

/// A sample as it arrived: its writer, and its number among that writer's samples. When a writer takes the
/// place of another one, its first samples name that predecessor, and come after the predecessor's last one.
struct Arrival {
  struct Place {
    WriterGuid writer{};
    std::uint64_t number = 0;
  };
  Place place;
  std::optional<Place> after{};
};

/// Hands over the samples of writers that followed one another in the order of writing. The samples of each
/// writer arrive in order and completely. But when samples of a writer had to be sent again, those of its
/// successor overtake them. The successor's samples then wait here as long as this reader knows the
/// predecessor, which stays until everything it wrote has arrived, and at most for `kMost_ns`. Not
/// thread-safe.
template <class Sample>
class InOrder {
 public:
  static constexpr DurationNs kMost_ns = 6 * kNsPerSecond;
  static constexpr std::size_t kRoom = 4096;  ///< twice the depth of the highest rate

  void matched(const WriterGuid& writer) { writers_.try_emplace(writer); }
  void unmatched(const WriterGuid& writer) { writers_.erase(writer); }

  /// Whether the sample is to be handed over at once. Otherwise it is to be kept.
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

  /// Notes that all arrived samples were looked at. Samples of different instances have no order before that.
  void settle() {
    for (auto& [guid, writer] : writers_) writer.settled = writer.taken;
  }
  /// A sample whose turn has come. Call it until there is none.
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
  /// Notes that all writers left, so that no sample waits any longer.
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
    // A writer never takes the place of one of another participant.
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
