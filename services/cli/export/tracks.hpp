#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/time.hpp"
#include "cli/export/recorded.hpp"
#include "exchange/track.hpp"

namespace fathom::cli {

/// UTC of t_s = 0: `asked` (ISO 8601), else what import.json of the folder says; none where nobody says it.
/// Throws Failure where `asked` is no instant.
[[nodiscard]] std::optional<TimeNs> epoch_of(const std::string& source, const std::string& asked);

/// The tracks of nav.csv ("nav") or of a data set ("gps", "usbl", "reference"), those that have points. At
/// most `rate_hz` points a second, all at 0. Throws DatasetError.
[[nodiscard]] std::vector<exchange::Track> read_tracks(const std::string& source, TimeNs epoch_ns,
                                                       double rate_hz);

/// Those of a recording: "nav", as it was published, and those of its data set.
[[nodiscard]] std::vector<exchange::Track> tracks_of(const Recorded& recorded, double rate_hz);

/// Copies a CSV with a column utc before the others. Throws DatasetError.
void copy_with_utc(const std::string& source, const std::string& out, TimeNs epoch_ns);

}  // namespace fathom::cli
