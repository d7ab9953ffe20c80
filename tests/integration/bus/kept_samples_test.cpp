// Samples that come after others which have not arrived are kept for later, and nobody is held up by that.

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <thread>

#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <gtest/gtest.h>

#include "bus/detail/participant_impl.hpp"
#include "bus/detail/qos/profiles.hpp"
#include "bus/detail/sample_type.hpp"
#include "bus/participant.hpp"
#include "bus/reader.hpp"
#include "bus/writer.hpp"
#include "samples/imu.hpp"
#include "support.hpp"

namespace fathom::test {
namespace {

using std::chrono::microseconds;
using std::chrono::steady_clock;

/// Writes as the successor of a writer whose last samples never arrive.
class Successor {
 public:
  Successor(bus::Participant& participant, const bus::WriterOptions& options, const WriterGuid& after)
      : bus_(participant.impl()),
        ops_(bus::detail::topic_ops<ImuSample>()),
        writer_(bus_.publisher->create_datawriter(
            bus_.topic(ops_), bus::detail::writer_qos(*bus_.publisher, ops_.topic, options))) {
    bus::detail::rtps::GUID_t guid;
    std::copy_n(after.begin(), 12, &guid.guidPrefix.value[0]);
    std::copy_n(after.begin() + 12, 4, &guid.entityId.value[0]);
    with_.related_sample_identity().writer_guid(guid).sequence_number({0, 1'000'000'000U});
  }
  ~Successor() { bus_.publisher->delete_datawriter(writer_); }
  Successor(const Successor&) = delete;
  Successor& operator=(const Successor&) = delete;

  void write(ImuSample sample) {
    bus::detail::SampleSlot slot;
    slot.sample = &sample;
    bus::detail::rtps::WriteParams with = with_;
    writer_->write(&slot, with);
  }

 private:
  bus::Participant::Impl& bus_;
  const bus::detail::TopicOps& ops_;
  bus::detail::dds::DataWriter* writer_;
  bus::detail::rtps::WriteParams with_;
};

ImuSample sample_of(const char* sensor, std::uint64_t sequence) {
  ImuSample sample;
  sample.header.vehicle = "auv";
  sample.header.sensor = sensor;
  sample.header.sequence = sequence;
  return sample;
}

// Each writer that comes or goes has those that were kept looked at, on another thread than those of Fast
// DDS, which hand over at the same time.
TEST(KeptSamples, AreLookedAtWhileOthersArrive) {
  bus::Participant reads(options(112, "reads"));
  bus::Participant writes(options(112, "writes"));
  std::atomic<std::uint64_t> heard = 0;
  const bus::Reader<ImuSample> reader(reads, [&](const ImuSample&, const bus::SampleInfo&) {
    ++heard;
    for (const auto until = steady_clock::now() + microseconds(50); steady_clock::now() < until;) {
    }
  });
  bus::WriterOptions alone;
  alone.successor_after = 0;
  bus::Writer<ImuSample> writer(writes, alone);
  ASSERT_TRUE(eventually([&] { return writer.matched_readers() > 0 && reader.matched_writers() > 0; }));
  Successor successor(writes, alone, writer.guid());
  ASSERT_TRUE(eventually([&] { return reader.matched_writers() > 1; }));
  std::atomic<bool> ends = false;
  std::thread source([&] {
    for (std::uint64_t number = 1; !ends; ++number) {
      writer.write(sample_of("imu", number));
      std::this_thread::sleep_for(microseconds(300));
    }
  });
  for (std::uint64_t i = 0; i < 600; ++i) {
    if (i % 10 == 0) successor.write(sample_of("imu_spare", i + 1));
    { const bus::Writer<ImuSample> passing(writes, alone); }
    const std::uint64_t before = heard;
    if (eventually([&] { return heard > before; })) continue;
    std::fprintf(stderr, "nothing is handed over any more, after %d writers\n", static_cast<int>(i));
    std::abort();  // such a reader cannot be ended either
  }
  ends = true;
  source.join();
}

}  // namespace
}  // namespace fathom::test
