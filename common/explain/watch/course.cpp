#include "explain/watch/watches.hpp"

namespace fathom::explain {

void watch_course(const History& /*history*/, const Track& /*track*/, Findings& /*out*/) {}

}  // namespace fathom::explain
