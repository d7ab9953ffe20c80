#include "record/reader.hpp"

#include <algorithm>
#include <cstdlib>
#include <future>
#include <set>
#include <utility>

#include "record/scan.hpp"
#include "record/wire.hpp"

namespace fathom::record {

struct Reader::Chosen {
  std::set<std::uint16_t> channels;
  bool all = true;
  TimeNs from = 0;
  TimeNs to = 0;

  [[nodiscard]] bool takes(const ChunkIndex& chunk) const {
    // Times of a chunk without messages are 0; one that cannot be used says so when it is read.
    if (chunk.message_end_time < from || chunk.message_start_time >= to) return false;
    if (all || chunk.message_index_offsets.empty()) return true;
    return std::any_of(chunk.message_index_offsets.begin(), chunk.message_index_offsets.end(),
                       [&](const auto& entry) { return channels.contains(entry.first); });
  }
  [[nodiscard]] bool takes(const Message& message) const {
    return message.log_time >= from && message.log_time < to &&
           (all || channels.contains(message.channel_id));
  }
};

Result<Reader> Reader::open(const std::filesystem::path& path, const Limits& limits) {
  auto source = FileSource::open(path);
  if (!source) return source.error();
  auto reader = open(std::move(source.value()), limits);
  if (!reader) return Error{path.string() + ": " + reader.error().message};
  return reader;
}

Result<Reader> Reader::open(std::unique_ptr<Source> source, const Limits& limits) {
  auto summary = read_summary(*source, limits);
  if (summary) return Reader(std::move(source), limits, std::move(summary.value()));
  auto found = scan(*source, limits);
  if (!found) return found.error();
  Contents& contents = found.value();
  contents.ending = summary.error().message + (contents.ending.empty() ? "" : "; " + contents.ending);
  return Reader(std::move(source), limits, std::move(contents));
}

const Schema* Reader::schema_of(const Channel& channel) const {
  const auto found = contents_.schemas.find(channel.schema_id);
  return found == contents_.schemas.end() ? nullptr : &found->second;
}

/// A chunk under reading, at one of its messages.
struct Reader::Unpacked {
  std::uint64_t at = 0;
  TimeNs from = 0;
  TimeNs to = 0;
  Bytes records;
  MemoryWalk inside{{}};
  Place place;
  TimeNs head = 0;

