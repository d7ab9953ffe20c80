#pragma once

#include <cstdint>
#include <vector>

#include "codec/imu/kvh.hpp"
#include "samples/imu.hpp"

namespace fathom::sim::encode {

/// What a message of a KVH unit says besides the sample, and how the unit is set.
struct KvhMessage {
  codec::kvh::Format format = codec::kvh::Format::a;
  std::uint16_t sequence = 0;  ///< goes on from 0 behind 127
  std::uint32_t clock_us = 0;  ///< of format B
  codec::KvhOptions options{};
};

/// One message of the normal mode, in single precision and g. With `increments_hz` the rates are those of the
/// delta angles. An axis that is unknown is not called valid. The temperature is a whole number but in format
/// C, whose other messages have a magnetic field of 0; unknown, it is 0.
[[nodiscard]] std::vector<std::uint8_t> kvh(const ImuSample& sample, const KvhMessage& message);

/// The result of a built-in test in which nothing failed; the longer one also has the magnetometer's.
[[nodiscard]] std::vector<std::uint8_t> kvh_test(bool longer);

}  // namespace fathom::sim::encode
