#pragma once

// Blocks of Septentrio receivers, laid by hand from the SBF Reference of the mosaic-X5 Reference Guide.

#include <cstdint>
#include <span>

#include "base/bytes/little_endian.hpp"
#include "capture.hpp"
#include "codec/crc16.hpp"

namespace fathom::codec::sbf_bytes {

using capture::ByteVector;

constexpr std::uint32_t kTow_ms = 556'233'250;  // of week 2436: 2026-09-19 10:30:15.25, a Saturday
constexpr std::uint16_t kWeek = 2436;
constexpr float kNone = -2e10F;
constexpr unsigned kRevision1 = 1U << 13U;
constexpr unsigned kRevision2 = 2U << 13U;

inline ByteVector operator+(ByteVector a, const ByteVector& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

/// The CRC as the bytes are now.
inline ByteVector summed(ByteVector block) {
  store_le<std::uint16_t>(block, 2, crc16_ccitt(std::span(block).subspan(4)));
  return block;
}

/// `body` follows time of the week and week, and fills whole words of four bytes.
inline ByteVector block(unsigned id, const ByteVector& body, std::uint32_t tow_ms = kTow_ms,
                        std::uint16_t week = kWeek) {
  ByteVector out{'$', '@', 0, 0};
  append_le<std::uint16_t>(out, static_cast<std::uint16_t>(id));
  append_le<std::uint16_t>(out, static_cast<std::uint16_t>(14 + body.size()));
  append_le<std::uint32_t>(out, tow_ms);
  append_le<std::uint16_t>(out, week);
  return summed(out + body);
}

struct PvtFields {
  std::uint32_t tow_ms = kTow_ms;
  std::uint16_t week = kWeek;
  unsigned revision = kRevision2;
  std::uint8_t mode = 1;
  std::uint8_t error = 0;
  double latitude_rad = -0.625;
  double longitude_rad = 2.25;
  double height_m = 44.5;
  float undulation_m = 26.25F;
  float north_m_s = 1.5F;
  float up_m_s = 0.25F;
  float course_deg = 341.5F;
  std::uint8_t datum = 0;
  std::uint8_t satellites = 17;
  std::uint8_t alert = 1;
  std::uint16_t horizontal_cm = 400;
  std::uint16_t vertical_cm = 500;
  std::size_t size = 96;
};

inline ByteVector pvt(const PvtFields& f = {}) {
  ByteVector body{f.mode, f.error};
  for (const double v : {f.latitude_rad, f.longitude_rad, f.height_m}) append_le<double>(body, v);
  for (const float v : {f.undulation_m, f.north_m_s, -0.5F, f.up_m_s, f.course_deg})
    append_le<float>(body, v);
  append_le<double>(body, 0.125);                                      // bias of the clock, ms
  append_le<float>(body, 0.5F);                                        // drift
  body = body + ByteVector{0, f.datum, f.satellites, 0};               // GPS time; no corrections
  body = body + ByteVector{0xFF, 0xFF, 0xFF, 0xFF, 0x0D, 0x09, 0, 0};  // reference, age, signals
  body = body + ByteVector{f.alert, 0, 0, 0};                          // bases, PPP
  append_le<std::uint16_t>(body, 52);                                  // latency, 0.1 ms
  append_le<std::uint16_t>(body, f.horizontal_cm);
  append_le<std::uint16_t>(body, f.vertical_cm);
  body = body + ByteVector{0, 0};
  body.resize(f.size - 14);
  return block(4007 | f.revision, body, f.tow_ms, f.week);
}

constexpr unsigned kPosition = 5906;
constexpr unsigned kVelocity = 5908;

struct CovarianceFields {
  std::uint32_t tow_ms = kTow_ms;
  std::uint8_t mode = 1;
  std::uint8_t error = 0;
  float north = 0.25F;
  float east = 1.0F;
  float vertical = 2.25F;
  std::size_t size = 56;
};

inline ByteVector covariance(unsigned id, const CovarianceFields& f = {}) {
  ByteVector body{f.mode, f.error};
  for (const float v : {f.north, f.east, f.vertical, 9.0F}) append_le<float>(body, v);
  for (int i = 0; i < 6; ++i) append_le<float>(body, -0.5F);
  body.resize(f.size - 14);
  return block(id, body, f.tow_ms);
}

struct AttitudeFields {
  std::uint32_t tow_ms = kTow_ms;
  std::uint16_t week = kWeek;
  std::uint8_t error = 0;
  std::uint16_t mode = 2;
  float heading_deg = 271.5F;
  std::size_t size = 44;
};

inline ByteVector attitude(const AttitudeFields& f = {}) {
  ByteVector body{12, f.error};
  append_le<std::uint16_t>(body, f.mode);
  append_le<std::uint16_t>(body, 0);
  for (const float v : {f.heading_deg, -1.5F, kNone, 0.25F, kNone, 0.5F}) append_le<float>(body, v);
  body.resize(f.size - 14);
  return block(5938, body, f.tow_ms, f.week);
}

inline ByteVector attitude_covariance(std::uint32_t tow_ms = kTow_ms, float heading_deg2 = 0.0625F,
                                      std::size_t size = 40) {
  ByteVector body{0, 0};
  for (const float v : {heading_deg2, 0.25F, kNone, kNone, kNone, kNone}) append_le<float>(body, v);
  body.resize(size - 14);
  return block(5939, body, tow_ms);
}

inline ByteVector end_of_pvt(std::uint32_t tow_ms = kTow_ms) {
  return block(5921, {0, 0}, tow_ms);
}
inline ByteVector end_of_att(std::uint32_t tow_ms = kTow_ms) {
  return block(5943, {0, 0}, tow_ms);
}

/// 2026-09-19 10:30:15 UTC.
inline ByteVector receiver_time(std::int8_t leap_seconds, std::size_t size = 24) {
  ByteVector body{26, 9, 19, 10, 30, 15, static_cast<std::uint8_t>(leap_seconds), 7, 0, 0};
  body.resize(size - 14);
  return block(5914, body);
}

}  // namespace fathom::codec::sbf_bytes
