// Plain sample -> wire bytes -> plain sample, for every topic's type.

#include <cstring>

#include <gtest/gtest.h>

#include "bus/cdr.hpp"
#include "bus/topics.hpp"
#include "sample_fields.hpp"

namespace fathom {
namespace {

using test::Dump;
using test::Filler;
using test::Lists;

template <class T>
class RoundTrip : public testing::Test {};

using AllTypes =
    testing::Types<ImuSample, DvlSample, GpsSample, DepthSample, AltimeterSample, RangeSample, FixSample,
                   HeadingSample, UsblSample, AirspeedSample, PropulsionSample, FinsSample, NavState,
                   NavDetail, Verdict, AlignmentStatus, Forecast, Alarm, MonitorStatus, ServiceStatus,
                   Command, ReplicaStatus, EngineStatePart, Route, Truth, IntakeRecord>;
TYPED_TEST_SUITE(RoundTrip, AllTypes);

TEST(RoundTrips, CoverEveryTopic) {
  EXPECT_EQ(bus::all_topics().size(), 26U);
}

TYPED_TEST(RoundTrip, KeepsEveryField) {
  for (const Lists lists : {Lists::empty, Lists::one, Lists::full}) {
    for (unsigned seed = 0; seed < 12; ++seed) {  // more seeds than enumerators: each enumerator travels
      TypeParam sample;
      Filler(seed, lists).fill(sample);
      const auto back = bus::from_cdr<TypeParam>(bus::to_cdr(sample));
      ASSERT_TRUE(back.has_value());
      EXPECT_EQ(Dump::of(*back), Dump::of(sample));
    }
  }
}

TYPED_TEST(RoundTrip, KeepsUnknownAsNaN) {
  const TypeParam sample;  // quantities are unknown by default
  const auto back = bus::from_cdr<TypeParam>(bus::to_cdr(sample));
  ASSERT_TRUE(back.has_value());
  EXPECT_EQ(Dump::of(*back), Dump::of(sample));
}

TYPED_TEST(RoundTrip, RefusesEveryTruncation) {
  TypeParam sample;
  Filler(3, Lists::full).fill(sample);
  const auto bytes = bus::to_cdr(sample);
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    // Exactly sized, so that a sanitizer sees every read beyond the end.
    const std::vector<std::uint8_t> cut(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
    EXPECT_FALSE(bus::from_cdr<TypeParam>(cut).has_value()) << size << " of " << bytes.size();
  }
}

TYPED_TEST(RoundTrip, SurvivesEveryByteSetToFF) {
  TypeParam sample;
  Filler(5, Lists::one).fill(sample);
  const auto bytes = bus::to_cdr(sample);
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    auto broken = bytes;
    broken[i] = 0xFF;
    const auto back = bus::from_cdr<TypeParam>(broken);
    if (back) {
      EXPECT_LE(bus::to_cdr(*back).size(), bytes.size() + 8);
    }
  }
}

std::size_t find(const std::vector<std::uint8_t>& bytes, std::uint32_t word) {
  for (std::size_t i = 4; i + 4 <= bytes.size(); i += 4) {
    std::uint32_t here = 0;
    std::memcpy(&here, &bytes[i], 4);
    if (here == word) return i;
  }
  ADD_FAILURE() << "no word " << word;
  return 4;
}

void put(std::vector<std::uint8_t>& bytes, std::size_t at, std::uint32_t word) {
  std::memcpy(&bytes[at], &word, 4);
}

TEST(BadBytes, AnUnknownEnumeratorIsNoSample) {
  GpsSample sample;
  sample.fix = GpsFix::rtk_fixed;
  sample.satellites = 0x01020304;  // right behind the fix
  auto bytes = bus::to_cdr(sample);
  const std::size_t fix = find(bytes, 0x01020304) - 4;
  EXPECT_TRUE(bus::from_cdr<GpsSample>(bytes).has_value());
  put(bytes, fix, 8);
  EXPECT_FALSE(bus::from_cdr<GpsSample>(bytes).has_value());
  put(bytes, fix, 0xFFFFFFFF);
  EXPECT_FALSE(bus::from_cdr<GpsSample>(bytes).has_value());
}

TEST(BadBytes, AListThatClaimsToBeHugeIsRefusedWithoutRoomForIt) {
  Forecast sample;
  sample.limit_count = 7;
  auto bytes = bus::to_cdr(sample);
  const std::size_t length = find(bytes, 7);
  for (const std::uint32_t claimed : {9U, 100'000'000U, 0x7FFFFFFFU, 0xFFFFFFFFU}) {
    put(bytes, length, claimed);
    EXPECT_FALSE(bus::from_cdr<Forecast>(bytes).has_value()) << claimed;
  }
}

TEST(BadBytes, TextBeyondItsBoundIsRefusedWhereItIsNested) {
  // The same sample with a name one byte longer than the bound, put together by hand: our own writers cut it.
  Route sample;
  sample.waypoints.emplace_back();
  sample.waypoints[0].name = "nnnnnnnnnnnnnnnnnnnnnnnnnnn";  // 28 bytes with its end: no padding behind it
  auto bytes = bus::to_cdr(sample);
  ASSERT_TRUE(bus::from_cdr<Route>(bytes).has_value());
  const std::size_t length = find(bytes, 28);
  const auto stretched = [&](std::uint32_t size) {
    auto out = bytes;
    out.insert(out.begin() + static_cast<std::ptrdiff_t>(length) + 4, size - 28, std::uint8_t{'n'});
    put(out, length, size);
    return out;
  };
  // Lengths that keep what follows aligned; the bound of 31 and its end make 32.
  EXPECT_FALSE(bus::from_cdr<Route>(stretched(36)).has_value());
  EXPECT_FALSE(bus::from_cdr<Route>(stretched(4028)).has_value());
}

TEST(Bytes, OfTheOtherByteOrderAreRead) {
  // vehicle "a", sensor "b", stamp 1, received 2, sequence 3, rpm 1.0; XCDR1 big-endian.
  const std::vector<std::uint8_t> bytes{0,    0,    0, 0,                // encapsulation: CDR_BE
                                        0,    0,    0, 2, 'a', 0, 0, 0,  //
                                        0,    0,    0, 2, 'b', 0, 0, 0,  //
                                        0,    0,    0, 0, 0,   0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 2,  //
                                        0,    0,    0, 0, 0,   0, 0, 3,                          //
                                        0x3F, 0xF0, 0, 0, 0,   0, 0, 0};
  const auto sample = bus::from_cdr<PropulsionSample>(bytes);
  ASSERT_TRUE(sample.has_value());
  EXPECT_EQ(sample->header.vehicle, Name("a"));
  EXPECT_EQ(sample->header.sensor, Name("b"));
  EXPECT_EQ(sample->header.stamp_ns, 1);
  EXPECT_EQ(sample->header.received_ns, 2);
  EXPECT_EQ(sample->header.sequence, 3U);
  EXPECT_EQ(sample->rpm, 1.0);
}

TEST(Bounds, LongTextIsCutBetweenCharacters) {
  Alarm alarm;
  alarm.text = std::string(254, 'x') + "\xc3\xa4";  // 256 bytes, the last character of two
  const auto back = bus::from_cdr<Alarm>(bus::to_cdr(alarm));
  ASSERT_TRUE(back.has_value());
  EXPECT_EQ(back->text, std::string(254, 'x'));
}

TEST(Bounds, ARouteHasSoManyWaypoints) {
  Route route;
  route.waypoints.resize(Route::kMostWaypoints);
  auto bytes = bus::to_cdr(route);
  EXPECT_TRUE(bus::from_cdr<Route>(bytes).has_value());
  put(bytes, find(bytes, Route::kMostWaypoints), Route::kMostWaypoints + 1);
  bytes.resize(bytes.size() + 1000);
  EXPECT_FALSE(bus::from_cdr<Route>(bytes).has_value());
}

TEST(Bounds, LongListsAreCut) {
  ServiceStatus status;
  status.rates.resize(17);
  status.counters.resize(kMostCounters + 1);
  const auto back = bus::from_cdr<ServiceStatus>(bus::to_cdr(status));
  ASSERT_TRUE(back.has_value());
  EXPECT_EQ(back->rates.size(), 16U);
  EXPECT_EQ(back->counters.size(), kMostCounters);
}

}  // namespace
}  // namespace fathom
