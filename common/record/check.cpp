// Holding a whole file against all it says of itself.

#include <map>
#include <utility>

#include "record/reader.hpp"
#include "record/scan.hpp"
#include "record/wire.hpp"

namespace fathom::record {
namespace {

/// Where the messages of a chunk are, as its message indexes should say.
std::map<std::uint16_t, MessageIndex> indexes_of(View records) {
  std::map<std::uint16_t, MessageIndex> out;
  MemoryWalk walk(records);
  for (Place place; walk.next(place);) {
    if (place.op != Op::message) continue;
    const auto message = parse<Message>(place.content);
    if (!message) continue;
    MessageIndex& index = out[message.value().channel_id];
    index.channel_id = message.value().channel_id;
    index.records.emplace_back(message.value().log_time, place.offset);
  }
  return out;
}

}  // namespace

void Reader::check_indexes(Outcome& outcome) {
  for (const ChunkIndex& chunk : contents_.chunks) {
    const std::uint64_t end = chunk.chunk_start_offset + chunk.chunk_length;
    Walk walk(*source_, chunk.chunk_start_offset, end + chunk.message_index_length, limits_);
    Place place;
    if (!walk.next(place)) continue;  // known from reading it
    const auto head = parse<Chunk>(place.content);
    if (!head) continue;
    const auto records = open_chunk(head.value(), limits_);
    if (!records) continue;
    auto expected = indexes_of(records.value());
    std::size_t found = 0;
    while (walk.next(place)) {
      const auto index = parse<MessageIndex>(place.content);
      if (place.op != Op::message_index || !index) {
        note(outcome.problems, place.offset, "a " + to_string(place.op) + ", expected a message index");
        continue;
      }
      const std::uint16_t channel = index.value().channel_id;
      const auto place_in_summary = chunk.message_index_offsets.find(channel);
      if (place_in_summary == chunk.message_index_offsets.end() || place_in_summary->second != place.offset ||
          expected[channel].records != index.value().records) {
        note(outcome.problems, place.offset, "message index: it does not fit its chunk");
      }
      ++found;
    }
    if (!walk.fault().empty()) note(outcome.problems, walk.at(), walk.fault());
    if (found != expected.size())
      note(outcome.problems, end,
           "message index: " + std::to_string(found) + " of a chunk, expected " +
               std::to_string(expected.size()));
  }
}

Outcome Reader::check() {
  std::map<std::uint16_t, std::uint64_t> counts;
  Outcome outcome = read({}, [&](const Channel& channel, const Message&) {
    ++counts[channel.id];
    return true;
  });
  if (!contents_.ending.empty()) note(outcome.problems, contents_.end_of_data, contents_.ending);
  for (const AttachmentIndex& one : contents_.attachments) {
    if (const auto data = attachment(one); !data) note(outcome.problems, one.offset, data.error().message);
  }
  for (const MetadataIndex& one : contents_.metadata) {
    if (const auto data = metadata(one); !data) note(outcome.problems, one.offset, data.error().message);
  }
  check_indexes(outcome);
  if (!contents_.indexed) return outcome;
  const Statistics& said = contents_.statistics;
  if (outcome.messages != said.message_count || counts != said.channel_message_counts) {
    note(outcome.problems, contents_.end_of_data,
         "statistics: " + std::to_string(said.message_count) + " messages, but " +
             std::to_string(outcome.messages) + " are there");
  }
  // The data end is the record before the summary.
  const std::uint64_t at = contents_.end_of_data - kRecordHead - sizeof(DataEnd::data_section_crc);
  Walk walk(*source_, at, contents_.end_of_data, limits_);
  Place place;
  const bool there = walk.next(place) && place.op == Op::data_end;
  const auto end = there ? parse<DataEnd>(place.content) : Result<DataEnd>(Error{"no data end"});
  if (!end) {
    note(outcome.problems, at, "there is no data end before the summary");
  } else if (end.value().data_section_crc != 0) {
    const auto crc = crc_of(*source_, at);
    if (!crc || crc.value() != end.value().data_section_crc)
      note(outcome.problems, at, "data end: the bytes of the file do not fit its CRC");
  }
  return outcome;
}

}  // namespace fathom::record
