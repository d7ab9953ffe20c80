#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "base/time.hpp"
#include "bus/participant.hpp"
#include "record/reader.hpp"

namespace fathom::blackbox {

struct PlayOptions {
  double speed = 1.0;                             ///< 0: as fast as it goes
  record::Selection selection;                    ///< topics that this build does not know are left out
  std::map<std::string, std::string> vehicles{};  ///< old name, new name
  bool now = false;                               ///< stamps are moved, so that the first sample happens now
};

struct Played {
  std::uint64_t samples = 0;
  std::uint64_t refused = 0;  ///< no samples of their topics, or not to be written
  std::vector<std::string> problems{};
};

/// Publishes the messages of a recording in their order, at the times of their arrival. `go_on` is asked
/// between messages, at least every 50 ms, and ends it with false. Throws BusError.
[[nodiscard]] Played play(record::Reader& reader, bus::Participant& participant, const PlayOptions& options,
                          const std::function<bool()>& go_on);

}  // namespace fathom::blackbox
