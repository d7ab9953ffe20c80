#include "record/scan.hpp"

#include <algorithm>
#include <array>

#include "record/wire.hpp"

namespace fathom::record {
namespace {

/// Keeps a record of an id; one of the same id must be the same.
template <class One>
void keep(std::map<std::uint16_t, One>& all, const Result<One>& found, std::uint64_t offset,
          std::vector<std::string>& problems) {
  if (!found) return note(problems, offset, found.error().message);
  const auto [known, is_new] = all.emplace(found.value().id, found.value());
  if (is_new || known->second == found.value()) return;
  note(problems, offset,
       to_string(One::kOp) + ": id " + std::to_string(found.value().id) + " is another one already");
}

/// Goes through a file and gathers what is in it.
class Scan {
 public:
  Scan(Contents& contents, const Limits& limits) : contents_(contents), limits_(limits) {}

  /// False at the end of the data section.
  bool take(const Place& place) {
    switch (place.op) {
      case Op::schema:
        keep(contents_.schemas, parse<Schema>(place.content), place.offset, contents_.problems);
        break;
      case Op::channel:
        keep(contents_.channels, parse<Channel>(place.content), place.offset, contents_.problems);
        break;
      case Op::message:
        take_message(place);
        break;
      case Op::chunk:
        take_chunk(place);
        break;
      case Op::message_index:
        take_index(place);
        break;
      case Op::attachment:
        take_attachment(place);
        break;
      case Op::metadata:
        take_metadata(place);
        break;
      case Op::data_end:
      case Op::footer:
        return false;
      default:
        break;  // of a later version, or out of its place
    }
    contents_.end_of_data = place.end();
    return true;
  }

 private:
  void take_message(const Place& place) {
    const auto message = parse<Message>(place.content);
    if (!message) return note(contents_.problems, place.offset, message.error().message);
    contents_.loose_messages = true;
    add(message.value());
  }
  void add(const Message& message) {
    count(contents_.statistics, message.channel_id, message.log_time, contents_.statistics.message_count);
  }

  void take_chunk(const Place& place) {
    const auto chunk = parse<Chunk>(place.content);
    chunk_is_known_ = chunk.ok();
    if (!chunk) return note(contents_.problems, place.offset, chunk.error().message);
    const Chunk& one = chunk.value();
    contents_.chunks.push_back({one.message_start_time,
                                one.message_end_time,
                                place.offset,
                                place.end() - place.offset,
                                {},
                                0,
                                one.compression,
                                one.records.size(),
                                one.uncompressed_size});
    const auto records = open_chunk(one, limits_);
    if (!records) return note(contents_.problems, place.offset, records.error().message);
    MemoryWalk walk(records.value());
    for (Place inside; walk.next(inside);) {
      if (inside.op == Op::schema) {
        keep(contents_.schemas, parse<Schema>(inside.content), place.offset, contents_.problems);
      } else if (inside.op == Op::channel) {
        keep(contents_.channels, parse<Channel>(inside.content), place.offset, contents_.problems);
      } else if (inside.op == Op::message) {
        const auto message = parse<Message>(inside.content);
        if (message) add(message.value());
      }
    }
  }

  void take_index(const Place& place) {
    const auto index = parse<MessageIndex>(place.content);
    if (!index) return note(contents_.problems, place.offset, index.error().message);
    if (!chunk_is_known_) return;
    ChunkIndex& chunk = contents_.chunks.back();
    const std::uint64_t begin = chunk.chunk_start_offset + chunk.chunk_length;
    chunk.message_index_offsets[index.value().channel_id] = place.offset;
    chunk.message_index_length = place.end() - begin;
  }

  void take_attachment(const Place& place) {
    const auto attachment = parse<Attachment>(place.content);
    if (!attachment) return note(contents_.problems, place.offset, attachment.error().message);
    const Attachment& one = attachment.value();
    contents_.attachments.push_back({place.offset, place.end() - place.offset, one.log_time, one.create_time,
                                     one.data.size(), one.name, one.media_type});
  }
  void take_metadata(const Place& place) {
    const auto metadata = parse<Metadata>(place.content);
    if (!metadata) return note(contents_.problems, place.offset, metadata.error().message);
    contents_.metadata.push_back({place.offset, place.end() - place.offset, metadata.value().name});
  }

