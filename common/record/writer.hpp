#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "record/compression.hpp"
#include "record/contents.hpp"
#include "record/file.hpp"
#include "record/records.hpp"

namespace fathom::record {

struct WriterOptions {
  Compression compression = Compression::zstd;
  std::size_t chunk_bytes = 1U << 20U;  ///< a chunk is closed when it holds this much, unpacked
  std::string profile;
  std::string library = "fathom";
};

/// Messages of a channel that did not come into the file.
struct Lost {
  std::uint64_t count = 0;
  TimeNs first_time = 0;
  TimeNs last_time = 0;
};

/// Writes an MCAP file. Messages are gathered in one chunk for each group of channels; what was flushed can
/// be read by anybody whatever happens to this process afterwards. Functions that touch the file return why
/// they failed, or nothing. After a failure the messages of the open chunk are dropped (take_lost() says
/// which), the file stands as it was, and writing may go on. Not thread-safe.
class Writer {
 public:
  Writer(std::unique_ptr<Sink> sink, const WriterOptions& options);

  /// Writes the beginning of the file. Call it first.
  [[nodiscard]] std::string begin();

  /// Their records are written with the first message that needs them.
  std::uint16_t add_schema(const std::string& name, const std::string& encoding, const std::string& data);
  /// Channels of one group share chunks, so that whoever reads a group need not unpack the others. Its number
  /// stands in the channel's metadata.
  std::uint16_t add_channel(std::uint16_t schema_id, const std::string& topic,
                            const std::string& message_encoding, const TextMap& metadata = {},
                            unsigned group = 0);

  /// Precondition: channel_id is of add_channel().
  [[nodiscard]] std::string write(const Message& message);
  /// Closes the open chunks, of all groups.
  [[nodiscard]] std::string flush();
  /// See Sink::sync().
  [[nodiscard]] std::string sync() { return sink_->sync(); }
  [[nodiscard]] bool is_removed() const { return sink_->is_removed(); }
  [[nodiscard]] bool is_at(const std::filesystem::path& path) const { return sink_->is_at(path); }

  /// Its CRC is computed. Closes the open chunks before.
  [[nodiscard]] std::string attach(Attachment attachment);
  /// Closes the open chunks before.
  [[nodiscard]] std::string add(const Metadata& metadata);

  /// Closes the file: chunk, data end, summary, footer. Nothing may be written afterwards.
  [[nodiscard]] std::string finish();

  [[nodiscard]] std::uint64_t size() const;
  [[nodiscard]] std::uint64_t messages() const { return contents_.statistics.message_count; }  ///< flushed
  /// What was dropped since the last call, by channel.
  [[nodiscard]] std::map<std::uint16_t, Lost> take_lost() { return std::exchange(lost_, {}); }

 private:
  /// A chunk that is being filled.
  struct Open {
    Bytes bytes;
    std::set<std::uint16_t> channels;  ///< whose records are in the file or in this chunk
    std::set<std::uint16_t> schemas;   ///< likewise, as far as this group put them there
    std::map<std::uint16_t, MessageIndex> index;
    std::vector<std::pair<std::uint16_t, TimeNs>> messages;

    void clear();
  };

  [[nodiscard]] std::string put(View bytes);
  void describe(Open& open, std::uint16_t channel_id);
  [[nodiscard]] std::string flush(Open& open);

  std::unique_ptr<Sink> sink_;
  WriterOptions options_;
  Compressor compressor_;
  std::map<std::uint16_t, Schema> schemas_;  // all that were added
  std::map<std::uint16_t, Channel> channels_;
  Contents contents_;  // of what is in the file
  std::uint32_t crc_ = 0;

  std::map<unsigned, Open> open_;           // by group
  std::map<std::uint16_t, Open*> open_of_;  // by channel
  Bytes packed_;
  Bytes out_;
  std::map<std::uint16_t, Lost> lost_;
};

}  // namespace fathom::record
