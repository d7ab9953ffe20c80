#include <array>

#include "explain/watch/watches.hpp"

namespace fathom::explain {
namespace {

struct Said {
  bool deceived = false;
  std::uint64_t count = 0;
  TimeNs begin_ns = 0;
  TimeNs end_ns = 0;
};

void note(Said& said, const FixRow& row) {
  if (said.count++ == 0) said.begin_ns = row.stamp_ns;
  said.end_ns = row.stamp_ns;
}

}  // namespace

void watch_receivers(const History& history, Findings& out) {
  for (std::size_t i = 0; i < history.streams().size(); ++i) {
    std::array<Said, 2> all;
    for (const FixRow& row : history.fixes()) {
      if (row.stream != i) continue;
      if (row.spoofing >= GpsSpoofing::indicated) note(all[0], row);
      if (row.jamming == GpsJamming::critical) note(all[1], row);
    }
    for (std::size_t k = 0; k < all.size(); ++k) {
      if (all[k].count == 0) continue;
      out.push_back({.kind = Kind::interference,
                     .weight = Weight::bad,
                     .subject = history.streams()[i].sensor.str(),
                     .begin_ns = all[k].begin_ns,
                     .end_ns = all[k].end_ns,
                     .word = k == 0 ? "deceived" : "jammed",
                     .figures = {{"count", static_cast<double>(all[k].count)}},
                     .evidence = {{"fathom/v1/gps", all[k].count, k == 0 ? "spoofing" : "jamming"}}});
    }
  }
}

}  // namespace fathom::explain
