#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <span>
#include <vector>

#include "base/time.hpp"
#include "bus/detail/network/peer_book.hpp"
#include "bus/participant.hpp"

namespace fathom::bus::detail {

/// Of a reader or writer, unique within its participant; 0: any.
using EntityId = std::uint32_t;
/// From its four bytes, as they travel.
[[nodiscard]] EntityId to_entity_id(std::span<const std::uint8_t> bytes);

/// What a message says of a writer's samples: here is one, or such are to be had (a heartbeat), or are not (a
/// gap).
struct Claim {
  WriterGuid writer{};
  EntityId reader = 0;       ///< for whom it is
  std::uint64_t number = 0;  ///< highest sequence number it speaks of
  bool carries_sample = false;
};

/// Compares what arrives for each reader with what the writer said before, and with what Fast DDS hands over.
///
/// Fast DDS 2.9.1 counts, one by one, up to the sample that a heartbeat or gap says is next, some millions in
/// a second, and receives nothing meanwhile: a forged one can have it count for years. A smaller leap makes
/// it take the writer's real samples for received already, for as long as both live: it is deaf to that
/// writer. Thread-safe.
class DeliveryWatch {
 public:
  /// A writer's numbers go up by one. Who has missed so many has been given up long before.
  static constexpr std::uint64_t kLeap = 100'000;
  /// Of the writers of discovery no more is said than this.
  static constexpr std::uint64_t kDiscovery = 1'000'000;
  /// So many samples arrived in so long, and none was handed over. Repairing what was lost takes less.
  static constexpr int kSamples = 5;
  static constexpr DurationNs kPatience = 3 * kNsPerSecond;

  /// `now_ns` is a monotonic clock.
  explicit DeliveryWatch(std::function<TimeNs()> now_ns = {});

  /// `deaf` is called when this reader hears nothing of a writer, with the lock held: be quick.
  /// `one_at_a_time`: of all its writers only one is handed over, that which owns the instance.
  void join(const void* reader, bool one_at_a_time, std::function<void()> deaf);
  /// Who it is to others.
  void is_entity(const void* reader, EntityId id);
  void leave(const void* reader);
  void matched(const void* reader, const WriterGuid& writer);
  void unmatched(const void* reader, const WriterGuid& writer);

  /// A claim came in. False when it cannot be true.
  [[nodiscard]] bool arrived(const Claim& claim);
  /// This reader handed over a sample of this writer.
  void heard(const void* reader, const WriterGuid& writer);
  /// It had no room for a sample of some writer.
  void refused(const void* reader);

  /// A datagram came in, of whatever kind, from the participant that it says it is of.
  void arrived_from(std::span<const std::uint8_t> datagram);
  /// Something came in from this participant within the last `age_ns`. What came before it was first asked
  /// about does not count.
  [[nodiscard]] bool is_heard(const GuidPrefix& participant, DurationNs age_ns);
  /// It left.
  void gone(const GuidPrefix& participant);

 private:
  struct Writer {
    WriterGuid guid;
    std::uint64_t highest = 0;  ///< spoken of until now; 0: nothing yet
    int waiting = 0;            ///< arrived since the last that was handed over
    TimeNs since_ns = 0;
  };
  struct Reader {
    const void* who;
    bool one_at_a_time;
    std::function<void()> deaf;
    EntityId id = 0;
    std::vector<Writer> writers{};
  };
  Reader* find(const void* reader);

  std::function<TimeNs()> now_ns_;
  std::mutex mutex_;
  std::vector<Reader> readers_;

  std::atomic<bool> somebody_asked_ = false;
  std::mutex mutex_of_participants_;
  std::map<GuidPrefix, TimeNs> last_;  ///< of those asked about, when something of them came in; 0: never
};

}  // namespace fathom::bus::detail
