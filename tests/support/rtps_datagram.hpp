#pragma once

// RTPS datagrams by hand, right ones and wrong ones.

#include <cstddef>
#include <cstdint>
#include <vector>

namespace fathom::test::rtps {

using Bytes = std::vector<std::uint8_t>;

constexpr std::uint8_t kHeartbeat = 0x07;
constexpr std::uint8_t kTimestamp = 0x09;
constexpr std::uint8_t kStatistics = 0x80;

/// "RTPS", version, vendor and a GUID prefix, then these submessages.
inline Bytes datagram(const std::vector<Bytes>& submessages, std::uint8_t vendor = 0x0F) {
  Bytes out{'R', 'T', 'P', 'S', 2, 2, 0x01, vendor};
  out.resize(20, 0x11);
  for (const Bytes& one : submessages) out.insert(out.end(), one.begin(), one.end());
  return out;
}

inline void put_u16(Bytes& out, std::size_t at, unsigned value, bool little = true) {
  out[at] = static_cast<std::uint8_t>(little ? value : value >> 8U);
  out[at + 1] = static_cast<std::uint8_t>(little ? value >> 8U : value);
}

inline Bytes submessage(std::uint8_t id, std::uint16_t length, bool little = true) {
  Bytes out{id, static_cast<std::uint8_t>(little ? 1 : 0), 0, 0};
  put_u16(out, 2, length, little);
  out.resize(4U + length, 0xA5);
  return out;
}

/// A parameter, or a sentinel when `id` is 1.
inline Bytes parameter(std::uint16_t id, std::uint16_t length, bool little = true) {
  Bytes out(4U + (id == 1 ? 0U : length), 0x5A);
  put_u16(out, 0, id, little);
  put_u16(out, 2, length, little);
  return out;
}

/// DATA, or DATA_FRAG of the second of three fragments of 100 bytes; `offset` to the inline QoS as it says.
inline Bytes data(const std::vector<Bytes>& inline_qos, std::size_t payload, bool little = true,
                  int offset = -1, bool fragment = false) {
  const std::size_t fixed = fragment ? 32 : 20;
  Bytes out(4 + fixed, 0);
  out[0] = fragment ? 0x16 : 0x15;
  out[1] =
      static_cast<std::uint8_t>((little ? 1U : 0U) | (inline_qos.empty() ? 0U : 2U) | (fragment ? 0U : 4U));
  put_u16(out, 6, offset < 0 ? static_cast<unsigned>(fixed - 4) : static_cast<unsigned>(offset), little);
  if (fragment) {
    put_u16(out, little ? 24 : 26, 2, little);    // first
    put_u16(out, 28, 1, little);                  // so many
    put_u16(out, 30, 100, little);                // size of one
    put_u16(out, little ? 32 : 34, 300, little);  // of the sample
  }
  for (const Bytes& one : inline_qos) out.insert(out.end(), one.begin(), one.end());
  out.resize(out.size() + payload, 0xA5);
  put_u16(out, 2, static_cast<unsigned>(out.size() - 4), little);
  return out;
}

}  // namespace fathom::test::rtps
