#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "base/time.hpp"
#include "bus/participant.hpp"

namespace fathom::bus {

struct WriterOptions {
  /// Promise to write at least this often (per instance). None: as the profile says.
  std::optional<DurationNs> deadline_ns;
  /// Exclusive topics: the strongest living writer is heard.
  std::int32_t ownership_strength = 0;
  /// It falls silent by intent, while another writer speaks for it: its own missed deadlines are no event.
  bool may_rest = false;
  /// After so many samples a Fast DDS writer is followed by another; of reliable, volatile topics, others
  /// keep theirs. Readers of this bus are handed every sample once and in order, also those that a cut of the
  /// network held up meanwhile: the old writer stays until all it wrote has arrived, 5 s at most. Of
  /// exclusive topics the change waits for an instant at which nothing is under way, and may make a sample 15
  /// ms late, or half a deadline. To a reader that comes anew Fast DDS 2.9.1 counts all samples that the
  /// writer ever wrote, up to the newest, before it hands over one: a second for four million, which at 400
  /// Hz are three hours. 0: never.
  std::uint64_t successor_after = 250'000;
};

/// Publishes plain samples of type T on the topic of T (bus/topics/). Instantiated for every topic's type;
/// thread-safe.
template <class T>
class Writer {
 public:
  /// Throws BusError.
  Writer(Participant& participant, const WriterOptions& options = {});
  ~Writer();
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;

  /// False when the sample could not be handed to the network within the profile's blocking time (counted).
  bool write(const T& sample);
  [[nodiscard]] int matched_readers() const;
  /// As SampleInfo names it to readers; a successor has another.
  [[nodiscard]] WriterGuid guid() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace fathom::bus
