#pragma once

#include <functional>
#include <string>

#include "base/exit_code.hpp"
#include "bus/participant.hpp"
#include "explain/history.hpp"

namespace CLI {
class App;
}

namespace fathom::cli {

struct LiveOptions {
  bus::ParticipantOptions bus;
  std::string vehicle;     ///< empty: the one that is heard first
  double last_s = 600.0;   ///< of what a recorder has
  double listen_s = 60.0;  ///< without one
};

/// What a running vehicle said.
using ReadLive = std::function<explain::History(const LiveOptions&)>;

/// The command `explain`, which reads recordings itself, and `read_live` for --live.
void add_explain(CLI::App& app, ExitCode& exit_code, ReadLive read_live);

}  // namespace fathom::cli
