#include "archive/checkpoint.hpp"

#include <gtest/gtest.h>

namespace fathom::archive {
namespace {

CheckpointLabel label(TimeNs stamp_ns = 1'700'000'000 * kNsPerSecond) {
  return {"auv", "fusion", "0123456789abcdef", "0.1.0+abc-89abcdef", stamp_ns};
}

std::vector<std::byte> image(std::size_t size) {
  std::vector<std::byte> out(size);
  for (std::size_t i = 0; i < size; ++i) out[i] = static_cast<std::byte>(i * 37 >> 3);
  return out;
}

TEST(Checkpoint, ComesBackAsItWas) {
  for (const std::size_t size : {std::size_t{0}, std::size_t{1}, std::size_t{100'000}}) {
    std::vector<std::byte> bytes;
    encode(label(), image(size), bytes);
    const auto found = decode(bytes);
    ASSERT_TRUE(found) << found.error().message;
    EXPECT_EQ(found.value().label.vehicle, "auv");
    EXPECT_EQ(found.value().label.service, "fusion");
    EXPECT_EQ(found.value().label.configuration, label().configuration);
    EXPECT_EQ(found.value().label.build, label().build);
    EXPECT_EQ(found.value().label.stamp_ns, label().stamp_ns);
    EXPECT_EQ(found.value().archive, image(size));
  }
}

TEST(Checkpoint, EveryFlippedBitAndEveryCutIsNoticed) {
  std::vector<std::byte> good;
  encode(label(), image(64), good);
  for (std::size_t i = 0; i < good.size(); ++i) {
    std::vector<std::byte> bad = good;
    bad[i] ^= std::byte{0x10};
    EXPECT_FALSE(decode(bad)) << i;
    EXPECT_FALSE(decode(std::span(good).first(i))) << i;
  }
  good.push_back(std::byte{0});
  EXPECT_FALSE(decode(good));
}

TEST(Checkpoint, AnotherFormatIsNamed) {
  std::vector<std::byte> bytes;
  encode(label(), image(8), bytes);
  bytes[8] = std::byte{9};
  EXPECT_EQ(decode(bytes).error().message, "is a checkpoint of format 9, format 2 was expected");
  EXPECT_EQ(decode(image(500)).error().message, "is no checkpoint");
}

TEST(Checkpoint, WhoseAndWhenDecide) {
  const CheckpointLabel own = label();
  EXPECT_EQ(objection(label(own.stamp_ns - 5 * kNsPerSecond), own, 60.0), "");
  EXPECT_EQ(objection(label(own.stamp_ns - 61 * kNsPerSecond), own, 60.0),
            "is 61.0 s old, at most 60.0 s is gone on from");
  EXPECT_EQ(objection(label(own.stamp_ns + kNsPerSecond / 2), own, 60.0), "") << "clocks differ a little";
  EXPECT_EQ(objection(label(own.stamp_ns + 3600 * kNsPerSecond), own, 60.0), "is 3600.0 s from the future");
  CheckpointLabel other = own;
  other.vehicle = "auv2";
  EXPECT_EQ(objection(other, own, 60.0), "is of vehicle auv2, not of auv");
  other = own;
  other.service = "fusion_b";
  EXPECT_EQ(objection(other, own, 60.0), "is of service fusion_b, not of fusion");
  other = own;
  other.configuration = "fedc";
  EXPECT_EQ(objection(other, own, 60.0), "is of configuration fedc, not of 0123456789abcdef");
  other = own;
  other.build = "0.2.0";
  EXPECT_EQ(objection(other, own, 60.0), "") << "builds share states: the archive says itself what it holds";
}

}  // namespace
}  // namespace fathom::archive
