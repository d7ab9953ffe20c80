#pragma once

#include "sim/encode/novatel.hpp"
#include "support/codec/seed_streams.hpp"

namespace fathom::test {

/// Velocity before position, then after it, now and then none; both headings; inertial data, the position of
/// the secondary antenna, and an answer to a command.
inline ByteVector novatel_logs(const GpsSample& fix, const HeadingSample& heading, TimeNs utc_ns, int frame) {
  namespace encode = sim::encode;
  ByteVector out;
  const auto add = [&](const ByteVector& log) { out.insert(out.end(), log.begin(), log.end()); };
  if (frame % 4 == 0) add(encode::novatel_time(utc_ns));
  if (frame % 2 == 0) add(encode::novatel_velocity(fix, utc_ns));
  add(encode::novatel_position(fix, utc_ns));
  add(encode::novatel_short_log(325, utc_ns, ByteVector(40, 0x44)));
  if (frame % 4 == 1) add(encode::novatel_velocity(fix, utc_ns));
  add(encode::novatel_heading(heading, utc_ns));
  add(encode::novatel_heading(heading, utc_ns, encode::NovatelHeadingLog::heading2));
  add(encode::novatel_position(fix, utc_ns, {.message_type = 1}));
  add(encode::novatel_log(1, utc_ns, ByteVector(6, 'K'), {.message_type = 0x82}));
  return out;
}

}  // namespace fathom::test
