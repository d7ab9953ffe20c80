// Writes a recording with samples of every topic's type, and to standard output what is in it: every_type
// FILE none|lz4|zstd. A line for each message: topic, and the values of all fields in the order of their
// text.

#include <cstdio>
#include <string>
#include <string_view>
#include <vector>

#include "bus/cdr.hpp"
#include "bus/topics.hpp"
#include "record/idl.hpp"
#include "record/writer.hpp"
#include "samples/kinds.hpp"
#include "support/leaves.hpp"
#include "unit/bus/sample_fields.hpp"

namespace fathom {
namespace {

struct Recording {
  record::Writer& writer;
  std::size_t topic = 0;
  TimeNs now = 1'700'000'000'000'000'000;
  std::string failure{};

  template <class Sample>
  void add() {
    const bus::TopicInfo& info = bus::all_topics()[topic++];
    const auto idl = record::self_contained_idl(record::idl_files(), info.type);
    if (!idl) failure += idl.error().message;
    if (!idl) return;
    const auto channel =
        writer.add_channel(writer.add_schema(info.type, "omgidl", idl.value()), info.topic, "cdr");
    for (unsigned seed = 0; seed < 12; ++seed) {
      Sample sample;
      test::Filler(seed, test::Lists::full).fill(sample);
      const record::Bytes data = bus::to_cdr(sample);
      failure += writer.write({channel, seed, ++now, now, data});
      std::printf("%s%s\n", info.topic, test::Leaves::of(sample).c_str());
    }
  }
};

int run(const char* path, std::string_view compression) {
  auto sink = record::FileSink::create(path);
  if (!sink) {
    std::fprintf(stderr, "%s\n", sink.error().message.c_str());
    return 1;
  }
  record::WriterOptions options;
  options.compression = compression == "zstd"  ? record::Compression::zstd
                        : compression == "lz4" ? record::Compression::lz4
                                               : record::Compression::none;
  options.chunk_bytes = 50'000;
  record::Writer writer(std::move(sink.value()), options);
  Recording recording{writer};
  recording.failure = writer.begin();
  for_each_kind([&](auto kind) { recording.add<typename decltype(kind)::Sample>(); });
  recording.add<NavState>();
  recording.add<NavDetail>();
  recording.add<Verdict>();
  recording.add<AlignmentStatus>();
  recording.add<Forecast>();
  recording.add<Alarm>();
  recording.add<MonitorStatus>();
  recording.add<ServiceStatus>();
  recording.add<Command>();
  recording.add<ReplicaStatus>();
  recording.add<EngineStatePart>();
  recording.add<Route>();
  recording.add<Truth>();
  recording.add<IntakeRecord>();
  const record::Bytes note{'x'};
  recording.failure += writer.attach({recording.now, recording.now, "note", "text/plain", note, 0});
  recording.failure += writer.finish();
  if (!recording.failure.empty()) std::fprintf(stderr, "%s\n", recording.failure.c_str());
  return recording.failure.empty() ? 0 : 1;
}

}  // namespace
}  // namespace fathom

int main(int argc, char** argv) {
  return argc == 3 ? fathom::run(argv[1], argv[2]) : 2;
}
