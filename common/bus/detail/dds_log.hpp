#pragma once

#include <string>

namespace fathom::bus::detail {

/// Keeps Fast DDS from writing to standard output; its latest error is kept for our own messages. Idempotent.
void capture_dds_log();

/// The latest error of Fast DDS in parentheses with a leading space, e.g. to end a message with; empty when
/// there was none.
[[nodiscard]] std::string last_dds_error();

}  // namespace fathom::bus::detail
