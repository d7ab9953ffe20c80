#include "record/contents.hpp"

#include <algorithm>

#include "base/bytes/little_endian.hpp"
#include "record/wire.hpp"

namespace fathom::record {

void count(Statistics& statistics, std::uint16_t channel, TimeNs log_time, std::uint64_t before_count) {
  const bool first = before_count == 0;
  statistics.message_start_time = first ? log_time : std::min(statistics.message_start_time, log_time);
  statistics.message_end_time = first ? log_time : std::max(statistics.message_end_time, log_time);
  ++statistics.message_count;
  ++statistics.channel_message_counts[channel];
}

Bytes closing(const Contents& contents, std::uint32_t data_crc) {
  Bytes out;
  append(out, DataEnd{data_crc});
  const std::uint64_t summary_at = out.size();
  std::vector<SummaryOffset> groups;
  const auto group = [&]<class Records, class Take>(Op op, const Records& records, Take take) {
    const std::uint64_t begin = out.size();
    for (const auto& record : records) append(out, take(record));
    if (out.size() == begin) return;
    groups.push_back({static_cast<std::uint8_t>(op), contents.end_of_data + begin, out.size() - begin});
  };
  const auto second = [](const auto& entry) -> const auto& {
    return entry.second;
  };
  const auto itself = [](const auto& record) -> const auto& {
    return record;
  };
  group(Op::schema, contents.schemas, second);
  group(Op::channel, contents.channels, second);
  Statistics statistics = contents.statistics;
  statistics.schema_count = static_cast<std::uint16_t>(contents.schemas.size());
  statistics.channel_count = static_cast<std::uint32_t>(contents.channels.size());
  statistics.attachment_count = static_cast<std::uint32_t>(contents.attachments.size());
  statistics.metadata_count = static_cast<std::uint32_t>(contents.metadata.size());
  statistics.chunk_count = static_cast<std::uint32_t>(contents.chunks.size());
  group(Op::statistics, std::vector<Statistics>{statistics}, itself);
  group(Op::chunk_index, contents.chunks, itself);
  group(Op::attachment_index, contents.attachments, itself);
  group(Op::metadata_index, contents.metadata, itself);
  Footer footer{contents.end_of_data + summary_at, contents.end_of_data + out.size(), 0};
  for (const SummaryOffset& one : groups) append(out, one);
  append(out, footer);
  const std::size_t crc_at = out.size() - sizeof footer.summary_crc;
  const std::uint32_t crc = crc32(View(out).subspan(summary_at, crc_at - summary_at));
  store_le<std::uint32_t>(out, crc_at, crc);
  out.insert(out.end(), kMagic.begin(), kMagic.end());
  return out;
}

}  // namespace fathom::record
