#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "bus/participant.hpp"

namespace fathom::bus {

struct WriterOptions;

namespace detail {

struct TopicOps;

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

}  // namespace detail
}  // namespace fathom::bus
