#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "base/result.hpp"
#include "base/time.hpp"

namespace fathom::fusion {

/// Whose state a checkpoint holds, and of when.
struct CheckpointLabel {
  std::string vehicle;
  std::string service;
  std::string configuration;  ///< hash of the effective configuration
  std::string build;          ///< of the executable that wrote it: to be told, nothing hangs on it
  TimeNs stamp_ns = 0;        ///< UTC instant of the navigation state in it
};

struct Checkpoint {
  CheckpointLabel label;
  std::vector<std::byte> image;
};

/// A checkpoint as bytes: a magic word, the version of this format, CRC-32 of all that follows, the label,
/// the image. Replaces what `out` holds and keeps its capacity.
void encode(const CheckpointLabel& label, std::span<const std::byte> image, std::vector<std::byte>& out);

/// The way back; the error says what is wrong with the bytes.
[[nodiscard]] Result<Checkpoint> decode(std::span<const std::byte> bytes);

/// Why a state of `found` is not to be gone on from by `own` at own.stamp_ns, in words; empty when it is.
[[nodiscard]] std::string objection(const CheckpointLabel& found, const CheckpointLabel& own,
                                    double max_age_s);

/// The whole file. The error says why there is none.
[[nodiscard]] Result<std::vector<std::byte>> read_file(const std::filesystem::path& path);

/// Writes beside `path`, then renames: whoever reads finds the old file or the new one, whole. With `sync` it
/// is on the disk when this returns. Missing folders are made. Empty when done, else why not.
[[nodiscard]] std::string replace_file(const std::filesystem::path& path, std::span<const std::byte> bytes,
                                       bool sync);

/// What tells this executable from every other one: its release and a checksum of its file.
[[nodiscard]] std::string build_of_this_executable();

}  // namespace fathom::fusion
