#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "logs/ros2/schema.hpp"

namespace fathom::logs::ros2 {

/// What a message says, in the order of its schema's columns and texts.
struct Row {
  std::vector<double> values;           ///< unknown for elements that a sequence does not have
  std::vector<std::string_view> texts;  ///< of the message's bytes; empty likewise
};

/// Reads a message in CDR (XCDR version 1, either byte order) with its encapsulation header, as a schema
/// lays it out. Returns nothing, or what is wrong with which field at which offset. A 64-bit integer above
/// 2^53 is rounded.
[[nodiscard]] std::string decode(const Schema& schema, std::span<const std::uint8_t> message, Row& row);

}  // namespace fathom::logs::ros2
