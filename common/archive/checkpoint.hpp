#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "base/result.hpp"
#include "base/time.hpp"

namespace fathom::archive {

/// The label of a checkpoint: whose state it holds, and of when.
struct CheckpointLabel {
  std::string vehicle;
  std::string service;
  std::string configuration;  ///< hash of the effective configuration
  std::string build;          ///< of the executable that wrote it; for people, nothing depends on it
  TimeNs stamp_ns = 0;        ///< UTC instant of the navigation state in it
};

struct Checkpoint {
  CheckpointLabel label;
  std::vector<std::byte> archive;
};

/// Writes a checkpoint as bytes: a magic word, the version of this format, CRC-32 of all that follows, the
/// label, the archive. Replaces the content of `out` and keeps its capacity.
void encode(const CheckpointLabel& label, std::span<const std::byte> archive, std::vector<std::byte>& out);

/// Reads a checkpoint. The error says what is wrong with the bytes.
[[nodiscard]] Result<Checkpoint> decode(std::span<const std::byte> bytes);

/// Why `own` must not go on from a state of `found` at own.stamp_ns, in words. Empty when it may.
[[nodiscard]] std::string objection(const CheckpointLabel& found, const CheckpointLabel& own,
                                    double max_age_s);

}  // namespace fathom::archive
