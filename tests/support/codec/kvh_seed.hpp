#pragma once

#include "sim/encode/imu/kvh.hpp"
#include "support/codec/seed_streams.hpp"

namespace fathom::test {

/// Every format, a unit whose gyros are not ready yet, and results of both tests between them.
inline ByteVector kvh_messages(ImuSample sample, int frame) {
  namespace encode = sim::encode;
  encode::KvhMessage message;
  message.sequence = static_cast<std::uint16_t>(124 + frame);
  message.clock_us = 0xFFFF'F000U + 1'000U * static_cast<std::uint32_t>(frame);  // begins again behind four
  ByteVector out;
  const auto add = [&](const ByteVector& bytes) { out.insert(out.end(), bytes.begin(), bytes.end()); };
  if (frame % 3 == 0) add(encode::kvh_test(frame % 2 == 0));
  if (frame == 1) sample.angular_rate_B_rad_s.fill(kUnknown);
  for (const auto format : {codec::kvh::Format::a, codec::kvh::Format::b, codec::kvh::Format::c}) {
    message.format = format;
    add(encode::kvh(sample, message));
  }
  return out;
}

}  // namespace fathom::test
