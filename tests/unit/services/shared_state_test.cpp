#include "fusion/replica/shared_state.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace fathom::fusion {
namespace {

SharedState shared() {
  SharedState out;
  out.stamp_ns = 17;
  out.imu_sensor = "imu";
  out.last[{SourceKind::imu, "imu"}] = 100;
  out.last[{SourceKind::gps, "gps"}] = 7;
  for_each_kind([&](auto kind) { out.last.try_emplace({kind.kSource, Name(kind.kWord)}, 8); });
  out.archive.assign(1000, std::byte{5});
  return out;
}

Arrival imu(std::uint64_t sequence) {
  ImuSample sample;
  sample.header.sensor = "imu";
  sample.header.sequence = sequence;
  return {sample, {}, "imu_bridge", 0};
}

TEST(SharedState, ReadsAsItWasWritten) {
  std::vector<std::byte> bytes;
  encode(shared(), bytes);
  const auto found = decode_shared(bytes);
  ASSERT_TRUE(found);
  EXPECT_EQ(found.value().stamp_ns, 17);
  EXPECT_EQ(found.value().imu_sensor, "imu");
  EXPECT_EQ(found.value().last, shared().last);
  EXPECT_EQ(found.value().archive, shared().archive);
}

TEST(SharedState, BytesThatAreNoneAreRefused) {
  std::vector<std::byte> bytes;
  encode(shared(), bytes);
  EXPECT_FALSE(decode_shared({}));
  EXPECT_FALSE(decode_shared(std::span(bytes).first(20)));
  // Each byte of the head and the table destroyed: refused, or read as something that can be looked at.
  for (std::size_t at = 0; at < bytes.size() - 1000; ++at) {
    std::vector<std::byte> spoilt = bytes;
    spoilt[at] = std::byte{0xff};
    const auto found = decode_shared(spoilt);
    if (!found) continue;
    EXPECT_LE(found.value().imu_sensor.view().size(), Name::kCapacity);
    for (const auto& [stream, sequence] : found.value().last) {
      EXPECT_LE(stream.second.view().size(), Name::kCapacity) << at;
    }
  }
}

TEST(SharedState, GoesOnWhereTheArrivalsBegin) {
  ArrivalLog log;
  log.keep(true);
  EXPECT_NE(gap_between(shared(), log).find("nothing of imu"), std::string::npos);
  log.add(imu(101));
  EXPECT_EQ(gap_between(shared(), log), "");
  log.keep(false);
  log.keep(true);
  log.add(imu(103));
  EXPECT_EQ(gap_between(shared(), log), "2 samples of imu between it and the first that arrived here");
}

}  // namespace
}  // namespace fathom::fusion
