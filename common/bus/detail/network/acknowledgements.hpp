#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <mutex>
#include <utility>

#include "bus/detail/network/delivery_watch.hpp"
#include "bus/detail/network/peer_book.hpp"

namespace fathom::bus::detail {

/// What a reader says that it has of a writer of ours (an ACKNACK).
struct Acknowledgement {
  WriterGuid reader{};  ///< a GUID as any other
  EntityId writer = 0;
  std::uint64_t base = 0;   ///< it has all samples below; 0: it has just met the writer
  std::uint32_t count = 0;  ///< goes up from one to the next
  std::size_t at = 0;       ///< where its content begins in the datagram
};

/// Finds readers that have forgotten what they acknowledged before.
///
/// A process that stood still for longer than its lease is given up by the others and met again when it goes
/// on. It has not given them up when it reads what waits in its sockets before it looks at their leases. Its
/// writers, those of discovery as well, go on where they were, and the others' readers begin anew.
/// Fast DDS 2.9.1 has a way for that: a reader that has just met a writer acknowledges "0", and a writer
/// which hears that offers all samples again. But the reader does so only after 70 ms, and not at all when a
/// heartbeat came before. Then it asks for sample 1 and those that follow, and a writer that holds them for
/// acknowledged answers nothing, ever. Where that is the writer that tells of a process's readers, the other
/// never learns of them and sends no samples: the process lives, is heard, and hears nothing.
/// So an acknowledgement that goes back has to be taken for a "0". Thread-safe.
class AcknowledgementBook {
 public:
  /// A participant is present. What is not known to be present is not remembered.
  void seen(const GuidPrefix& participant);
  void gone(const GuidPrefix& participant);

  /// True when the reader has forgotten what it acknowledged before. What it says next counts from this.
  [[nodiscard]] bool goes_back(const Acknowledgement& one);

 private:
  struct Last {
    std::uint64_t base = 0;
    std::uint32_t count = 0;
  };
  /// More readers and writers than any two participants have. Who names more is forgotten.
  static constexpr std::size_t kMostPairs = 4096;

  std::mutex mutex_;
  std::map<GuidPrefix, std::map<std::pair<EntityId, EntityId>, Last>> last_;
};

}  // namespace fathom::bus::detail
