#pragma once

#include "archive/visitor.hpp"

namespace fathom::estimation {

/// Of what an engine saves: goes up where a release writes other fields than the one before it. What came
/// with a version stands in `if (archive.since(VERSION))`; a kind of sample has archive::kSince.
inline constexpr std::uint32_t kStateVersion = 22;

/// Begins an engine's state.
struct StateHead {
  static constexpr std::uint64_t kMagic = 0x32'45'4E'49'47'4E'45'46;  // "FENGINE2"

  template <class Archive, class Self>
  static void fields(Archive& archive, Self& self) {
    archive("magic", self.magic);
    if constexpr (Archive::kReads) archive.expect(self.magic == kMagic, "magic", "the state of an engine");
    archive("version", self.version, fathom::archive::Whole{1, kStateVersion});
    archive("layout", self.layout);
    if (self.version < 2) skip_count_of_orders(archive);
    archive("sequence", self.sequence);
    archive("stamp_ns", self.stamp_ns, fathom::archive::kInstant);
    archive("received_ns", self.received_ns, fathom::archive::kAnyWhole);
  }

  /// Until version 1 orders were told apart by the number in which they came.
  template <class Archive>
  static void skip_count_of_orders(Archive& archive) {
    std::uint64_t commands = 0;
    archive("commands", commands);
  }

  std::uint64_t magic = kMagic;
  std::uint32_t version = kStateVersion;
  std::uint64_t layout = 0;  ///< archive::Layout of that version
  // Of the newest navigation state.
  std::uint64_t sequence = 0;
  TimeNs stamp_ns = 0;
  TimeNs received_ns = 0;
};

}  // namespace fathom::estimation
