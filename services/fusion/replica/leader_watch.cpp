#include "fusion/replica/leader_watch.hpp"

namespace fathom::fusion {

LeaderWatch::Participant LeaderWatch::of(const WriterGuid& writer) {
  Participant out;
  std::copy_n(writer.begin(), out.size(), out.begin());
  return out;
}

void LeaderWatch::heard(const Name& instance, const WriterGuid& writer, TimeNs now_ns) {
  leader_ = instance;
  led_by_ = of(writer);
  heard_ns_ = now_ns;
}

void LeaderWatch::told(const ReplicaStatus& status, const WriterGuid& writer, TimeNs now_ns) {
  const Participant from = of(writer);
  if (!accounts_.contains(from) && accounts_.size() == kMost) {
    std::erase_if(accounts_, [&](const auto& one) { return now_ns - one.second.told_ns > patience_ns_; });
    if (accounts_.size() == kMost) return;
  }
  Account& account = accounts_[from];
  if (account.instance != status.header.sensor) account = {};
  if (status.leads && !account.leads) account.leads_since_ns = now_ns;
  if (status.leads) account.led_ns = now_ns;
  account.instance = status.header.sensor;
  account.leads = status.leads;
  account.told_ns = now_ns;
}

LeaderWatch::Objection LeaderWatch::objection(const Name& instance, const WriterGuid& writer,
                                              TimeNs now_ns) const {
  const Participant from = of(writer);
  const auto found = accounts_.find(from);
  const bool accounted =
      found != accounts_.end() && found->second.instance == instance && fresh(found->second.told_ns, now_ns);
  const bool heard = led_by_ && fresh(heard_ns_, now_ns);
  if (heard && from == *led_by_ && instance == leader_) {
    // What it says of itself may come a little later.
    return accounted && found->second.leads ? Objection{} : Objection{"comes before it says that it leads"};
  }
  // One that begins or ends to lead may be a moment ahead or behind.
  const bool begins = accounted && found->second.leads && fresh(*found->second.leads_since_ns, now_ns);
  const bool ends =
      accounted && !found->second.leads && found->second.led_ns && fresh(*found->second.led_ns, now_ns);
  Objection out{"", !begins && !ends};
  if (!heard) {
    out.why = "comes while nobody is heard to lead";
  } else if (instance == leader_) {
    out.why = "comes from another participant than the " + leader_.str() + " that is heard to lead";
  } else {
    out.why = "is not that of " + leader_.str() + ", which leads";
  }
  return out;
}

}  // namespace fathom::fusion
