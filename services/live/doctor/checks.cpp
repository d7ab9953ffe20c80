#include "live/doctor/checks.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include "bus/topics.hpp"
#include "cli/listed.hpp"
#include "live/number.hpp"

namespace fathom::cli {
namespace {

constexpr double kClockTolerance_s = 0.5;
constexpr std::uint64_t kLeastShmBytes = 64ULL << 20U;
constexpr std::uint64_t kLeastOpenFiles = 1024;
constexpr std::uint64_t kLeastReceiveBuffer = 200'000;
constexpr std::string_view kOurs = "fathom/";

class Report {
 public:
  explicit Report(std::vector<Finding>& out) : out_(&out) {}
  void subject(std::string_view name) { subject_ = name; }
  void good(std::string text) { out_->push_back({FindingLevel::good, subject_, std::move(text), {}}); }
  void notice(std::string text, std::string remedy) {
    out_->push_back({FindingLevel::notice, subject_, std::move(text), std::move(remedy)});
  }
  void problem(std::string text, std::string remedy) {
    out_->push_back({FindingLevel::problem, subject_, std::move(text), std::move(remedy)});
  }

 private:
  std::vector<Finding>* out_;
  std::string subject_;
};

std::string who(const bus::Peer& peer) {
  std::string out = peer.name;
  if (peer.pid != 0 || !peer.host.empty()) {
    out += " (process " + std::to_string(peer.pid) + " on " + (peer.host.empty() ? "?" : peer.host) + ")";
  }
  return out;
}

void examine_presence(const NetworkFacts& network, const HostFacts& host, Report& report) {
  report.subject("network");
  for (const std::string& address : network.interfaces) {
    const auto found = std::find_if(host.addresses.begin(), host.addresses.end(),
                                    [&](const bus::LocalAddress& one) { return one.address == address; });
    if (found == host.addresses.end()) {
      report.problem("No interface of this host has the address " + address + ".",
                     "Correct bus.interfaces (or --interface); see `ip address`.");
    } else if (!found->has_link) {
      report.problem("Network card " + found->card + " (" + address + ") has no link.",
                     "Plug its cable in, switch on what is at its other end, or bring the interface up; see "
                     "`ip link`.");
    }
  }
  if (network.participants.empty()) {
    report.problem(
        "Nobody is on DDS domain " + std::to_string(network.domain) + ".",
        "Start the services; check that they use this domain (bus.domain), that bus.interfaces name "
        "a network that reaches here, and that bus.peers or bus.discovery_servers name the other machines.");
    return;
  }
  std::set<std::string> hosts;
  for (const bus::Peer& peer : network.participants) hosts.insert(peer.host.empty() ? "?" : peer.host);
  report.good(std::to_string(network.participants.size()) + " participants on domain " +
              std::to_string(network.domain) + ", on " + listed(hosts) + ".");
}

void examine_security(const NetworkFacts& network, Report& report) {
  report.subject("security");
  if (network.is_protected) {
    for (const bus::Stranger& one : network.strangers) {
      report.problem(
          "Somebody is not spoken to: " + to_string(one) + ".",
          "Give it credentials if it is one of yours (fathom keygen --service), else find and remove it.");
    }
    if (network.strangers.empty()) report.good("Everybody who is here has proved an identity.");
    return;
  }
  std::set<std::string> asking;
  for (const bus::Peer& one : network.participants) {
    if (one.offers_identity) asking.insert(who(one));
  }
  if (asking.empty()) {
    report.good("The network asks for no identity: whoever reaches it may read and write.");
  } else if (asking.size() < network.participants.size()) {
    report.problem("Some ask for an identity and others have none: they do not hear each other (" +
                       listed(asking) + " ask).",
                   "Give every service bus.security.folder, or none.");
  } else {
    report.problem("The network asks for an identity, and this command has none: it hears nothing.",
                   "Say --security DIR, the folder that fathom keygen made.");
  }
}

void examine_qos(const NetworkFacts& network, Report& report) {
  report.subject("qos");
  for (const bus::NetworkConflict& one : network.conflicts) {
    report.problem(
        "On " + one.topic + " writer " + who(one.writer) + " and reader " + who(one.reader) +
            " never meet: " + one.policy + " offered " + one.offered + ", requested " + one.requested + ".",
        one.policy == "type"
            ? "Build both from the same idl/."
            : "Load the same deploy/dds/*.xml on both sides; a deadline follows from the configured rate.");
  }
  if (network.conflicts.empty()) report.good("Every reader can meet every writer of its topic.");
}

void examine_topics(const NetworkFacts& network, Report& report) {
  report.subject("topics");
  std::map<std::string, std::string> known;
  for (const bus::TopicInfo& one : bus::all_topics()) known[one.topic] = one.type;
  std::set<std::string> said;
  bool sound = true;
  for (const bus::NetworkEndpoint& one : network.endpoints) {
    if (one.topic.compare(0, kOurs.size(), kOurs) != 0) continue;
    const auto found = known.find(one.topic);
    if (found != known.end() && found->second == one.type) continue;
    if (!said.insert(one.topic + one.owner.name).second) continue;
    sound = false;
    const std::string verb = one.writes ? " writes " : " reads ";
    if (found == known.end()) {
      report.notice(who(one.owner) + verb + one.topic + ", a topic that this version does not know.",
                    "Use one version everywhere, or another prefix than fathom/ for topics of your own.");
    } else {
      report.problem(who(one.owner) + verb + one.topic + " as " + one.type + ", it is " + found->second + ".",
                     "Build it from the idl/ of this version.");
    }
  }
  // What is read and never written stays silent, and nobody notices.
  std::map<std::string, std::set<std::string>> readers;
  std::set<std::string> written;
  for (const bus::NetworkEndpoint& one : network.endpoints) {
    if (one.writes) {
      written.insert(one.topic);
    } else {
      readers[one.topic].insert(one.owner.name);
    }
  }
  if (written.count("fathom/v1/imu") == 0 && readers.count("fathom/v1/imu") != 0) {
    sound = false;
    report.problem("Nobody writes fathom/v1/imu; " + listed(readers["fathom/v1/imu"]) + " wait for it.",
                   "Start fathom-imu-bridge; without inertial samples there is no navigation.");
  }
  if (written.count("fathom/v1/nav_state") == 0 && readers.count("fathom/v1/nav_state") != 0) {
    sound = false;
    report.problem(
        "Nobody writes fathom/v1/nav_state; " + listed(readers["fathom/v1/nav_state"]) + " wait for it.",
        "Start fathom-fusion.");
  }
  if (sound) report.good("Every topic has the type that this version knows.");
}

void examine_writers(const NetworkFacts& network, Report& report) {
  report.subject("writers");
  // Topics that many write by nature.
  const std::set<std::string> shared{"fathom/v1/service_status", "fathom/v1/command", "fathom/v1/route"};
  // Topics of fusion, of which several may stand by for each other; they say so.
  constexpr const char* kReplicas = "fathom/v1/replica_status";
  const std::set<std::string> of_fusion{
      kReplicas,           "fathom/v1/engine_state", "fathom/v1/nav_state", "fathom/v1/nav_detail",
      "fathom/v1/verdict", "fathom/v1/alignment",    "fathom/v1/forecast"};
  std::map<std::string, std::set<std::string>> writers;
  for (const bus::NetworkEndpoint& one : network.endpoints) {
    if (one.writes && one.topic.compare(0, kOurs.size(), kOurs) == 0 && shared.count(one.topic) == 0) {
      writers[one.topic].insert(who(one.owner));
    }
  }
  const std::set<std::string> replicas = writers[kReplicas];
  const auto stand_by = [&](const std::string& topic, const std::set<std::string>& names) {
    return of_fusion.count(topic) != 0 &&
           std::includes(replicas.begin(), replicas.end(), names.begin(), names.end());
  };
  if (replicas.size() > 1) report.good("Stand by for each other: " + listed(replicas) + ".");
  bool single = true;
  for (const auto& [topic, names] : writers) {
    if (names.size() < 2 || stand_by(topic, names)) continue;
    single = false;
    report.notice("Several write " + topic + ": " + listed(names) + ".",
                  "Right for several instruments of a kind under names of their own; else stop the one that "
                  "does not belong.");
  }
  if (single) report.good("No topic of an instrument or of navigation has a second writer.");
}

void examine_services(const NetworkFacts& network, Report& report) {
  report.subject("services");
  std::map<std::string, std::set<std::string>> versions;
  bool well = true;
  for (const HeardService& one : network.services) {
    const std::string name = one.status.header.sensor.str();
    versions[one.status.version].insert(name);
    if (one.voices.several()) {
      well = false;
      report.problem(one.voices.sentence_about(name.c_str()), "End the one that does not belong.");
    }
    if (one.status.state == ServiceState::healthy) continue;
    well = false;
    report.problem("Service " + name + " is " + std::string(to_string(one.status.state)) +
                       (one.status.text.empty() ? "." : ": " + one.status.text + "."),
                   "See its log; `fathom status` shows its sensors.");
  }
  if (versions.size() > 1) {
    well = false;
    std::string text;
    for (const auto& [version, names] : versions) {
      text += (text.empty() ? "" : "; ") + version + ": " + listed(names);
    }
    report.notice("The services are of different versions: " + text + ".", "Install one version everywhere.");
  }
  if (network.services.empty() && !network.participants.empty()) {
    report.notice("No service of this project gave a life sign.", "Listen longer with --seconds.");
  } else if (well && !network.services.empty()) {
    report.good(std::to_string(network.services.size()) + " services, all healthy, version " +
                versions.begin()->first + ".");
  }
}

/// The time in stamps goes on from when the services of a host started (runtime::ClockAnchor), whoever sets
/// the host's clock.
void examine_stamps(const NetworkFacts& network, Report& report) {
  const HeardService* first = nullptr;
  std::set<std::string> said;
  for (const HeardService& one : network.services) {
    const double set_by_s = to_seconds(one.status.utc_offset_ns);
    if (std::abs(set_by_s) >= kClockTolerance_s && said.insert(one.status.host).second) {
      report.notice("The clock of " + one.status.host + " was set " + number("%.1f s ", std::abs(set_by_s)) +
                        (set_by_s > 0.0 ? "forward" : "back") +
                        " after its services had started; the time in their stamps was not.",
                    "Before the next launch stop every service of that host, then start them.");
    }
    if (!known(one.behind_s) || std::abs(one.behind_s) >= kClockTolerance_s) continue;  // said of its clock
    if (first == nullptr) first = &one;
    const double apart_s =
        one.behind_s + set_by_s - first->behind_s - to_seconds(first->status.utc_offset_ns);
    if (std::abs(apart_s) < kClockTolerance_s || !said.insert(one.status.header.sensor.str()).second)
      continue;
    report.problem("The stamps of " + one.status.header.sensor.str() + " (" + one.status.host + ") and " +
                       first->status.header.sensor.str() + " (" + first->status.host + ") are " +
                       number("%.1f s", std::abs(apart_s)) + " apart.",
                   "Stop every service on both hosts, see that their clocks agree, and start them again.");
  }
}

void examine_clock(const NetworkFacts& network, const HostFacts& host, Report& report) {
  report.subject("clock");
  examine_stamps(network, report);
  std::set<std::string> said;
  for (const HeardService& one : network.services) {
    if (!known(one.behind_s) || std::abs(one.behind_s) < kClockTolerance_s) continue;
    if (!said.insert(one.status.host).second) continue;
    report.problem(
        "The clock of " + one.status.host + " (" + one.status.header.sensor.str() + ") is " +
            number("%.1f s ", std::abs(one.behind_s)) + (one.behind_s > 0.0 ? "behind" : "ahead of") +
            " that of this host.",
        "Discipline both by PTP (ptp4l) or NTP (chrony): stamps of one machine are used on another.");
  }
  if (!host.clock_disciplined) {
    report.notice("Whether anything disciplines this host's clock could not be found out.", "");
  } else if (!*host.clock_disciplined) {
    report.notice(
        "Nothing disciplines the clock of this host.",
        "Run chrony or ptp4l with phc2sys where several machines share the vehicle network, or where "
        "device times in UTC are used.");
  } else {
    report.good(
        "The clock of this host is disciplined" +
        (known(host.clock_error_s) ? number(", at most %.3f s off", host.clock_error_s) : std::string()) +
        ".");
  }
}

void examine_memory(const HostFacts& host, Report& report) {
  report.subject("memory");
  if (!host.shm_leftovers.empty()) {
    std::uint64_t bytes = 0;
    for (const ShmLeftover& one : host.shm_leftovers) bytes += one.bytes;
    report.notice(std::to_string(host.shm_leftovers.size()) +
                      " files of Fast DDS in /dev/shm belong to nobody " +
                      number("(%.1f MB).", static_cast<double>(bytes) / 1e6),
                  "`fathom doctor --clean` removes them.");
  }
  if (host.shm_free_bytes && *host.shm_free_bytes < kLeastShmBytes) {
    report.problem(
        number("Only %.1f MB are free in /dev/shm.", static_cast<double>(*host.shm_free_bytes) / 1e6),
        "Make room there, or make it larger: mount -o remount,size=256M /dev/shm.");
  } else if (host.shm_leftovers.empty()) {
    report.good("Shared memory holds nothing that belongs to nobody.");
  }
}

void examine_limits(const HostFacts& host, Report& report) {
  report.subject("limits");
  bool well = true;
  if (host.open_files && *host.open_files < kLeastOpenFiles) {
    well = false;
    report.problem("A process may open only " + std::to_string(*host.open_files) + " files.",
                   "Raise it to 1024 or more: ulimit -n, or LimitNOFILE= of the unit.");
  }
  if (host.receive_buffer_bytes && *host.receive_buffer_bytes < kLeastReceiveBuffer) {
    well = false;
    report.notice(
        "A socket's receive buffer is at most " + std::to_string(*host.receive_buffer_bytes) + " bytes.",
        "sysctl net.core.rmem_max=1048576 keeps bursts of samples from being dropped.");
  }
  if (host.realtime_priority && *host.realtime_priority == 0) {
    well = false;
    report.notice("This user may not ask for real-time scheduling.",
                  "Only needed where a configuration says \"realtime\"; deploy/systemd/realtime.conf.example "
                  "grants it to a service.");
  }
  if (well) report.good("Limits of files, buffers and scheduling suffice.");
}

}  // namespace

std::string_view to_string(FindingLevel level) {
  constexpr std::array<std::string_view, 3> kWords{"good", "notice", "problem"};
  return kWords.at(static_cast<std::size_t>(level));
}

std::vector<Finding> examine(const NetworkFacts& network, const HostFacts& host) {
  std::vector<Finding> out;
  Report report(out);
  examine_presence(network, host, report);
  if (!network.participants.empty() || !network.strangers.empty()) examine_security(network, report);
  if (!network.participants.empty()) {
    examine_qos(network, report);
    examine_topics(network, report);
    examine_writers(network, report);
    examine_services(network, report);
  }
  examine_clock(network, host, report);
  examine_memory(host, report);
  examine_limits(host, report);
  return out;
}

}  // namespace fathom::cli
