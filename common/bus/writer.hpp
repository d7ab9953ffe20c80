#pragma once

#include <cstdint>
#include <optional>

#include "base/time.hpp"
#include "bus/detail/topic_ops.hpp"
#include "bus/detail/writer_core.hpp"
#include "bus/participant.hpp"

namespace fathom::bus {

struct WriterOptions {
  /// Promise to write at least this often (per instance). None: as the profile says.
  std::optional<DurationNs> deadline_ns;
  /// Strength on exclusive topics, on which readers get the samples of the strongest living writer.
  std::int32_t ownership_strength = 0;
  /// The writer may be silent on purpose while another one writes in its place. Its missed deadlines are then
  /// no event.
  bool may_rest = false;
  /// Number of samples after which a new Fast DDS writer takes the place of the old one, on reliable and
  /// volatile topics; 0: never. Readers of this bus get every sample once and in order, also samples that a
  /// cut of the network held up: the old writer stays until everything it wrote has arrived, 5 s at most. On
  /// exclusive topics the change waits until no sample is under way, and may make a sample 15 ms late, or
  /// half a deadline. The reason: for a new reader Fast DDS 2.9.1 counts all samples that the writer ever
  /// wrote before it hands over the first one. That takes a second for four million samples, which is three
  /// hours at 400 Hz.
  std::uint64_t successor_after = 250'000;
};

/// Publishes plain samples of type T on the topic of T (bus/topics/). Thread-safe.
template <class T>
class Writer {
 public:
  /// Throws BusError.
  explicit Writer(Participant& participant, const WriterOptions& options = {})
      : core_(participant, detail::topic_ops<T>(), options) {}
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;

  /// False when the sample could not be handed to the network within the profile's blocking time (counted).
  bool write(const T& sample) { return core_.write(&sample); }
  [[nodiscard]] int matched_readers() const { return core_.matched_readers(); }
  /// The identity in SampleInfo. A successor has another one.
  [[nodiscard]] WriterGuid guid() const { return core_.guid(); }

 private:
  detail::WriterCore core_;
};

}  // namespace fathom::bus
