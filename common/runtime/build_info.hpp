#pragma once

#include <string>
#include <string_view>

namespace fathom::runtime {

/// Release and commit of this build, e.g. "0.1.0+abc1234".
[[nodiscard]] std::string_view version();

/// Name of this host; "unknown" when the system does not say.
[[nodiscard]] std::string host_name();

/// 16 hex digits of the text's FNV-1a hash: tells two configurations apart, protects nothing.
[[nodiscard]] std::string hex_hash(std::string_view text);

}  // namespace fathom::runtime
