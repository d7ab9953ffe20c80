// Frames and signatures of MAVLink: layout, checksum seeds as published, resynchronisation, trust.

#include "mavlink/frame.hpp"

#include <algorithm>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "mavlink/known.hpp"
#include "mavlink/messages.hpp"
#include "mavlink/signing.hpp"

namespace fathom::mavlink {
namespace {

template <class... M>
struct Messages {};
using All =
    Messages<Heartbeat, SystemTime, GpsRawInt, ScaledImu, ScaledPressure, Attitude, SetGpsGlobalOrigin,
             VisionPositionEstimate, Timesync, DistanceSensor, ScaledPressure2, GpsInput, Odometry>;

template <class M>
void expect_as_published() {
  const Known* known = find_known(M::kId);
  ASSERT_NE(known, nullptr) << M::kName;
  EXPECT_EQ(Definition<M>::kCrcExtra, known->crc_extra)
      << M::kName << ": names, types or order of its fields";
  EXPECT_EQ(Definition<M>::kSize, known->longest) << M::kName;
}

template <class M>
void expect_there_and_back(std::mt19937_64& random) {
  for (int i = 0; i < 50; ++i) {
    std::array<std::uint8_t, Definition<M>::kSize> bytes{};
    for (auto& byte : bytes) byte = static_cast<std::uint8_t>(random());
    if (i % 2 == 0)
      std::fill(bytes.begin() + static_cast<std::ptrdiff_t>(random() % bytes.size()), bytes.end(), 0);
    const M message = message_of<M>(bytes);
    const auto frame = frame_of(message, {7, 42}, 200);
    const Look look = look_at(frame);
    ASSERT_EQ(look.kind, Look::Kind::frame) << M::kName;
    EXPECT_EQ(look.length, frame.size());
    EXPECT_EQ(look.frame.id, M::kId);
    EXPECT_EQ(look.frame.system, 7);
    EXPECT_EQ(look.frame.component, 42);
    EXPECT_EQ(look.frame.sequence, 200);
    EXPECT_EQ(payload_of(message_of<M>(look.frame.payload)), bytes) << "zeros at the end come back";
  }
}

template <class... M>
void for_all(Messages<M...> /*all*/) {
  (expect_as_published<M>(), ...);
  std::mt19937_64 random(3);
  (expect_there_and_back<M>(random), ...);
}

TEST(Mavlink, EveryMessageHasThePublishedLayoutAndGoesThereAndBack) {
  for_all(All{});
}

// A frame of version 1, its bytes by hand: HEARTBEAT of a copter.
TEST(Mavlink, TheOlderVersionIsReadAsWell) {
  std::vector<std::uint8_t> frame{0xFE, 9, 5, 1, 1, 0, 0, 0, 0, 0, 2, 3, 81, 3, 3};
  const std::uint16_t crc = crc_with(50, crc_of(Bytes(frame).subspan(1)));
  frame.push_back(static_cast<std::uint8_t>(crc & 0xFFU));
  frame.push_back(static_cast<std::uint8_t>(crc >> 8U));
  const Look look = look_at(frame);
  ASSERT_EQ(look.kind, Look::Kind::frame);
  const auto heartbeat = message_of<Heartbeat>(look.frame.payload);
  EXPECT_EQ(heartbeat.type, 2);
  EXPECT_EQ(heartbeat.autopilot, 3);
  EXPECT_EQ(heartbeat.base_mode, 81);
}

TEST(Mavlink, NoiseAndDamageNeverPassAndTheNextFrameIsFound) {
  std::mt19937_64 random(11);
  for (int run = 0; run < 300; ++run) {
    std::vector<std::uint8_t> stream(random() % 300);
    for (auto& byte : stream) byte = static_cast<std::uint8_t>(random());
    Attitude attitude;
    attitude.yaw = 1.5F;
    auto damaged = frame_of(attitude, {}, 1);
    damaged[random() % damaged.size()] ^= static_cast<std::uint8_t>(1U << (random() % 8));
    stream.insert(stream.end(), damaged.begin(), damaged.end());
    const auto good = frame_of(attitude, {}, 2);
    for (int i = 0; i < 3; ++i) stream.insert(stream.end(), good.begin(), good.end());
    stream.resize(stream.size() + kMostFrame);  // so that a false start does not wait for ever
    int found = 0;
    for (std::size_t at = 0; at < stream.size();) {
      const Look look = look_at(Bytes(stream).subspan(at));
      if (look.kind == Look::Kind::need) break;
      if (look.kind == Look::Kind::frame) {
        EXPECT_EQ(look.frame.id, Attitude::kId);
        EXPECT_EQ(look.frame.sequence, 2);
        ++found;
      }
      ASSERT_GT(look.length, 0U);
      at += look.kind == Look::Kind::frame || look.kind == Look::Kind::skip ? look.length : 1;
    }
    EXPECT_GE(found, 2) << "a false start may take one of them with it";
  }
}

TEST(Signing, WhoHasTheKeyIsHeardOnceAndNobodyElse) {
  Key key{};
  key.fill(0x42);
  Key other = key;
  other[31] = 0;
  const TimeNs now = 1'800'000'000 * kNsPerSecond;
  Signer signer(key, 3);
  Verifier verifier(key);
  const auto judge = [&](const std::vector<std::uint8_t>& frame, TimeNs at) {
    const Look look = look_at(frame);
    EXPECT_EQ(look.kind, Look::Kind::frame);
    return verifier.judge(look.frame, at);
  };
  const auto make = [&](TimeNs at) {
    auto frame = frame_of(Heartbeat{}, {}, 0, kFlagSigned);
    signer.sign(frame, at);
    return frame;
  };
  const auto first = make(now);
  EXPECT_EQ(first.size(), kHeaderV2 + 9 + kChecksum + kSignature);
  EXPECT_EQ(judge(first, now), Trust::trusted);
  EXPECT_EQ(judge(first, now), Trust::said_before);
  EXPECT_EQ(judge(make(now - kNsPerSecond), now), Trust::trusted) << "our own clock was set back";
  EXPECT_EQ(judge(frame_of(Heartbeat{}, {}, 0), now), Trust::not_signed);
  auto forged = make(now);
  forged.back() ^= 1U;
  EXPECT_EQ(judge(forged, now), Trust::wrong_signature);
  Signer stranger(other, 3);
  auto strange = frame_of(Heartbeat{}, {}, 0, kFlagSigned);
  stranger.sign(strange, now + kNsPerSecond);
  EXPECT_EQ(judge(strange, now), Trust::wrong_signature);
  Signer old(key, 4);
  auto recorded = frame_of(Heartbeat{}, {}, 0, kFlagSigned);
  old.sign(recorded, now - 61 * kNsPerSecond);
  EXPECT_EQ(judge(recorded, now), Trust::too_old) << "recorded, and played to one that has just started";
}

TEST(Signing, AKeyIsSixtyFourDigits) {
  EXPECT_TRUE(key_of(std::string(64, 'a') + "\n").ok());
  EXPECT_EQ(key_of(std::string(64, 'a')).value()[0], 0xAA);
  for (const std::string& bad :
       {std::string(63, 'a'), std::string(66, 'a'), std::string(63, 'a') + "g", std::string()})
    EXPECT_FALSE(key_of(bad).ok()) << bad;
}

}  // namespace
}  // namespace fathom::mavlink
