#pragma once

#include <cstdint>
#include <set>
#include <string>

#include "bus/detail/event_book.hpp"
#include "bus/detail/qos/qos_summary.hpp"

namespace fathom::bus::detail {

/// Reports that the endpoints of `others` on this topic have another policy than our own endpoint, which
/// reads or else writes. The occurrences are counted once.
void report_conflicts(EventBook& events, const std::string& topic, const std::set<std::string>& others,
                      Policy policy, const QosSummary& own, bool own_reads, std::uint64_t occurrences);

}  // namespace fathom::bus::detail
