#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>

#include "bus/detail/network/acknowledgements.hpp"
#include "bus/detail/network/delivery_watch.hpp"

namespace fathom::bus::detail {

/// Whether a process survives when Fast DDS 2.9.1 (MessageReceiver) reads this RTPS datagram. Mutated
/// datagrams showed the first two faults; the third one is a precaution:
/// - A submessage of Fast DDS (0x80, where and when the datagram was sent) that is not the last one. Fast
///   DDS asserts that nothing follows it.
/// - DATA or DATA_FRAG whose inline QoS begins at the submessage's end or goes on behind it. The size of
///   the rest becomes negative, and some 4 GB are copied.
/// - DATA_FRAG of a part that the sample does not have.
/// The check walks through the submessages as Fast DDS does. Fast DDS itself refuses all other faults.
[[nodiscard]] bool harmless(std::span<const std::uint8_t> datagram);

/// Calls `look` for each claim (DATA, DATA_FRAG, HEARTBEAT, GAP) in a harmless datagram about the samples of
/// a writer, until one call returns false, which it returns.
bool all_claims(std::span<const std::uint8_t> datagram, const std::function<bool(const Claim&)>& look);

/// Calls `look` for each ACKNACK in a datagram.
void all_acknowledgements(std::span<const std::uint8_t> datagram,
                          const std::function<void(const Acknowledgement&)>& look);

/// Makes of an ACKNACK in this datagram the one of a reader that has just met the writer: it has nothing,
/// asks for nothing yet, and expects an answer.
void begin_anew(std::span<std::uint8_t> datagram, const Acknowledgement& one);

}  // namespace fathom::bus::detail
