#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "blackbox/sample.hpp"

namespace fathom::blackbox {

/// Samples of a topic, or events, or enclosures, that found no room, and from when to when.
struct Dropped {
  std::uint64_t count = 0;
  TimeNs first_ns = 0;
  TimeNs last_ns = 0;
};

/// From the readers of the bus to the disk's thread. Whoever puts something in never waits: what finds no
/// room is dropped and counted. Thread-safe.
class Queue {
 public:
  using Item = std::variant<Origin, Sample, Event, Enclosure>;

  explicit Queue(std::uint64_t most_bytes) : most_bytes_(most_bytes) {}

  /// The number that samples of this origin name.
  std::uint32_t add(Origin origin);
  void put(Sample sample);
  void put(Event event);
  void put(Enclosure enclosure);

  struct Batch {
    std::deque<Item> items;
    std::map<std::string, Dropped> dropped;  ///< by topic, "events" or "enclosures", since the last batch
    bool ended = false;
  };
  /// All that waits, after `patience_ns` or when half of the room is taken or at the end.
  [[nodiscard]] Batch take(DurationNs patience_ns);
  /// No more is put in; take() no longer waits.
  void end();

  [[nodiscard]] std::uint64_t dropped() const;

 private:
  /// `bytes` beside those of every item; `time_ns`: when it came.
  void put(Item item, std::uint64_t bytes, TimeNs time_ns);

  const std::uint64_t most_bytes_;
  mutable std::mutex mutex_;
  std::condition_variable wake_;
  std::deque<Item> items_;
  std::uint64_t bytes_ = 0;
  std::vector<std::string> topics_;  // of the origins
  std::map<std::string, Dropped> dropped_;
  std::uint64_t dropped_total_ = 0;
  bool ended_ = false;
};

}  // namespace fathom::blackbox