  Contents& contents_;
  const Limits& limits_;
  bool chunk_is_known_ = false;  // the chunk that message indexes now belong to
};

/// Whether [offset, offset + length) lies in the data section.
bool inside(std::uint64_t offset, std::uint64_t length, std::uint64_t begin, std::uint64_t end) {
  return offset >= begin && offset <= end && length <= end - offset;
}

/// What the summary says where: empty when it can be so.
std::string objection(const Contents& contents, std::uint64_t begin, std::uint64_t end) {
  for (const ChunkIndex& chunk : contents.chunks) {
    if (!inside(chunk.chunk_start_offset, chunk.chunk_length, begin, end))
      return "summary: a chunk index names offset " + std::to_string(chunk.chunk_start_offset) +
             ", which is outside of the data";
    for (const auto& [channel, offset] : chunk.message_index_offsets) {
      if (!inside(offset, kRecordHead, begin, end) || !contents.channels.contains(channel))
        return "summary: a chunk index names a message index that cannot be there";
    }
  }
  for (const AttachmentIndex& one : contents.attachments) {
    if (!inside(one.offset, one.length, begin, end))
      return "summary: attachment '" + one.name + "' is outside of the data";
  }
  for (const MetadataIndex& one : contents.metadata) {
    if (!inside(one.offset, one.length, begin, end))
      return "summary: metadata '" + one.name + "' is outside of the data";
  }
  return {};
}

template <class One>
void collect(std::vector<One>& all, const Result<One>& found, std::string& fault) {
  if (found) {
    all.push_back(found.value());
  } else if (fault.empty()) {
    fault = found.error().message;
  }
}

Result<Footer> read_footer(Source& source, const Limits& limits) {
  const std::uint64_t least = 2 * kMagic.size() + kFooterSize;
  if (source.size() < least) return Error{"the file ends before a footer could be there"};
  std::array<std::uint8_t, kMagic.size()> magic{};
  if (std::string why = source.read(source.size() - magic.size(), magic); !why.empty()) return Error{why};
  if (magic != kMagic) return Error{"the file does not end as a recording ends: it was not closed"};
  Walk walk(source, source.size() - kMagic.size() - kFooterSize, source.size() - kMagic.size(), limits);
  Place place;
  if (!walk.next(place) || place.op != Op::footer) return Error{"there is no footer at the end"};
  return parse<Footer>(place.content);
}

}  // namespace

void note(std::vector<std::string>& problems, std::uint64_t offset, const std::string& what) {
  if (problems.size() < kMostProblems) problems.push_back("offset " + std::to_string(offset) + ": " + what);
}

Result<std::uint64_t> read_header(Source& source, const Limits& limits, Header& header) {
  std::array<std::uint8_t, kMagic.size()> magic{};
  if (source.size() < magic.size()) {
    return Error{"holds " + std::to_string(source.size()) + " bytes, expected an MCAP recording"};
  }
  if (std::string why = source.read(0, magic); !why.empty()) return Error{why};
  if (magic != kMagic) return Error{"does not begin with the magic bytes of MCAP version 0"};
  Walk walk(source, magic.size(), source.size(), limits);
  Place place;
  if (!walk.next(place)) {
    return Error{walk.fault().empty() ? "ends before its header: nothing was recorded" : walk.fault()};
  }
  if (place.op != Op::header) return Error{"begins with a " + to_string(place.op) + ", expected a header"};
  const auto found = parse<Header>(place.content);
  if (!found) return Error{"offset 8: " + found.error().message};
  header = found.value();
  return place.end();
}

Result<Contents> read_summary(Source& source, const Limits& limits) {
  Contents out;
  const auto begin = read_header(source, limits, out.header);
  if (!begin) return begin.error();
  const auto found = read_footer(source, limits);
  if (!found) return found.error();
  const Footer& footer = found.value();
  const std::uint64_t end = source.size() - kMagic.size() - kFooterSize;
  if (footer.summary_start == 0) return Error{"the file has no summary"};
  if (footer.summary_start < begin.value() || footer.summary_start > end) {
    return Error{"footer: summary_start " + std::to_string(footer.summary_start) + " is outside of the file"};
  }
  if (end - footer.summary_start > limits.record_bytes) return Error{"the summary is larger than the limit"};
  Bytes summary(static_cast<std::size_t>(source.size() - kMagic.size() - footer.summary_start));
  if (std::string why = source.read(footer.summary_start, summary); !why.empty()) return Error{why};
  if (footer.summary_crc != 0 &&
      crc32(View(summary).first(summary.size() - sizeof footer.summary_crc)) != footer.summary_crc) {
    return Error{"summary: its bytes do not fit its CRC"};
  }
  MemoryWalk walk(summary);
  std::string fault;
  for (Place place; walk.next(place);) {
    const std::uint64_t at = footer.summary_start + place.offset;
    if (place.op == Op::schema) keep(out.schemas, parse<Schema>(place.content), at, out.problems);
    if (place.op == Op::channel) keep(out.channels, parse<Channel>(place.content), at, out.problems);
    if (place.op == Op::chunk_index) collect(out.chunks, parse<ChunkIndex>(place.content), fault);
    if (place.op == Op::attachment_index)
      collect(out.attachments, parse<AttachmentIndex>(place.content), fault);
    if (place.op == Op::metadata_index) collect(out.metadata, parse<MetadataIndex>(place.content), fault);
    if (place.op == Op::statistics) {
      const auto statistics = parse<Statistics>(place.content);
      if (statistics) out.statistics = statistics.value();
      if (!statistics && fault.empty()) fault = statistics.error().message;
    }
  }
  if (fault.empty()) fault = walk.fault();
  if (fault.empty()) fault = objection(out, begin.value(), footer.summary_start);
  if (!fault.empty()) return Error{fault};
  std::sort(out.chunks.begin(), out.chunks.end(), [](const ChunkIndex& a, const ChunkIndex& b) {
    return a.chunk_start_offset < b.chunk_start_offset;
  });
  out.loose_messages = out.chunks.empty() && out.statistics.message_count > 0;
  out.indexed = true;
  out.end_of_data = footer.summary_start;
  return out;
}

Result<Contents> scan(Source& source, const Limits& limits) {
  Contents out;
  const auto begin = read_header(source, limits, out.header);
  if (!begin) return begin.error();
  out.end_of_data = begin.value();
  Walk walk(source, begin.value(), source.size(), limits);
  Scan gathering(out, limits);
  Place place;
  bool more = walk.next(place);
  while (more && gathering.take(place)) more = walk.next(place);
  if (!walk.fault().empty())
    out.ending = walk.fault();
  else if (!more)
    out.ending = "the file was not closed";
  else
    out.ending = "the file ends without a usable summary";
  return out;
}

}  // namespace fathom::record
