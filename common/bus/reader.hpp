#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>

#include "base/time.hpp"
#include "bus/detail/reader_core.hpp"
#include "bus/detail/topic_ops.hpp"
#include "bus/participant.hpp"

namespace fathom::bus {

struct ReaderOptions {
  /// Longest time between two samples of an instance. A miss is counted and reported. None: as in the
  /// profile.
  std::optional<DurationNs> deadline_ns;
  /// Variant of the QoS profile. "" is the topic's own profile. "deep" is for readers that must not miss a
  /// sample: the profile "<topic>.deep" where there is one, else the topic's own, which is deep already.
  std::string profile_suffix;
};

/// Who wrote a sample and when.
struct SampleInfo {
  WriterGuid writer_guid{};
  TimeNs source_ns = 0;     ///< the writer's clock at write()
  TimeNs reception_ns = 0;  ///< this host's clock at arrival
};

/// Receives plain samples of type T from the topic of T.
template <class T>
class Reader {
 public:
  using Handler = std::function<void(const T& sample, const SampleInfo& info)>;

  /// `handler` runs on a thread of the bus, one sample at a time per reader, until the destructor returns. It
  /// must be quick, because other topics of this participant wait, or hand over to another thread. It must
  /// not throw, and must not destroy the reader. Throws BusError.
  Reader(Participant& participant, Handler handler, const ReaderOptions& options = {})
      : core_(
            participant, detail::topic_ops<T>(),
            [handler = std::move(handler)](const void* sample, const SampleInfo& info) {
              handler(*static_cast<const T*>(sample), info);
            },
            options) {}
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;

  [[nodiscard]] int matched_writers() const { return core_.matched_writers(); }

 private:
  detail::ReaderCore core_;
};

}  // namespace fathom::bus
