// The table of permissions against the services themselves: in a protected demonstration each reads and
// writes all that its row names, so that no row allows more than is used, and none is refused anything.

#include <filesystem>
#include <fstream>
#include <map>
#include <set>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "bus/network_map.hpp"
#include "integration/bus/support.hpp"
#include "security/roles.hpp"
#include "support/paths.hpp"
#include "support/process.hpp"
#include "support/temporary_folder.hpp"

namespace fathom::test {
namespace {

constexpr std::uint32_t kDomain = 61;

// Read by a fusion only while it lacks what another one knows.
constexpr std::string_view kForAMoment = "fathom/v1/engine_state";

/// Topics that each service reads (false) and writes (true).
using Uses = std::map<std::string, std::map<bool, std::set<std::string>>>;

Uses uses(bus::Participant& participant) {
  Uses out;
  for (const bus::NetworkEndpoint& one : bus::endpoints(participant)) {
    // The client library in it is a participant of its own, with the identity of the service.
    std::string owner = one.owner.name == "guidance_example_client" ? "guidance_example" : one.owner.name;
    // Two of a kind have one row.
    if (owner == "fusion_standby") owner = "fusion";
    if (owner == "demo" || (one.topic == kForAMoment && !one.writes)) continue;
    out[owner][one.writes].insert(one.topic);
  }
  return out;
}

Uses table() {
  Uses out;
  for (const security::Role& role : security::roles()) {
    const std::string name(role.name);
    // Not part of a demonstration; a person's own tools read what they are asked to.
    static const std::set<std::string> kElsewhere{"cli",      "guidance",        "discovery", "ros2_gateway",
                                                  "nmea_out", "mavlink_gateway", "foxglove"};
    if (kElsewhere.contains(name)) continue;
    if (name == "console" && !std::filesystem::exists(binary_dir() + "/bin/fathom-console")) continue;
    const auto add = [&](bool writes, std::span<const std::string_view> topics) {
      for (const auto topic : topics) {
        if (writes || topic != kForAMoment) out[name][writes].emplace(topic);
      }
    };
    add(true, role.publishes);
    add(false, role.subscribes);
  }
  return out;
}

nlohmann::json shipped(const std::string& scenario) {
  return nlohmann::json::parse(
      std::ifstream(source_dir() + "/deploy/config/scenarios/" + scenario + ".json"));
}

/// A vehicle with every instrument: the survey's, the pitot tube of the aircraft, an altimeter and a modem.
std::string scenario_of_everything(const std::filesystem::path& folder) {
  nlohmann::json scenario = shipped("survey");
  scenario.erase("$schema");
  scenario["sensors"]["airspeed"] = shipped("flight")["sensors"]["airspeed"];
  scenario["bridges"].push_back("air_data");
  scenario["sensors"]["altimeter"] = {{"enabled", true},
                                      {"protocol", "nmea0183"},
                                      {"link", {{"type", "pty"}, {"path", "altimeter"}}},
                                      {"rate_hz", 5}};
  scenario["bridges"].push_back("altimeter");
  scenario["sensors"]["range"] = {{"enabled", true},
                                  {"protocol", "micromodem"},
                                  {"link", {{"type", "pty"}, {"path", "modem"}}},
                                  {"rate_hz", 1}};
  scenario["bridges"].push_back("range");
  scenario["sensors"]["fix"] = {{"enabled", true},
                                {"protocol", "fix_text"},
                                {"link", {{"type", "udp"}, {"port", 17209}}},
                                {"rate_hz", 0.5}};
  scenario["bridges"].push_back("fix");
  const std::string file = folder / "everything.json";
  std::ofstream(file) << scenario.dump(2);
  return file;
}

TEST(Permissions, AreWhatTheServicesUseAndNoMore) {
  setenv("FATHOM_DDS_DIR", (source_dir() + "/deploy/dds").c_str(), 1);
  setenv("FATHOM_SCENARIO_DIR", (source_dir() + "/deploy/config/scenarios").c_str(), 1);
  const TemporaryFolder folder;
  Process demo("fathom-demo", {"--secure", "--standby", "--domain", std::to_string(kDomain), "--duration",
                               "300", "--scenario", scenario_of_everything(folder.path())});
  const std::string sign = "FATHOM_SECURITY_DIR=";
  ASSERT_TRUE(wait_until([&] { return demo.out().find(sign) != std::string::npos; }, 240.0)) << demo.err();
  const std::string said = demo.out().substr(demo.out().find(sign) + sign.size());

  bus::ParticipantOptions presence = options(kDomain, "observer");
  presence.security = {said.substr(0, said.find(' ')), "cli"};
  {
    bus::Participant observer(presence);
    const Uses expected = table();
    EXPECT_TRUE(wait_until([&] { return uses(observer) == expected; }, 240.0));
    EXPECT_EQ(uses(observer), expected);
    EXPECT_EQ(observer.counters().stranger_refused, 0U);
    EXPECT_EQ(observer.counters().permission_refused, 0U);
  }
  demo.kill(SIGINT);
  (void)demo.wait();
  EXPECT_EQ(demo.out().find("was started again"), std::string::npos) << demo.out();
}

}  // namespace
}  // namespace fathom::test
