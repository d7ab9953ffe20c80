#include "fusion/replica/verdict_relay.hpp"

#include <algorithm>

namespace fathom::fusion {
namespace {

bool same(const Verdict& a, const Verdict& b) {
  return a.source == b.source && a.header.sequence == b.header.sequence &&
         a.header.stamp_ns == b.header.stamp_ns && a.header.sensor == b.header.sensor &&
         a.is_final == b.is_final && (a.is_final || a.revision == b.revision);
}

}  // namespace

void VerdictRelay::own(const Verdict& verdict, TimeNs now_ns) {
  if (!take_from(heard_, verdict, now_ns)) keep(own_, verdict, now_ns);
}

void VerdictRelay::heard(const Verdict& verdict, TimeNs now_ns) {
  if (!take_from(own_, verdict, now_ns)) keep(heard_, verdict, now_ns);
}

bool VerdictRelay::was_heard(const Verdict& verdict, TimeNs now_ns) {
  return take_from(heard_, verdict, now_ns);
}

bool VerdictRelay::next_unsaid(Verdict& verdict, TimeNs now_ns) {
  forget_old(own_, now_ns);
  if (own_.empty()) return false;
  verdict = own_.front().verdict;
  own_.pop_front();
  return true;
}

void VerdictRelay::clear() {
  own_.clear();
  heard_.clear();
}

bool VerdictRelay::take_from(Entries& among, const Verdict& verdict, TimeNs now_ns) const {
  forget_old(among, now_ns);
  const auto found = std::find_if(among.begin(), among.end(),
                                  [&](const Entry& entry) { return same(entry.verdict, verdict); });
  if (found == among.end()) return false;
  among.erase(found);
  return true;
}

void VerdictRelay::keep(Entries& entries, const Verdict& verdict, TimeNs now_ns) {
  if (entries.size() == kMost) entries.pop_front();
  entries.push_back({verdict, now_ns});
}

void VerdictRelay::forget_old(Entries& entries, TimeNs now_ns) const {
  while (!entries.empty() && now_ns - entries.front().at_ns > keep_ns_) entries.pop_front();
}

}  // namespace fathom::fusion
