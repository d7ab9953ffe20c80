#include "record/writer.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

#include "base/bytes/little_endian.hpp"
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
                                  const std::string& message_encoding, const TextMap& metadata,
                                  unsigned group) {
  const auto id = static_cast<std::uint16_t>(channels_.size() + 1);
  Channel& channel = channels_[id] = {id, schema_id, topic, message_encoding, metadata};
  if (group != 0) channel.metadata[kChunkGroup] = std::to_string(group);
  open_of_[id] = &open_[group];
  return id;
}

std::uint64_t Writer::size() const {
  std::uint64_t sum = sink_->size();
  for (const auto& [group, open] : open_) sum += open.bytes.size();
  return sum;
}

/// Schema and channel come into the chunk before the first message that needs them.
void Writer::describe(Open& open, std::uint16_t channel_id) {
  if (!open.channels.insert(channel_id).second) return;
  const Channel& channel = channels_.at(channel_id);
  if (channel.schema_id != 0 && open.schemas.insert(channel.schema_id).second)
    append(open.bytes, schemas_.at(channel.schema_id));
  append(open.bytes, channel);
}

std::string Writer::write(const Message& message) {
  Open& open = *open_of_.at(message.channel_id);
  describe(open, message.channel_id);
  MessageIndex& index = open.index[message.channel_id];
  index.channel_id = message.channel_id;
  index.records.emplace_back(message.log_time, open.bytes.size());
  append(open.bytes, message);
  open.messages.emplace_back(message.channel_id, message.log_time);
  return open.bytes.size() >= options_.chunk_bytes ? flush() : std::string();
}

void Writer::Open::clear() {
  bytes.clear();
  index.clear();
  messages.clear();
}

std::string Writer::flush() {
  std::string first;
  for (auto& [group, open] : open_) {
    const std::string why = flush(open);
    if (first.empty()) first = why;
  }
  return first;
}

std::string Writer::flush(Open& open) {
  if (open.messages.empty()) return {};
  const auto [earliest, latest] =
      std::minmax_element(open.messages.begin(), open.messages.end(),
                          [](const auto& a, const auto& b) { return a.second < b.second; });
  compressor_.pack(open.bytes, packed_);
  Chunk chunk{earliest->second,
              latest->second,
              open.bytes.size(),
              crc32(open.bytes),
              std::string(to_string(compressor_.kind())),
              packed_};
  out_.clear();
  append(out_, chunk);
  ChunkIndex entry{chunk.message_start_time, chunk.message_end_time, sink_->size(),    out_.size(), {}, 0,
                   chunk.compression,        packed_.size(),         open.bytes.size()};
  for (const auto& [channel, index] : open.index) {
    entry.message_index_offsets[channel] = sink_->size() + out_.size();
    append(out_, index);
  }
  entry.message_index_length = out_.size() - entry.chunk_length;
  std::string why = put(out_);
  if (why.empty()) {
    contents_.chunks.push_back(std::move(entry));
    for (const auto& [channel, log_time] : open.messages) {
      count(contents_.statistics, channel, log_time, contents_.statistics.message_count);
      if (!contents_.channels.contains(channel)) {
        const Channel& one = contents_.channels[channel] = channels_.at(channel);
        if (one.schema_id != 0) contents_.schemas[one.schema_id] = schemas_.at(one.schema_id);
      }
    }
  } else {
    for (const auto& [channel, log_time] : open.messages) {
      Lost& lost = lost_[channel];
      if (lost.count++ == 0) lost.first_time = log_time;
      lost.last_time = log_time;
    }
    // Whatever was described in this chunk alone has to be described again.
    std::erase_if(open.channels, [&](std::uint16_t id) { return !contents_.channels.contains(id); });
    open.schemas.clear();
    for (const std::uint16_t id : open.channels) open.schemas.insert(channels_.at(id).schema_id);
  }
  open.clear();
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
