#pragma once

#include <concepts>
#include <type_traits>

#include "record/records.hpp"

/// The fields of every record, once for both directions: `io` is an Encoder or a Decoder (wire.hpp).
namespace fathom::record {

template <class R, class Of>
concept Like = std::same_as<std::remove_const_t<R>, Of>;

void fields(auto& io, Like<Header> auto& r) {
  io("profile", r.profile);
  io("library", r.library);
}
void fields(auto& io, Like<Footer> auto& r) {
  io("summary_start", r.summary_start);
  io("summary_offset_start", r.summary_offset_start);
  io("summary_crc", r.summary_crc);
}
void fields(auto& io, Like<Schema> auto& r) {
  io("id", r.id);
  io("name", r.name);
  io("encoding", r.encoding);
  io("data", r.data);
}
void fields(auto& io, Like<Channel> auto& r) {
  io("id", r.id);
  io("schema_id", r.schema_id);
  io("topic", r.topic);
  io("message_encoding", r.message_encoding);
  io("metadata", r.metadata);
}
void fields(auto& io, Like<Message> auto& r) {
  io("channel_id", r.channel_id);
  io("sequence", r.sequence);
  io("log_time", r.log_time);
  io("publish_time", r.publish_time);
  io.rest(r.data);
}
void fields(auto& io, Like<Chunk> auto& r) {
  io("message_start_time", r.message_start_time);
  io("message_end_time", r.message_end_time);
  io("uncompressed_size", r.uncompressed_size);
  io("uncompressed_crc", r.uncompressed_crc);
  io("compression", r.compression);
  io("records", r.records);
}
void fields(auto& io, Like<MessageIndex> auto& r) {
  io("channel_id", r.channel_id);
  io("records", r.records);
}
void fields(auto& io, Like<ChunkIndex> auto& r) {
  io("message_start_time", r.message_start_time);
  io("message_end_time", r.message_end_time);
  io("chunk_start_offset", r.chunk_start_offset);
  io("chunk_length", r.chunk_length);
  io("message_index_offsets", r.message_index_offsets);
  io("message_index_length", r.message_index_length);
  io("compression", r.compression);
  io("compressed_size", r.compressed_size);
  io("uncompressed_size", r.uncompressed_size);
}
void fields(auto& io, Like<Attachment> auto& r) {
  io("log_time", r.log_time);
  io("create_time", r.create_time);
  io("name", r.name);
  io("media_type", r.media_type);
  io("data", r.data);
  io("crc", r.crc);
}
void fields(auto& io, Like<AttachmentIndex> auto& r) {
  io("offset", r.offset);
  io("length", r.length);
  io("log_time", r.log_time);
  io("create_time", r.create_time);
  io("data_size", r.data_size);
  io("name", r.name);
  io("media_type", r.media_type);
}
void fields(auto& io, Like<Statistics> auto& r) {
  io("message_count", r.message_count);
  io("schema_count", r.schema_count);
  io("channel_count", r.channel_count);
  io("attachment_count", r.attachment_count);
  io("metadata_count", r.metadata_count);
  io("chunk_count", r.chunk_count);
  io("message_start_time", r.message_start_time);
  io("message_end_time", r.message_end_time);
  io("channel_message_counts", r.channel_message_counts);
}
void fields(auto& io, Like<Metadata> auto& r) {
  io("name", r.name);
  io("metadata", r.metadata);
}
void fields(auto& io, Like<MetadataIndex> auto& r) {
  io("offset", r.offset);
  io("length", r.length);
  io("name", r.name);
}
void fields(auto& io, Like<SummaryOffset> auto& r) {
  io("group_opcode", r.group_opcode);
  io("group_start", r.group_start);
  io("group_length", r.group_length);
}
void fields(auto& io, Like<DataEnd> auto& r) {
  io("data_section_crc", r.data_section_crc);
}

}  // namespace fathom::record
