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
  /// As SampleInfo names it to readers.
  [[nodiscard]] const WriterGuid& guid() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace fathom::bus
