#include "record/writer.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

#include "base/little_endian.hpp"
#include "record/wire.hpp"

namespace fathom::record {

Writer::Writer(std::unique_ptr<Sink> sink, const WriterOptions& options)
    : sink_(std::move(sink)), options_(options), compressor_(options.compression) {}

std::string Writer::put(View bytes) {
  if (std::string why = sink_->append(bytes); !why.empty()) return why;
  crc_ = crc32(bytes, crc_);
  return {};
}

std::string Writer::begin() {
  out_.assign(kMagic.begin(), kMagic.end());
  append(out_, Header{options_.profile, options_.library});
  return put(out_);
}

std::uint16_t Writer::add_schema(const std::string& name, const std::string& encoding,
                                 const std::string& data) {
  const auto id = static_cast<std::uint16_t>(schemas_.size() + 1);
  schemas_[id] = {id, name, encoding, data};
  return id;
}

std::uint16_t Writer::add_channel(std::uint16_t schema_id, const std::string& topic,
                                  const std::string& message_encoding, const TextMap& metadata) {
  const auto id = static_cast<std::uint16_t>(channels_.size() + 1);
  channels_[id] = {id, schema_id, topic, message_encoding, metadata};
  return id;
}

/// Schema and channel come into the chunk before the first message that needs them.
void Writer::describe(std::uint16_t channel_id) {
  if (!described_.insert(channel_id).second) return;
  const Channel& channel = channels_.at(channel_id);
  const bool schema_is_there = std::any_of(described_.begin(), described_.end(), [&](std::uint16_t other) {
    return other != channel_id && channels_.at(other).schema_id == channel.schema_id;
  });
  if (channel.schema_id != 0 && !schema_is_there) append(chunk_, schemas_.at(channel.schema_id));
  append(chunk_, channel);
}

std::string Writer::write(const Message& message) {
  describe(message.channel_id);
  MessageIndex& index = index_[message.channel_id];
  index.channel_id = message.channel_id;
  index.records.emplace_back(message.log_time, chunk_.size());
  append(chunk_, message);
  open_.emplace_back(message.channel_id, message.log_time);
  return chunk_.size() >= options_.chunk_bytes ? flush() : std::string();
}

void Writer::close_chunk() {
  chunk_.clear();
  index_.clear();
  open_.clear();
}

std::string Writer::flush() {
  if (open_.empty()) return {};
  const auto [earliest, latest] = std::minmax_element(
      open_.begin(), open_.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  compressor_.pack(chunk_, packed_);
  Chunk chunk{earliest->second,
              latest->second,
              chunk_.size(),
              crc32(chunk_),
              std::string(to_string(compressor_.kind())),
              packed_};
  out_.clear();
  append(out_, chunk);
  ChunkIndex entry{chunk.message_start_time, chunk.message_end_time, sink_->size(), out_.size(), {}, 0,
                   chunk.compression,        packed_.size(),         chunk_.size()};
  for (const auto& [channel, index] : index_) {
    entry.message_index_offsets[channel] = sink_->size() + out_.size();
    append(out_, index);
  }
  entry.message_index_length = out_.size() - entry.chunk_length;
  std::string why = put(out_);
  if (why.empty()) {
    contents_.chunks.push_back(std::move(entry));
    for (const auto& [channel, log_time] : open_) {
      count(contents_.statistics, channel, log_time, contents_.statistics.message_count);
      if (!contents_.channels.contains(channel)) {
        const Channel& one = contents_.channels[channel] = channels_.at(channel);
        if (one.schema_id != 0) contents_.schemas[one.schema_id] = schemas_.at(one.schema_id);
      }
    }
  } else {
    for (const auto& [channel, log_time] : open_) {
      Lost& lost = lost_[channel];
      if (lost.count++ == 0) lost.first_time = log_time;
      lost.last_time = log_time;
    }
    // Whatever was described in this chunk alone has to be described again.
    std::erase_if(described_, [&](std::uint16_t id) { return !contents_.channels.contains(id); });
  }
  close_chunk();
  return why;
}

std::string Writer::attach(Attachment attachment) {
  if (std::string why = flush(); !why.empty()) return why;
  out_.clear();
  attachment.crc = 0;
  append(out_, attachment);
  const std::size_t crc_at = out_.size() - sizeof attachment.crc;
  const std::uint32_t crc = crc32(View(out_).subspan(kRecordHead, crc_at - kRecordHead));
  store_le<std::uint32_t>(out_, crc_at, crc);
  const std::uint64_t offset = sink_->size();
  if (std::string why = put(out_); !why.empty()) return why;
  contents_.attachments.push_back({offset, out_.size(), attachment.log_time, attachment.create_time,
                                   attachment.data.size(), attachment.name, attachment.media_type});
  return {};
}

std::string Writer::add(const Metadata& metadata) {
  if (std::string why = flush(); !why.empty()) return why;
  out_.clear();
  append(out_, metadata);
  const std::uint64_t offset = sink_->size();
  if (std::string why = put(out_); !why.empty()) return why;
  contents_.metadata.push_back({offset, out_.size(), metadata.name});
  return {};
}

std::string Writer::finish() {
  if (std::string why = flush(); !why.empty()) return why;
  contents_.end_of_data = sink_->size();
  if (std::string why = sink_->append(closing(contents_, crc_)); !why.empty()) return why;
  return sink_->sync();
}

}  // namespace fathom::record
