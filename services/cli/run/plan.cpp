#include "cli/run/plan.hpp"

#include <algorithm>
#include <array>
#include <set>
#include <string_view>
#include <utility>

#include <nlohmann/json.hpp>

#include "base/nearest.hpp"
#include "cli/command.hpp"
#include "cli/listed.hpp"
#include "config/console_config.hpp"
#include "config/json/layers.hpp"
#include "config/service_config.hpp"
#include "config/vehicle/catalogue.hpp"
#include "config/vehicle/vehicle_config.hpp"
#include "launch/executable.hpp"
#include "samples/kinds.hpp"

namespace fathom::cli {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using Words = std::vector<std::string>;

bool is_among(const Words& words, const std::string& word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

[[noreturn]] void refuse(const std::string& what, const Words& known) {
  throw Failure(ExitCode::bad_configuration, "run: " + what + "; there are " + listed(known));
}

/// One service by its own name, and of which kind it is.
struct Member {
  std::string name, service;
};

/// Who listens before who speaks: a lower rank starts first.
int rank_of(const std::string& service, const std::set<std::string>& bridges) {
  if (bridges.contains(service)) return 6;
  if (service == "discovery") return 0;
  if (service == "fusion") return 1;
  if (service == "monitor") return 2;
  if (service == "recorder") return 3;
  return service == "console" ? 5 : 4;
}

std::vector<Member> members_of(const config::VehicleConfig& vehicle, const RunRequest& request) {
  std::set<std::string> bridges;
  for (const config::VehicleInstrument& one : vehicle.instruments) {
    if (one.enabled) bridges.emplace(one.role());
  }
  const Words known = config::all_services();
  std::set<std::string> services = bridges;
  services.insert({"fusion", "monitor"});
  for (const auto& [service, keys] : vehicle.services) services.insert(service);
  for (const std::string& service : vehicle.roles.expected) {
    if (is_among(known, service)) services.insert(service);
  }
  if (!request.record.empty()) services.insert("recorder");
  // A bridge without an instrument has nothing to read.
  for (const std::string_view role : bridge_roles()) {
    if (!bridges.contains(std::string(role))) services.erase(std::string(role));
  }
  services.erase("simulator");
  // Some builds have no console.
  if (fs::exists(request.executables / launch::executable_of("console"))) services.insert("console");

  Words in_order(services.begin(), services.end());
  std::stable_sort(in_order.begin(), in_order.end(), [&](const std::string& a, const std::string& b) {
    return rank_of(a, bridges) < rank_of(b, bridges);
  });
  std::vector<Member> out;
  for (const std::string& service : in_order) {
    if (service != "fusion") {
      out.push_back({service, service});
      continue;
    }
    for (const config::FusionRole& role : vehicle.roles.fusion) out.push_back({role.name.str(), service});
  }
  return out;
}

/// Takes out what is not wanted. A name goes before a kind: of two fusions one may be called fusion.
void leave_out(std::vector<Member>& members, const Words& without) {
  Words known = config::all_services();
  const std::vector<Member> all = members;
  Words names;
  for (const Member& one : all) names.push_back(one.name);
  known.insert(known.end(), names.begin(), names.end());
  for (const std::string& word : without) {
    const bool is_name = is_among(names, word);
    if (!is_name && !is_among(known, word)) {
      const auto meant = nearest(word, known);
      refuse("--without " + word + ": no such service" + (meant ? ", the nearest is " + *meant : ""), names);
    }
    std::erase_if(members,
                  [&](const Member& one) { return is_name ? one.name == word : one.service == word; });
  }
}

/// Sections that every service has.
constexpr std::array<std::string_view, 5> kCommon{"vehicle", "bus", "log", "clock", "realtime"};

/// The overrides of the command line that are this service's.
Words sets_of(const Member& member, const Words& sets) {
  Words out;
  for (const std::string& set : sets) {
    const std::string first = set.substr(0, set.find_first_of(".="));
    if (std::find(kCommon.begin(), kCommon.end(), first) != kCommon.end())
      out.push_back(set);
    else if (first == member.name || first == member.service)
      out.push_back(set.substr(first.size() + 1));
  }
  return out;
}

/// An override that reaches nobody is a mistake.
void refuse_lost_sets(const std::vector<Member>& members, const Words& sets) {
  Words known(kCommon.begin(), kCommon.end());
  for (const Member& one : members) {
    for (const std::string& word : {one.name, one.service}) {
      if (!is_among(known, word)) known.push_back(word);
    }
  }
  for (const std::string& set : sets) {
    const auto end = set.find_first_of(".=");
    const std::string first = set.substr(0, end);
    const bool common = std::find(kCommon.begin(), kCommon.end(), first) != kCommon.end();
    if (end == std::string::npos || !is_among(known, first) || (!common && set[end] != '.'))
      refuse("--set " + set + ": expected a section of every service or a service, then the key", known);
  }
}

/// Where this service writes, and as whom it speaks, where neither the vehicle nor the command line says it.
Words own_places(const Member& member, const RunRequest& request, const Words& sets) {
  const config::Layers said =
      config::layers_of(config::with_vehicle({"", sets}, request.vehicle, member.service));
  Words out;
  const auto place = [&](const std::string& key, const std::string& file) {
    if (said.origin_of(key).layer == config::Layer::standard)
      out.push_back(key + "=" + (request.folder / file).string());
  };
  place("clock.anchor_file", "clock");
  if (member.service == "fusion") place("checkpoint.path", member.name + ".checkpoint");
  if (member.service == "monitor") place("journal.path", "alarms.jsonl");
  if (member.service == "recorder") place("folder", "recordings");
  // Credentials are of a kind of service.
  const json bus = said.value().value("bus", json::object());
  const json security = bus.value("security", json::object());
  if (member.name != member.service && !security.value("folder", "").empty() &&
      security.value("identity", "").empty())
    out.push_back("bus.security.identity=" + member.service);
  return out;
}

/// What a bus section says, or nothing.
json said_of_bus(const RunPlan& plan) {
  if (plan.services.empty()) return json::object();
  return config::layers_of(plan.services.front().configuration).value().value("bus", json::object());
}

}  // namespace

RunPlan plan_run(const RunRequest& request) {
  const config::VehicleConfig vehicle = config::load_vehicle(request.vehicle);
  std::vector<Member> members = members_of(vehicle, request);
  refuse_lost_sets(members, request.sets);
  leave_out(members, request.without);
  if (members.empty()) throw Failure(ExitCode::bad_configuration, "run: --without leaves no service to run");
  RunPlan out{vehicle.name, {}};
  for (const Member& member : members) {
    Words sets = sets_of(member, request.sets);
    if (member.service == "fusion") sets.insert(sets.begin(), "instance=" + member.name);
    if (member.service == "recorder" && !request.record.empty())
      sets.push_back("folder=" + fs::absolute(request.record).string());
    RunService one{member.service,
                   {member.name, request.executables / launch::executable_of(member.service), {}, false},
                   {}};
    try {
      const Words own = own_places(member, request, sets);
      sets.insert(sets.end(), own.begin(), own.end());
      one.configuration = config::with_vehicle({"", sets}, request.vehicle, member.service);
    } catch (const std::exception&) {
      // The service says it itself when it is asked, with all others that have something to say.
    }
    one.program.arguments = {"--vehicle", request.vehicle};
    for (const std::string& set : sets) {
      one.program.arguments.emplace_back("--set");
      one.program.arguments.push_back(set);
    }
    out.services.push_back(std::move(one));
  }
  return out;
}

std::string console_address(const RunPlan& plan) {
  for (const RunService& one : plan.services) {
    if (one.service != "console") continue;
    const auto console = config::load_service_config<config::ConsoleConfig>(one.configuration).value;
    const std::string address = console.http.address == "0.0.0.0" ? "127.0.0.1" : console.http.address;
    return (console.tls.certificate_file.empty() ? "http://" : "https://") + address + ":" +
           std::to_string(console.port()) + "/";
  }
  return {};
}

std::string status_command(const RunPlan& plan) {
  const json bus = said_of_bus(plan);
  std::string out = "fathom status";
  if (const int domain = bus.value("domain", 0); domain != 0) out += " --domain " + std::to_string(domain);
  const auto list = [&](const char* key, const std::string& option, const Words& standard) {
    const Words words = bus.value(key, standard);
    if (words == standard) return;
    out += " " + option;
    for (const std::string& word : words) out += " " + word;
  };
  list("interfaces", "--interface", {"127.0.0.1"});
  list("peers", "--peer", {"127.0.0.1"});
  list("discovery_servers", "--discovery-server", {});
  const std::string folder = bus.value("security", json::object()).value("folder", "");
  if (!folder.empty()) out += " --security " + folder;
  return out;
}

}  // namespace fathom::cli
