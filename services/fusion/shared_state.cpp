#include "fusion/shared_state.hpp"

#include <cstdint>
#include <map>
#include <variant>

#include "base/image.hpp"

namespace fathom::fusion {
namespace {

struct Head {
  TimeNs stamp_ns = 0;
  Name imu_sensor;
  std::uint64_t streams = 0;
};
struct Row {
  SourceKind source{};
  Name sensor;
  std::uint64_t sequence = 0;
};

}  // namespace

void encode(const SharedState& state, std::vector<std::byte>& out) {
  out.clear();
  ImageWriter writer(out);
  writer.put(Head{state.stamp_ns, state.imu_sensor, state.last.size()});
  for (const auto& [stream, sequence] : state.last) writer.put(Row{stream.first, stream.second, sequence});
  out.insert(out.end(), state.image.begin(), state.image.end());
}

Result<SharedState> decode_shared(std::span<const std::byte> bytes) {
  const Error too_short{"is cut off"};
  const Error no_name{"holds what is no name"};
  if (bytes.size() < sizeof(Head)) return too_short;
  ImageReader reader(bytes);
  Head head;
  reader.get(head);
  if (head.streams > reader.left() / sizeof(Row)) return too_short;
  if (!head.imu_sensor.sound()) return no_name;
  SharedState out;
  out.stamp_ns = head.stamp_ns;
  out.imu_sensor = head.imu_sensor;
  for (std::uint64_t i = 0; i < head.streams; ++i) {
    Row row;
    reader.get(row);
    if (!row.sensor.sound()) return no_name;
    out.last[{row.source, row.sensor}] = row.sequence;
  }
  const auto image = bytes.last(reader.left());
  out.image.assign(image.begin(), image.end());
  return out;
}

std::string gap_between(const SharedState& state, const ArrivalLog& log) {
  SampleGaps::Table first;
  for (const ArrivalLog::Arrival& arrival : log.arrivals()) {
    std::visit(
        [&](const auto& one) {
          first.try_emplace({source_of(one), one.header.sensor}, one.header.sequence);
        },
        arrival.sample);
  }
  for (const auto& [stream, sequence] : state.last) {
    const auto found = first.find(stream);
    const bool unit = stream.first == SourceKind::imu && stream.second == state.imu_sensor;
    // Of an instrument that speaks seldom nothing may have come yet; its next sample will show.
    if (found == first.end() && !unit) continue;
    if (found == first.end()) return "nothing of " + stream.second.str() + " has arrived here yet";
    if (found->second > sequence + 1) {
      return std::to_string(found->second - sequence - 1) + " samples of " + stream.second.str() +
             " between it and the first that arrived here";
    }
  }
  return {};
}

}  // namespace fathom::fusion
