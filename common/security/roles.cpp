#include "security/roles.hpp"

#include <algorithm>
#include <vector>

#include "samples/kinds.hpp"

namespace fathom::security {
namespace {

using Topics = std::vector<std::string_view>;

constexpr std::string_view kLifeSign = "fathom/v1/service_status";  // every service writes it

/// The topics of all instruments, and these.
Topics instruments_and(std::initializer_list<std::string_view> others) {
  Topics topics;
  for_each_kind([&](auto kind) { topics.push_back(kind.kTopic); });
  topics.insert(topics.end(), others);
  return topics;
}

/// The topic of a bridge that has one.
std::string_view published_by(std::string_view bridge) {
  std::string_view topic;
  for_each_kind([&](auto kind) {
    if (kind.kRole == bridge) topic = kind.kTopic;
  });
  return topic;
}

/// The topic of positions that people and modems tell.
std::string_view told_positions() {
  return published_by("fix_bridge");
}

struct Entry {
  std::string_view name;
  Topics writes;
  Topics reads;
};

/// One for each role of the table of kinds: it writes all topics that name it.
void add_bridges(std::vector<Entry>& entries) {
  for_each_kind([&](auto kind) {
    const auto known = std::find_if(entries.begin(), entries.end(),
                                    [&](const Entry& entry) { return entry.name == kind.kRole; });
    if (known == entries.end()) {
      entries.push_back({kind.kRole, {kind.kTopic, kLifeSign}, {}});
    } else {
      known->writes.insert(known->writes.end() - 1, kind.kTopic);
    }
  });
}

std::vector<Entry> make_entries() {
  const Topics guidance_writes{"fathom/v1/route", kLifeSign};
  const Topics guidance_reads{"fathom/v1/nav_state", "fathom/v1/alignment", "fathom/v1/monitor_status",
                              "fathom/v1/alarm"};
  std::vector<Entry> entries;
  add_bridges(entries);
  // What the others of its kind say, too: of several fusion services each knows how far it is from the one
  // that leads.
  entries.push_back({"fusion",
                     {"fathom/v1/nav_state", "fathom/v1/nav_detail", "fathom/v1/verdict",
                      "fathom/v1/alignment", "fathom/v1/forecast", "fathom/v1/replica_status",
                      "fathom/v1/engine_state", "fathom/v1/intake", kLifeSign},
                     instruments_and({"fathom/v1/command", "fathom/v1/nav_state", "fathom/v1/verdict",
                                      "fathom/v1/replica_status", "fathom/v1/engine_state"})});
  entries.push_back({"monitor",
                     {"fathom/v1/alarm", "fathom/v1/monitor_status", kLifeSign},
                     instruments_and({"fathom/v1/nav_state", "fathom/v1/alignment", "fathom/v1/verdict",
                                      "fathom/v1/forecast", kLifeSign, "fathom/v1/command"})});
  entries.push_back({"console",
                     {"fathom/v1/command", told_positions(), kLifeSign},
                     {"fathom/v1/nav_state", "fathom/v1/nav_detail", "fathom/v1/verdict",
                      "fathom/v1/alignment", "fathom/v1/monitor_status", "fathom/v1/forecast", kLifeSign,
                      "fathom/v1/alarm", KindOf<GpsSample>::kTopic, KindOf<UsblSample>::kTopic,
                      published_by("range_bridge"), told_positions(), "fathom/v1/route"}});
  entries.push_back({"guidance", guidance_writes, guidance_reads});
  entries.push_back({"guidance_example", guidance_writes, guidance_reads});
  entries.push_back({"discovery", {kLifeSign}, {}});
  // All that was measured, said and ordered, for a black box and for those who look on. The engine's state is
  // for those who may take over.
  const Topics everything =
      instruments_and({"fathom/v1/nav_state", "fathom/v1/nav_detail", "fathom/v1/verdict",
                       "fathom/v1/alignment", "fathom/v1/forecast", "fathom/v1/alarm",
                       "fathom/v1/monitor_status", kLifeSign, "fathom/v1/replica_status", "fathom/v1/command",
                       "fathom/v1/intake", "fathom/v1/route", "fathom/v1/truth"});
  entries.push_back({"recorder", {kLifeSign}, everything});
  entries.push_back({"foxglove", {kLifeSign}, everything});
  // What it takes from ROS 2 are instruments and positions that are told; on a protected network come no
  // orders from there.
  entries.push_back({"ros2_gateway",
                     {KindOf<ImuSample>::kTopic, KindOf<GpsSample>::kTopic, KindOf<DepthSample>::kTopic,
                      KindOf<DvlSample>::kTopic, told_positions(), kLifeSign},
                     {"fathom/v1/nav_state", "fathom/v1/alarm", kLifeSign}});
  entries.push_back({"mavlink_gateway", {kLifeSign}, {"fathom/v1/nav_state"}});
  entries.push_back({"nmea_out", {kLifeSign}, {"fathom/v1/nav_state"}});
  entries.push_back({"simulator", {"fathom/v1/truth", kLifeSign}, {}});
  // status, doctor, and the referee of a demonstration. What status shows and what a run is judged by; who
  // exists at all doctor learns from discovery.
  entries.push_back({"cli",
                     {"fathom/v1/command", told_positions()},
                     {"fathom/v1/nav_state", "fathom/v1/verdict", "fathom/v1/alignment", "fathom/v1/forecast",
                      "fathom/v1/alarm", "fathom/v1/monitor_status", kLifeSign, KindOf<GpsSample>::kTopic,
                      "fathom/v1/truth"}});
  return entries;
}

}  // namespace

std::span<const Role> roles() {
  static const std::vector<Entry> entries = make_entries();
  static const std::vector<Role> roles = [] {
    std::vector<Role> out;
    for (const Entry& entry : entries) out.push_back({entry.name, entry.writes, entry.reads});
    return out;
  }();
  return roles;
}

const Role* find_role(std::string_view name) {
  const std::span<const Role> all = roles();
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const Role& role) { return role.name == name; });
  return found == all.end() ? nullptr : &*found;
}

}  // namespace fathom::security
