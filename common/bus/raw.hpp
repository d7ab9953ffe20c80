#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bus/participant.hpp"
#include "bus/reader.hpp"
#include "bus/writer.hpp"
#include "samples/header.hpp"

namespace fathom::bus {

/// Whether late readers of a topic get its last samples. Throws BusError when there is no such topic.
[[nodiscard]] bool is_latched(Participant& participant, const std::string& topic);

/// The key of a sample in words, e.g. "auv/gps0"; nothing when the bytes are no sample of the topic's type.
[[nodiscard]] std::optional<std::string> key_of(std::string_view topic, std::span<const std::uint8_t> bytes);

/// The bytes of a sample whose header `change` has changed; nothing when they are none.
[[nodiscard]] std::optional<std::vector<std::uint8_t>> with_header(
    std::string_view topic, std::span<const std::uint8_t> bytes,
    const std::function<void(SampleHeader&)>& change);

/// Receives the samples of any topic of all_topics() as the bytes that travelled: CDR with its encapsulation
/// header, in the byte order of the writer's host, not decoded and not checked. It meets the same writers as
/// the topic's Reader, and both may be there at once.
class RawReader {
 public:
  using Handler = std::function<void(std::span<const std::uint8_t> bytes, const SampleInfo& info)>;

  /// As of Reader. Throws BusError, also when there is no such topic.
  RawReader(Participant& participant, std::string_view topic, Handler handler,
            const ReaderOptions& options = {});
  ~RawReader();
  RawReader(const RawReader&) = delete;
  RawReader& operator=(const RawReader&) = delete;

  [[nodiscard]] int matched_writers() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Publishes such bytes.
class RawWriter {
 public:
  /// As of Writer. Throws BusError, also when there is no such topic.
  RawWriter(Participant& participant, std::string_view topic, const WriterOptions& options = {});
  ~RawWriter();
  RawWriter(const RawWriter&) = delete;
  RawWriter& operator=(const RawWriter&) = delete;

  /// False when the bytes are no sample of the topic's type, which is not sent, and as of Writer.
  bool write(std::vector<std::uint8_t> bytes);
  [[nodiscard]] int matched_readers() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace fathom::bus
