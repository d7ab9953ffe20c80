#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>

#include "bus/detail/network/delivery_watch.hpp"

namespace fathom::bus::detail {

/// False for an RTPS datagram that ends a process which lets Fast DDS 2.9.1 read it (MessageReceiver). The
/// first two were found with datagrams made from good ones, the last is left out to be safe:
/// - Fast DDS ends what it sends with a submessage of its own (0x80, where and when it was sent) and asserts,
///   in one from another Fast DDS, that nothing is behind it;
/// - DATA and DATA_FRAG whose inline QoS goes on behind the submessage's end, or begins there: the size of
///   what is left becomes negative, and some 4 GB are copied;
/// - DATA_FRAG of a part that the sample does not have.
/// Submessages are walked as Fast DDS walks them; what else may be wrong it refuses by itself.
[[nodiscard]] bool harmless(std::span<const std::uint8_t> datagram);

/// Calls `look` for each claim (DATA, DATA_FRAG, HEARTBEAT, GAP) in a harmless datagram about the samples of
/// a writer, until one call returns false, which it returns.
bool all_claims(std::span<const std::uint8_t> datagram, const std::function<bool(const Claim&)>& look);

}  // namespace fathom::bus::detail
