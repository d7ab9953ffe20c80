#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "bus/detail/topic_ops.hpp"
#include "bus/participant.hpp"
#include "bus/reader.hpp"
#include "bus/writer.hpp"

namespace fathom::bus::detail {

/// Writer<T> without the T: the one place that creates a Fast DDS writer.
class WriterCore {
 public:
  WriterCore(Participant& participant, const TopicOps& ops, const WriterOptions& options);
  ~WriterCore();
  bool write(const void* sample);
  /// The bytes of a sample as they are. Those of none are not written: false.
  bool write_raw(std::vector<std::uint8_t> bytes);
  [[nodiscard]] int matched_readers() const;
  [[nodiscard]] WriterGuid guid() const;

  struct Impl;

 private:
  std::unique_ptr<Impl> impl_;
};

/// Reader<T> without the T.
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

/// The operations of every topic, in the order of all_topics().
[[nodiscard]] const std::vector<const TopicOps*>& all_topic_ops();

/// Behind to_cdr and from_cdr.
std::vector<std::uint8_t> encode(const TopicOps& ops, const void* sample);
bool decode(const TopicOps& ops, std::span<const std::uint8_t> bytes, void* sample);

}  // namespace fathom::bus::detail
