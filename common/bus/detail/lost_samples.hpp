#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <mutex>

#include "bus/detail/network/peer_book.hpp"

namespace fathom::bus::detail {

/// Counts the samples that a reader should have had and did not have, by their numbers, which each writer
/// gives out one by one. Fast DDS 2.9.1 tells of such a sample in one case of three: not when the writer
/// answers that it no longer has it, and not when newer ones take its place in the reader. Samples of one
/// writer may be taken in any order. Thread-safe.
class LostSamples {
 public:
  void matched(const WriterGuid& writer) {
    const std::lock_guard lock(mutex_);
    writers_.try_emplace(writer);
  }
  void unmatched(const WriterGuid& writer) {
    const std::lock_guard lock(mutex_);
    writers_.erase(writer);
  }
  void clear() {
    const std::lock_guard lock(mutex_);
    writers_.clear();
  }

  /// Notes a sample that was taken; of a writer that is not matched it does nothing. What its writer wrote
  /// before the first one of them is not counted.
  void taken(const WriterGuid& writer, std::uint64_t number) {
    const std::lock_guard lock(mutex_);
    const auto found = writers_.find(writer);
    if (found == writers_.end()) return;
    Writer& of = found->second;
    of.first = of.taken == 0 ? number : std::min(of.first, number);
    of.last = std::max(of.last, number);
    ++of.taken;
  }
  /// Notes that all that could be taken was taken. Returns how many were lost since it was last called.
  [[nodiscard]] std::uint64_t settle() {
    const std::lock_guard lock(mutex_);
    std::uint64_t lost = 0;
    for (auto& [guid, of] : writers_) {
      const std::uint64_t wanted = of.taken == 0 ? 0 : of.last - of.first + 1;
      const std::uint64_t known = of.taken + of.lost;
      if (wanted <= known) continue;
      lost += wanted - known;
      of.lost += wanted - known;
    }
    return lost;
  }

 private:
  struct Writer {
    std::uint64_t first = 0;
    std::uint64_t last = 0;
    std::uint64_t taken = 0;
    std::uint64_t lost = 0;
  };
  std::mutex mutex_;
  std::map<WriterGuid, Writer> writers_;
};

}  // namespace fathom::bus::detail
