#include "fusion/replica/shared_state.hpp"

#include <cstdint>
#include <map>
#include <string>
#include <variant>

#include "archive/reader.hpp"
#include "archive/writer.hpp"

namespace fathom::fusion {
namespace {

constexpr std::uint32_t kVersion = 1;
/// Most streams of a state that are read: several times as many as are watched.
constexpr std::uint64_t kMostStreams = 1024;

struct Head {
  template <class Archive, class Self>
  static void fields(Archive& archive, Self& self) {
    archive("version", self.version, fathom::archive::Whole{1, kVersion});
    archive("stamp_ns", self.stamp_ns, fathom::archive::kInstant);
    archive("imu_sensor", self.imu_sensor);
    archive("streams", self.streams);
  }
  std::uint32_t version = kVersion;
  TimeNs stamp_ns = 0;
  Name imu_sensor;
  std::uint64_t streams = 0;
};
struct Row {
  template <class Archive, class Self>
  static void fields(Archive& archive, Self& self) {
    archive("source", self.source, kLastKind);
    archive("sensor", self.sensor);
    archive("sequence", self.sequence);
  }
  SourceKind source{};
  Name sensor;
  std::uint64_t sequence = 0;
};

}  // namespace

void encode(const SharedState& state, std::vector<std::byte>& out) {
  out.clear();
  archive::Writer writer(out, kVersion);
  const Head head{kVersion, state.stamp_ns, state.imu_sensor, state.last.size()};
  writer("head", head);
  std::size_t index = 0;
  for (const auto& [stream, sequence] : state.last) {
    const Row row{stream.first, stream.second, sequence};
    writer.element("streams", index++, row);
  }
  out.insert(out.end(), state.archive.begin(), state.archive.end());
}

Result<SharedState> decode_shared(std::span<const std::byte> bytes) {
  archive::Reader reader(bytes, kVersion);
  Head head;
  reader("head", head);
  reader.expect(head.streams <= kMostStreams, "head.streams", "at most " + std::to_string(kMostStreams));
  SharedState out;
  out.stamp_ns = head.stamp_ns;
  out.imu_sensor = head.imu_sensor;
  for (std::uint64_t i = 0; i < head.streams && reader.good(); ++i) {
    Row row;
    reader.element("streams", i, row);
    out.last[{row.source, row.sensor}] = row.sequence;
  }
  if (!reader.good()) return Error{"is none: " + reader.complaint()};
  out.archive.assign(reader.rest().begin(), reader.rest().end());
  return out;
}

std::string gap_between(const SharedState& state, const ArrivalLog& log) {
  SampleGaps::Table first;
  for (const Arrival& arrival : log.arrivals()) {
    const SampleHeader& header = arrival.header();
    first.try_emplace({arrival.source(), header.sensor}, header.sequence);
  }
  for (const auto& [stream, sequence] : state.last) {
    const auto found = first.find(stream);
    const bool unit = stream.first == SourceKind::imu && stream.second == state.imu_sensor;
    // A slow instrument may have sent nothing yet. Its next sample will show whether one is missing.
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
