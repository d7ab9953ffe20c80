#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "cli/decode/rejection_runs.hpp"
#include "codec/codec.hpp"

namespace fathom::cli {

/// UTC of validity as far as the bytes alone say it: UTC given by the device, else a calendar clock of the
/// device that nobody vouches for. 0 when neither (a time of day needs a date, a count since start an epoch).
[[nodiscard]] TimeNs utc_of(const codec::DeviceTime& time);

/// One line each, without line end. Keys are the data set's column names, unknown is null, numbers read back
/// to the same bits.
[[nodiscard]] std::string to_json(const codec::Decoded& decoded);
/// "count" only of a run of several frames.
[[nodiscard]] std::string to_json(const RejectionRun& run);
[[nodiscard]] std::string to_json(const codec::Totals& totals);

}  // namespace fathom::cli
