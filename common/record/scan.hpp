#pragma once

#include "base/result.hpp"
#include "record/contents.hpp"
#include "record/file.hpp"
#include "record/walk.hpp"

namespace fathom::record {

/// Contents from the summary at the end of a file. The error says why there is none to go by.
[[nodiscard]] Result<Contents> read_summary(Source& source, const Limits& limits);

/// Contents by going through the whole file, up to its last whole record. An error only where not even the
/// header is there.
[[nodiscard]] Result<Contents> scan(Source& source, const Limits& limits);

/// Holds a file's magic and header against the specification; where the data begins.
[[nodiscard]] Result<std::uint64_t> read_header(Source& source, const Limits& limits, Header& header);

/// Notes a problem, as long as there are not too many.
void note(std::vector<std::string>& problems, std::uint64_t offset, const std::string& what);

}  // namespace fathom::record
