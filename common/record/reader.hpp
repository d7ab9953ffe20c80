#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.hpp"
#include "record/contents.hpp"
#include "record/file.hpp"
#include "record/walk.hpp"

namespace fathom::record {

/// Which messages are read.
struct Selection {
  std::vector<std::string> topics{};                 ///< empty: all
  TimeNs from = std::numeric_limits<TimeNs>::min();  ///< first log time
  TimeNs to = std::numeric_limits<TimeNs>::max();    ///< log times before this one
};

/// How reading went. What cannot be used is left out and named; the rest is read.
struct Outcome {
  std::uint64_t messages = 0;
  std::vector<std::string> problems{};  ///< with their offsets; the first 100
};

/// Reads an MCAP file that may be anybody's, may end anywhere and may be damaged. A file without its summary
/// is gone through once when it is opened.
class Reader {
 public:
  /// False ends the reading. The channel belongs to the reader, the message's bytes are valid during the
  /// call.
  using Handler = std::function<bool(const Channel& channel, const Message& message)>;

  /// The error names the file and what is wrong with it.
  [[nodiscard]] static Result<Reader> open(const std::filesystem::path& path, const Limits& limits = {});
  [[nodiscard]] static Result<Reader> open(std::unique_ptr<Source> source, const Limits& limits = {});

  [[nodiscard]] const Contents& contents() const { return contents_; }
  /// Schema of a channel; nothing where it has none.
  [[nodiscard]] const Schema* schema_of(const Channel& channel) const;

  /// The messages of a selection in the order of the file; where chunks of several groups of channels were
  /// filled beside each other, in order of log time. Chunks without any are not read.
  Outcome read(const Selection& selection, const Handler& handler);

  /// The data of an attachment, held against its CRC.
  [[nodiscard]] Result<Bytes> attachment(const AttachmentIndex& index);
  /// That of a name; of several the last one.
  [[nodiscard]] Result<Bytes> attachment(std::string_view name);
  [[nodiscard]] Result<Metadata> metadata(const MetadataIndex& index);

  /// Holds the whole file against all it says of itself: lengths, offsets, CRCs, counts, indexes.
  Outcome check();

 private:
  Reader(std::unique_ptr<Source> source, Limits limits, Contents contents)
      : source_(std::move(source)), limits_(limits), contents_(std::move(contents)) {}

  struct Chosen;
  struct Unpacked;
  struct Group;
  [[nodiscard]] std::size_t beside(std::size_t first) const;
  [[nodiscard]] Result<std::unique_ptr<Unpacked>> unpack(const ChunkIndex& index);
  /// Groups from the chunk `first` on, some megabytes of them; at least one.
  [[nodiscard]] std::vector<Group> unpack_from(std::size_t first, const Chosen& chosen);
  /// False: the handler has enough.
  bool read_chunks(Group group, const Chosen& chosen, const Handler& handler, Outcome& outcome);
  bool hand_over(const Place& place, const Chosen& chosen, const Handler& handler, Outcome& outcome,
                 const Unpacked* chunk);
  void stream(const Chosen& chosen, const Handler& handler, Outcome& outcome);
  void check_indexes(Outcome& outcome);

  std::unique_ptr<Source> source_;
  Limits limits_;
  Contents contents_;
};

}  // namespace fathom::record
