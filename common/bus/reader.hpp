#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "base/time.hpp"
#include "bus/participant.hpp"

namespace fathom::bus {

struct ReaderOptions {
  /// Expect at least one sample this often per instance; a miss is counted and reported. None: as the profile
  /// says.
  std::optional<DurationNs> deadline_ns;
  /// Variant of the QoS profile: "" the topic's own; "deep" for recorders, which must not miss a sample: the
  /// profile "<topic>.deep" where there is one, else the topic's own, which is deep already.
  std::string profile_suffix;
};

/// Who wrote a sample and when.
struct SampleInfo {
  WriterGuid writer_guid{};
  TimeNs source_ns = 0;     ///< the writer's clock at write()
  TimeNs reception_ns = 0;  ///< this host's clock at arrival
};

/// Receives plain samples of type T from the topic of T. Instantiated for every topic's type.
template <class T>
class Reader {
 public:
  using Handler = std::function<void(const T& sample, const SampleInfo& info)>;

  /// `handler` runs on a thread of the bus, one sample at a time per reader, until the destructor returns: be
  /// quick (other topics of this participant wait), or hand over to a thread of your own; do not throw, and
  /// do not destroy the reader in it. Throws BusError.
  Reader(Participant& participant, Handler handler, const ReaderOptions& options = {});
  ~Reader();
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;

  [[nodiscard]] int matched_writers() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace fathom::bus