  /// The next message; false at the end. A message that cannot be parsed has the time of the one before.
  bool next() {
    while (inside.next(place)) {
      if (place.op != Op::message) continue;
      place.offset += at;
      if (const auto message = parse<Message>(place.content)) head = message.value().log_time;
      return true;
    }
    return false;
  }
};

/// Chunks that were filled beside each other.
struct Reader::Group {
  struct Problem {
    std::uint64_t at;
    std::string what;
  };
  std::size_t end = 0;  ///< number of the first chunk behind them
  std::vector<std::unique_ptr<Unpacked>> open;
  std::vector<Problem> problems;  ///< of those that cannot be unpacked
};

Outcome Reader::read(const Selection& selection, const Handler& handler) {
  Outcome outcome;
  outcome.problems = contents_.problems;
  Chosen chosen{{}, selection.topics.empty(), selection.from, selection.to};
  for (const auto& [id, channel] : contents_.channels) {
    if (std::find(selection.topics.begin(), selection.topics.end(), channel.topic) != selection.topics.end())
      chosen.channels.insert(id);
  }
  if (contents_.loose_messages) {
    stream(chosen, handler, outcome);
    return outcome;
  }
  if (contents_.chunks.empty()) return outcome;
  // While some chunks are handed over, another thread unpacks the next ones.
  std::vector<Group> groups = unpack_from(0, chosen);
  while (true) {
    const std::size_t following = groups.back().end;
    std::future<std::vector<Group>> next;
    if (following < contents_.chunks.size())
      next = std::async(std::launch::async, [&, following] { return unpack_from(following, chosen); });
    for (Group& group : groups)
      if (!read_chunks(std::move(group), chosen, handler, outcome)) return outcome;
    if (!next.valid()) return outcome;
    groups = next.get();
  }
}

/// How many chunks from this one on were filled beside each other: they were flushed in the order of their
/// groups.
std::size_t Reader::beside(std::size_t first) const {
  constexpr std::size_t kMost = 4;  // are in memory at once
  const auto group_of = [&](const ChunkIndex& chunk) -> unsigned long {
    if (chunk.message_index_offsets.empty()) return 0;
    const auto channel = contents_.channels.find(chunk.message_index_offsets.begin()->first);
    if (channel == contents_.channels.end()) return 0;
    const auto group = channel->second.metadata.find(kChunkGroup);
    return group == channel->second.metadata.end() ? 0 : std::strtoul(group->second.c_str(), nullptr, 10);
  };
  std::size_t next = first + 1;
  while (next < contents_.chunks.size() && next - first < kMost &&
         group_of(contents_.chunks[next]) > group_of(contents_.chunks[next - 1]))
    ++next;
  return next - first;
}

std::vector<Reader::Group> Reader::unpack_from(std::size_t first, const Chosen& chosen) {
  // A thread for each group alone would cost as much as its unpacking.
  constexpr std::uint64_t kEnough_bytes = 8U << 20U;
  std::vector<Group> out;
  std::uint64_t bytes = 0;
  for (std::size_t next = first; next < contents_.chunks.size() && bytes < kEnough_bytes;
       next = out.back().end) {
    Group& group = out.emplace_back();
    group.end = next + beside(next);
    for (std::size_t i = next; i < group.end; ++i) {
      const ChunkIndex& index = contents_.chunks[i];
      if (!chosen.takes(index)) continue;
      auto chunk = unpack(index);
      if (!chunk) {
        group.problems.push_back({index.chunk_start_offset, chunk.error().message});
        continue;
      }
      bytes += chunk.value()->records.size();
      group.open.push_back(std::move(chunk.value()));
    }
  }
  return out;
}

bool Reader::read_chunks(Group group, const Chosen& chosen, const Handler& handler, Outcome& outcome) {
  std::vector<std::unique_ptr<Unpacked>>& open = group.open;
  const auto advance = [&](std::size_t i) {
    if (open[i]->next()) return true;
    if (!open[i]->inside.fault().empty())
      note(outcome.problems, open[i]->at, "in the chunk: " + open[i]->inside.fault());
    open.erase(open.begin() + static_cast<std::ptrdiff_t>(i));
    return false;
  };
  for (const Group::Problem& one : group.problems) note(outcome.problems, one.at, one.what);
  for (std::size_t i = 0; i < open.size();) i += advance(i) ? 1 : 0;
  while (!open.empty()) {
    std::size_t first = 0;
    for (std::size_t i = 1; i < open.size(); ++i)
      if (open[i]->head < open[first]->head) first = i;
    if (!hand_over(open[first]->place, chosen, handler, outcome, open[first].get())) return false;
    advance(first);
  }
  return true;
}

Result<std::unique_ptr<Reader::Unpacked>> Reader::unpack(const ChunkIndex& index) {
  const std::uint64_t at = index.chunk_start_offset;
  Walk walk(*source_, at, at + index.chunk_length, limits_);
  Place place;
  if (!walk.next(place)) return Error{walk.fault().empty() ? "chunk: it has no bytes" : walk.fault()};
  if (place.op != Op::chunk) return Error{"a " + to_string(place.op) + ", expected a chunk"};
  const auto chunk = parse<Chunk>(place.content);
  if (!chunk) return chunk.error();
  const Chunk& one = chunk.value();
  if (place.end() - at != index.chunk_length || one.message_start_time != index.message_start_time ||
      one.message_end_time != index.message_end_time || one.uncompressed_size != index.uncompressed_size ||
      one.compression != index.compression || one.records.size() != index.compressed_size) {
    return Error{"chunk: it is another one than its index says"};
  }
  auto records = open_chunk(one, limits_);
  if (!records) return records.error();
  auto out = std::make_unique<Unpacked>();
  out->at = at;
  out->from = one.message_start_time;
  out->to = one.message_end_time;
  out->records = std::move(records.value());
  out->inside = MemoryWalk(out->records);
  return out;
}

bool Reader::hand_over(const Place& place, const Chosen& chosen, const Handler& handler, Outcome& outcome,
                       const Unpacked* chunk) {
  const auto found = parse<Message>(place.content);
  if (!found) {
    note(outcome.problems, place.offset, found.error().message);
    return true;
  }
  const Message& message = found.value();
  const auto channel = contents_.channels.find(message.channel_id);
  if (channel == contents_.channels.end()) {
    note(outcome.problems, place.offset,
         "message: channel " + std::to_string(message.channel_id) + " is not there");
    return true;
  }
  if (chunk != nullptr && (message.log_time < chunk->from || message.log_time > chunk->to)) {
    note(outcome.problems, place.offset, "message: its time is outside of its chunk's");
  }
  if (!chosen.takes(message)) return true;
  ++outcome.messages;
  return handler(channel->second, message);
}

void Reader::stream(const Chosen& chosen, const Handler& handler, Outcome& outcome) {
  Header header;
  const auto begin = read_header(*source_, limits_, header);
  if (!begin) return note(outcome.problems, 0, begin.error().message);
  Walk walk(*source_, begin.value(), contents_.end_of_data, limits_);
  for (Place place; walk.next(place);) {
    if (place.op == Op::message) {
      if (!hand_over(place, chosen, handler, outcome, nullptr)) return;
    } else if (place.op == Op::chunk) {
      const auto chunk = parse<Chunk>(place.content);
      if (!chunk) continue;  // known as a problem
      const auto records = open_chunk(chunk.value(), limits_);
      if (!records) continue;
      Unpacked one;
      one.at = place.offset;
      one.from = chunk.value().message_start_time;
      one.to = chunk.value().message_end_time;
      one.inside = MemoryWalk(records.value());
      while (one.next())
        if (!hand_over(one.place, chosen, handler, outcome, &one)) return;
    }
  }
  if (!walk.fault().empty()) note(outcome.problems, walk.at(), walk.fault());
}

Result<Bytes> Reader::attachment(const AttachmentIndex& index) {
  Walk walk(*source_, index.offset, index.offset + index.length, limits_);
  Place place;
  if (!walk.next(place)) return Error{walk.fault()};
  const std::string where = "offset " + std::to_string(index.offset) + ": ";
  if (place.op != Op::attachment)
    return Error{where + "a " + to_string(place.op) + ", expected an attachment"};
  const auto found = parse<Attachment>(place.content);
  if (!found) return Error{where + found.error().message};
  const Attachment& one = found.value();
  const std::size_t covered =
      static_cast<std::size_t>(one.data.data() - place.content.data()) + one.data.size();
  if (one.crc != 0 && crc32(place.content.first(covered)) != one.crc) {
    return Error{where + "attachment: its bytes do not fit its CRC"};
  }
  if (one.name != index.name || one.data.size() != index.data_size || one.log_time != index.log_time ||
      one.create_time != index.create_time || one.media_type != index.media_type) {
    return Error{where + "attachment: it is another one than its index says"};
  }
  return Bytes(one.data.begin(), one.data.end());
}

Result<Bytes> Reader::attachment(std::string_view name) {
  for (auto one = contents_.attachments.rbegin(); one != contents_.attachments.rend(); ++one) {
    if (one->name == name) return attachment(*one);
  }
  return Error{"there is no attachment '" + std::string(name) + "'"};
}

Result<Metadata> Reader::metadata(const MetadataIndex& index) {
  Walk walk(*source_, index.offset, index.offset + index.length, limits_);
  Place place;
  if (!walk.next(place)) return Error{walk.fault()};
  const std::string where = "offset " + std::to_string(index.offset) + ": ";
  if (place.op != Op::metadata) return Error{where + "a " + to_string(place.op) + ", expected metadata"};
  auto found = parse<Metadata>(place.content);
  if (!found) return Error{where + found.error().message};
  if (found.value().name != index.name)
    return Error{where + "metadata: it is another one than its index says"};
  return found;
}

}  // namespace fathom::record
