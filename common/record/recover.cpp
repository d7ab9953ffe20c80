#include "record/recover.hpp"

#include <algorithm>

#include "record/contents.hpp"
#include "record/file.hpp"
#include "record/scan.hpp"
#include "record/wire.hpp"

namespace fathom::record {
namespace {

/// Writes the message indexes of the last chunk anew where some are missing; where the data ends then.
Result<Bytes> mend_last_chunk(Source& source, const Limits& limits, Contents& contents) {
  Bytes out;
  if (contents.chunks.empty()) return out;
  ChunkIndex& chunk = contents.chunks.back();
  const std::uint64_t chunk_end = chunk.chunk_start_offset + chunk.chunk_length;
  if (contents.end_of_data != chunk_end + chunk.message_index_length) return out;  // others follow it
  Walk walk(source, chunk.chunk_start_offset, chunk_end, limits);
  Place place;
  if (!walk.next(place)) return Error{walk.fault()};
  const auto head = parse<Chunk>(place.content);
  if (!head) return out;
  const auto records = open_chunk(head.value(), limits);
  if (!records) return out;  // it cannot be read, and needs no index
  std::map<std::uint16_t, MessageIndex> indexes;
  MemoryWalk inside(records.value());
  for (Place record; inside.next(record);) {
    const auto message = record.op == Op::message ? parse<Message>(record.content) : Result<Message>(Error{});
    if (!message) continue;
    MessageIndex& index = indexes[message.value().channel_id];
    index.channel_id = message.value().channel_id;
    index.records.emplace_back(message.value().log_time, record.offset);
  }
  if (indexes.size() == chunk.message_index_offsets.size()) return out;
  contents.end_of_data = chunk_end;
  chunk.message_index_offsets.clear();
  for (const auto& [channel, index] : indexes) {
    chunk.message_index_offsets[channel] = chunk_end + out.size();
    append(out, index);
  }
  chunk.message_index_length = out.size();
  return out;
}

std::string keep_rest(Source& source, std::uint64_t from, const std::filesystem::path& path) {
  auto sink = FileSink::create(path);
  if (!sink) return sink.error().message;
  constexpr std::uint64_t kBlock = 1U << 20U;
  Bytes block;
  for (std::uint64_t at = from; at < source.size(); at += block.size()) {
    block.resize(static_cast<std::size_t>(std::min(kBlock, source.size() - at)));
    std::string why = source.read(at, block);
    if (why.empty()) why = sink.value()->append(block);
    if (!why.empty()) return path.string() + ": " + why;
  }
  return sink.value()->sync();
}

}  // namespace

Result<Recovery> recover(const std::filesystem::path& path, const Limits& limits, std::uint64_t kept_rest) {
  auto source = FileSource::open(path);
  if (!source) return source.error();
  const auto named = [&](const std::string& what) { return Error{path.string() + ": " + what}; };
  Recovery out;
  const auto summary = read_summary(*source.value(), limits);
  if (summary) {
    out.was_whole = true;
    out.messages = summary.value().statistics.message_count;
    return out;
  }
  auto found = scan(*source.value(), limits);
  if (!found) return named(found.error().message);
  Contents& contents = found.value();
  out.ending = contents.ending;
  out.messages = contents.statistics.message_count;
  out.cut = source.value()->size() - contents.end_of_data;
  const auto indexes = mend_last_chunk(*source.value(), limits, contents);
  if (!indexes) return named(indexes.error().message);
  for (ChunkIndex& chunk : contents.chunks) {  // of a damaged chunk, whose channels are not known
    std::erase_if(chunk.message_index_offsets,
                  [&](const auto& entry) { return !contents.channels.contains(entry.first); });
  }
  if (out.cut > kept_rest) {
    out.rest = path;
    out.rest += ".rest";
    if (std::string why = keep_rest(*source.value(), contents.end_of_data, out.rest); !why.empty())
      return Error{why};
  }
  const auto crc = crc_of(*source.value(), contents.end_of_data);
  if (!crc) return named(crc.error().message);
  auto sink = FileSink::go_on(path, contents.end_of_data);
  if (!sink) return sink.error();
  Bytes end = indexes.value();
  contents.end_of_data += end.size();
  const Bytes close = closing(contents, crc32(indexes.value(), crc.value()));
  end.insert(end.end(), close.begin(), close.end());
  std::string why = sink.value()->append(end);
  if (why.empty()) why = sink.value()->sync();
  if (!why.empty()) return named(why);
  return out;
}

}  // namespace fathom::record
