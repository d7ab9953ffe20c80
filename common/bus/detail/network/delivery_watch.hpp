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

/// Identity of a reader or writer within its participant; 0: any.
using EntityId = std::uint32_t;
/// The identity from its four bytes on the wire.
[[nodiscard]] EntityId to_entity_id(std::span<const std::uint8_t> bytes);

/// A claim of a message about a writer's samples: it carries one, it says which are available (a heartbeat),
/// or which are not (a gap).
struct Claim {
  WriterGuid writer{};
  EntityId reader = 0;       ///< the reader that it is sent to
  std::uint64_t number = 0;  ///< the highest sequence number that it names
  bool carries_sample = false;
};

/// A watch over deliveries: it compares what arrives for each reader with what the writer said before, and
/// with what Fast DDS hands over.
///
/// Fast DDS 2.9.1 counts one by one up to the next sample that a heartbeat or gap names, some millions a
/// second, and receives nothing meanwhile. A forged message can make it count for years. After a smaller leap
/// it takes the writer's real samples as received already, as long as both live: the reader is deaf to that
/// writer. Thread-safe.
class DeliveryWatch {
 public:
  /// Largest credible leap of a writer's numbers, which go up by one. A reader that missed as many was given
  /// up long before.
  static constexpr std::uint64_t kLeap = 100'000;
  /// Largest credible number of a writer of discovery.
  static constexpr std::uint64_t kDiscovery = 1'000'000;
  /// A reader is deaf when so many samples arrived in so long and none was handed over. The repair of lost
  /// samples takes less. Of a silence, as of a network that is cut, no more than `kSilence` counts.
  static constexpr int kSamples = 5;
  static constexpr DurationNs kPatience = 3 * kNsPerSecond;
  static constexpr DurationNs kSilence = kNsPerSecond;

  /// `now_ns` is a monotonic clock.
  explicit DeliveryWatch(std::function<TimeNs()> now_ns = {});

  /// `deaf` is called when this reader is deaf to a writer. The lock is held, so it must be quick.
  /// `one_at_a_time`: Fast DDS hands over only the samples of the writer that owns the instance.
  void join(const void* reader, bool one_at_a_time, std::function<void()> deaf);
  /// The identity by which other participants address the reader.
  void is_entity(const void* reader, EntityId id);
  void leave(const void* reader);
  void matched(const void* reader, const WriterGuid& writer);
  void unmatched(const void* reader, const WriterGuid& writer);

  /// A claim came in. False when it cannot be true.
  [[nodiscard]] bool arrived(const Claim& claim);
  /// Fast DDS handed over a sample of this writer to this reader.
  void heard(const void* reader, const WriterGuid& writer);
  /// The reader had no room for a sample of some writer.
  void refused(const void* reader);

  /// A datagram of any kind came in from the participant that it names.
  void arrived_from(std::span<const std::uint8_t> datagram);
  /// Whether something came in from this participant within the last `age_ns`. What came before the first
  /// such question does not count.
  [[nodiscard]] bool is_heard(const GuidPrefix& participant, DurationNs age_ns);
  /// The participant left.
  void gone(const GuidPrefix& participant);

 private:
  struct Writer {
    WriterGuid guid;
    std::uint64_t highest = 0;  ///< number named until now; 0: none yet
    int waiting = 0;            ///< samples that arrived since the last one was handed over
    TimeNs since_ns = 0;
    TimeNs last_ns = 0;  ///< of a sample that arrived
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
  std::map<GuidPrefix, TimeNs> last_;  ///< when something came in from each participant asked about; 0: never
};

}  // namespace fathom::bus::detail
