#include "bus/detail/qos/conflicts.hpp"

#include <utility>

namespace fathom::bus::detail {

void report_conflicts(EventBook& events, const std::string& topic, const std::set<std::string>& others,
                      Policy policy, const QosSummary& own, bool own_reads, std::uint64_t occurrences) {
  const std::string what = to_string(policy);
  for (const std::string& name : others) {
    const std::string subject = name + (own_reads ? " writes, " : " reads, ") + what;
    const std::string detail = own_reads ? "the writer of " + name + " offers another " + what +
                                               " than this reader requests (" + value_text(policy, own) + ")"
                                         : "the reader of " + name + " requests another " + what +
                                               " than this writer offers (" + value_text(policy, own) + ")";
    events.report(BusEventKind::incompatible_qos, topic, subject, detail, std::exchange(occurrences, 0));
  }
}

}  // namespace fathom::bus::detail
