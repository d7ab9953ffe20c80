#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "codec/codec.hpp"

namespace fathom::bridge {

/// The begin of a frame as a log shows it: text in quotation marks, anything else in hexadecimal.
[[nodiscard]] std::string shown(std::span<const std::uint8_t> frame);

/// Why a frame was refused, and which: `frame of 17 bytes refused (field: a field is not a number, or none of
/// its words): "$SDDBT,,f,x,M,,F"`.
[[nodiscard]] std::string sentence(const codec::Rejected& rejected);

}  // namespace fathom::bridge
