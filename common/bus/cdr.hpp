#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace fathom::bus {

/// The bytes of a sample as they travel: XCDR1 with its 4-byte encapsulation header, in this host's byte
/// order. For recorders. Instantiated for every topic's type. Text and lists beyond the bounds of the IDL are
/// cut.
template <class T>
std::vector<std::uint8_t> to_cdr(const T& sample);

/// The sample behind such bytes, of either byte order. Nothing when they are not a complete sample of this
/// type or hold an unknown enumerator or an overlong list.
template <class T>
std::optional<T> from_cdr(std::span<const std::uint8_t> bytes);

}  // namespace fathom::bus
