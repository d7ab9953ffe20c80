// How long a reader that comes anew waits for its first sample, by how many its writer has written before,
// with and without a successor in the writer's place (WriterOptions::successor_after). Prints a table.
// FATHOM_SOAK=1: up to four million samples.

#include <atomic>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "bus/participant.hpp"
#include "bus/reader.hpp"
#include "bus/writer.hpp"
#include "samples/imu.hpp"
#include "support/presence.hpp"
#include "support/process.hpp"

namespace fathom::test {
namespace {

constexpr std::uint32_t kDomain = 95;

/// Seconds from when both have found each other to the first sample, of a writer that has written `count`.
double wait_s(std::uint64_t count, const bus::WriterOptions& options) {
  bus::Participant bridge(presence(kDomain, "imu_bridge"));
  bus::Writer<ImuSample> writer(bridge, options);
  for (std::uint64_t i = 0; i < count; ++i) (void)writer.write(ImuSample{});
  if (options.successor_after > 0)
    std::this_thread::sleep_for(std::chrono::seconds(2));  // until it has taken over
  bus::Participant fusion(presence(kDomain, "fusion"));
  std::atomic<int> heard = 0;
  const bus::Reader<ImuSample> reader(fusion, [&](const ImuSample&, const bus::SampleInfo&) { ++heard; });
  EXPECT_TRUE(
      wait_until([&] { return writer.matched_readers() == 1 && reader.matched_writers() == 1; }, 30.0));
  const auto begin = std::chrono::steady_clock::now();
  while (heard == 0 && std::chrono::steady_clock::now() - begin < std::chrono::minutes(1)) {
    (void)writer.write(ImuSample{});
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  EXPECT_GT(heard, 0);
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

TEST(LateReaderBench, WaitsForItsFirstSample) {
  std::vector<std::uint64_t> counts{100'000};
  if (std::getenv("FATHOM_SOAK") != nullptr) counts = {1'000'000, 4'000'000};
  bus::WriterOptions alone;
  alone.successor_after = 0;
  for (const std::uint64_t count : counts) {
    bus::WriterOptions followed;
    followed.successor_after = count;
    std::printf("after %llu samples: %.3f s, with a successor %.3f s\n",
                static_cast<unsigned long long>(count), wait_s(count, alone), wait_s(count, followed));
  }
}

}  // namespace
}  // namespace fathom::test
