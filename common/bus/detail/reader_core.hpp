#pragma once

#include <functional>
#include <memory>

#include "bus/participant.hpp"

namespace fathom::bus {

struct ReaderOptions;
struct SampleInfo;

namespace detail {

struct TopicOps;

/// Reader<T> without the T: the one place that creates a Fast DDS reader.
class ReaderCore {
 public:
  using Handler = std::function<void(const void* sample, const SampleInfo& info)>;

  /// `raw`: the handler gets a RawSample (detail/sample_type.hpp), whatever the bytes are.
  ReaderCore(Participant& participant, const TopicOps& ops, Handler handler, const ReaderOptions& options,
             bool raw = false);
  ~ReaderCore();
  [[nodiscard]] int matched_writers() const;

  struct Impl;

 private:
  std::unique_ptr<Impl> impl_;
};

}  // namespace detail
}  // namespace fathom::bus
