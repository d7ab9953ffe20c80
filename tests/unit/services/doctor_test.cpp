#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>
#include <unistd.h>

#include "live/doctor/checks.hpp"
#include "live/doctor/host.hpp"

namespace fathom::cli {
namespace {

namespace fs = std::filesystem;

HostFacts sound_host() {
  HostFacts out;
  out.name = "auv1";
  out.addresses = {{"127.0.0.1", "lo", true}, {"192.168.2.10", "eth0", false}};
  out.clock_disciplined = true;
  out.clock_error_s = 0.002;
  out.shm_free_bytes = 1'000'000'000;
  out.open_files = 1024;
  out.receive_buffer_bytes = 212'992;
  out.realtime_priority = 10;
  return out;
}

bus::NetworkEndpoint endpoint(const char* owner, const char* topic, const char* type, bool writes) {
  return {{owner, "auv1", 7}, topic, type, writes};
}

HeardService service(const char* name, ServiceState state = ServiceState::healthy, double behind_s = 0.01) {
  HeardService out;
  out.status.header.sensor = name;
  out.status.state = state;
  out.status.version = "0.1.0";
  out.status.host = "auv1";
  out.behind_s = behind_s;
  return out;
}

NetworkFacts sound_network() {
  NetworkFacts out;
  out.interfaces = {"127.0.0.1"};
  out.participants = {{"imu_bridge", "auv1", 7}, {"fusion", "auv1", 8}};
  out.endpoints = {endpoint("imu_bridge", "fathom/v1/imu", "fathom::v1::ImuSample", true),
                   endpoint("fusion", "fathom/v1/imu", "fathom::v1::ImuSample", false),
                   endpoint("fusion", "fathom/v1/nav_state", "fathom::v1::NavState", true)};
  out.services = {service("imu_bridge"), service("fusion")};
  return out;
}

/// Findings worse than good.
std::vector<Finding> bad(const NetworkFacts& network, const HostFacts& host) {
  std::vector<Finding> out;
  for (const Finding& one : examine(network, host)) {
    if (one.level != FindingLevel::good) out.push_back(one);
  }
  return out;
}

/// The only finding that is worse than good.
Finding only(const NetworkFacts& network, const HostFacts& host = sound_host()) {
  const auto found = bad(network, host);
  EXPECT_EQ(found.size(), 1U);
  return found.empty() ? Finding{} : found.front();
}

TEST(Doctor, FindsNothingWhereNothingIsWrong) {
  const auto findings = examine(sound_network(), sound_host());
  EXPECT_EQ(findings.size(), 9U) << "one for each subject";
  for (const Finding& one : findings) EXPECT_EQ(one.level, FindingLevel::good) << one.text;
}

TEST(Doctor, NamesThePairAndThePolicyThatKeepsItApart) {
  NetworkFacts network = sound_network();
  network.conflicts = {
      {"fathom/v1/nav_state", "deadline", {"fusion", "auv1", 8}, "30 ms", {"guidance", "gcs", 9}, "20 ms"}};
  const Finding found = only(network);
  EXPECT_EQ(found.level, FindingLevel::problem);
  EXPECT_EQ(
      found.text,
      "On fathom/v1/nav_state writer fusion (process 8 on auv1) and reader guidance (process 9 on gcs) never "
      "meet: deadline offered 30 ms, requested 20 ms.");
  EXPECT_FALSE(found.remedy.empty());
}

TEST(Doctor, AnEmptyNetworkIsAProblem) {
  NetworkFacts network;
  network.domain = 3;
  network.interfaces = {"127.0.0.1"};
  EXPECT_EQ(only(network).text, "Nobody is on DDS domain 3.");
}

TEST(Doctor, AStrangerOnAProtectedNetworkIsNamed) {
  NetworkFacts network = sound_network();
  network.is_protected = true;
  EXPECT_TRUE(bad(network, sound_host()).empty());
  network.strangers = {{"evil", "010f", "10.0.0.9", "offers no identity"}};
  EXPECT_EQ(only(network).text,
            "Somebody is not spoken to: 'evil' (GUID 010f, says it is at 10.0.0.9) offers no identity.");
  EXPECT_EQ(only(network).subject, "security");
}

TEST(Doctor, WhoAsksForAnIdentityIsNotHeardWithoutOne) {
  NetworkFacts network = sound_network();
  for (bus::Peer& one : network.participants) one.offers_identity = true;
  EXPECT_EQ(only(network).text,
            "The network asks for an identity, and this command has none: it hears nothing.");
  network.participants[0].offers_identity = false;
  EXPECT_EQ(only(network).text,
            "Some ask for an identity and others have none: they do not hear each other (fusion (process 8 "
            "on auv1) "
            "ask).");
}

TEST(Doctor, AnInterfaceThatThisHostDoesNotHave) {
  NetworkFacts network = sound_network();
  network.interfaces = {"10.0.0.1"};
  EXPECT_EQ(only(network).text, "No interface of this host has the address 10.0.0.1.");
  network.interfaces = {"127.0.0.1", "192.168.2.10"};
  EXPECT_EQ(only(network).text, "Network card eth0 (192.168.2.10) has no link.");
}

TEST(Doctor, TopicsOfAnotherTypeOrVersion) {
  NetworkFacts network = sound_network();
  network.endpoints.push_back(endpoint("old_box", "fathom/v1/gps", "fathom::v0::Gps", true));
  EXPECT_EQ(
      only(network).text,
      "old_box (process 7 on auv1) writes fathom/v1/gps as fathom::v0::Gps, it is fathom::v1::GpsSample.");
  network = sound_network();
  network.endpoints.push_back(endpoint("new_box", "fathom/v2/gps", "fathom::v2::Gps", false));
  EXPECT_EQ(only(network).level, FindingLevel::notice);
  network = sound_network();
  network.endpoints.push_back(endpoint("camera", "ship/video", "Frame", true));
  EXPECT_TRUE(bad(network, sound_host()).empty()) << "what others do on the domain is theirs";
}

TEST(Doctor, ASecondWriterIsNamed) {
  NetworkFacts network = sound_network();
  network.endpoints.push_back(endpoint("rogue", "fathom/v1/imu", "fathom::v1::ImuSample", true));
  const Finding found = only(network);
  EXPECT_EQ(found.level, FindingLevel::notice);
  EXPECT_NE(found.text.find("imu_bridge (process 7 on auv1), rogue (process 7 on auv1)"), std::string::npos)
      << found.text;
}

TEST(Doctor, FusionServicesThatStandByForEachOtherAreNoSecondWriters) {
  NetworkFacts network = sound_network();
  for (const char* instance : {"fusion", "fusion_b"}) {
    for (const auto& [topic, type] : {std::pair{"fathom/v1/replica_status", "fathom::v1::ReplicaStatus"},
                                      std::pair{"fathom/v1/verdict", "fathom::v1::Verdict"}}) {
      network.endpoints.push_back(endpoint(instance, topic, type, true));
    }
  }
  EXPECT_TRUE(bad(network, sound_host()).empty());
  network.endpoints.push_back(endpoint("rogue", "fathom/v1/verdict", "fathom::v1::Verdict", true));
  EXPECT_NE(only(network).text.find("rogue"), std::string::npos);
}

TEST(Doctor, NobodyWritesWhatFusionWaitsFor) {
  NetworkFacts network = sound_network();
  network.endpoints.erase(network.endpoints.begin());
  EXPECT_EQ(only(network).text, "Nobody writes fathom/v1/imu; fusion wait for it.");
}

TEST(Doctor, ServicesThatAreUnwellOrOfAnotherVersion) {
  NetworkFacts network = sound_network();
  network.services[1] = service("fusion", ServiceState::degraded);
  network.services[1].status.text = "alignment lost";
  EXPECT_EQ(only(network).text, "Service fusion is degraded: alignment lost.");
  network = sound_network();
  network.services[0].status.version = "0.2.0";
  EXPECT_EQ(only(network).text, "The services are of different versions: 0.1.0: fusion; 0.2.0: imu_bridge.");
}

TEST(Doctor, ServicesThatRunTwiceAreNamedAndARestartIsNone) {
  NetworkFacts network = sound_network();
  HeardService& fusion = network.services[1];
  const auto hear = [&fusion](std::uint32_t pid, int second) {
    fusion.status.pid = pid;
    (void)fusion.voices.hear(fusion.status, second * kNsPerSecond);
  };
  hear(100, 0);
  hear(200, 1);
  hear(100, 1);  // on its way while its successor spoke
  hear(200, 2);
  EXPECT_TRUE(bad(network, sound_host()).empty());
  hear(100, 2);
  EXPECT_EQ(only(network).level, FindingLevel::problem);
  EXPECT_EQ(only(network).text,
            "Several processes call themselves fusion: process 100 on host auv1 and process 200 on host "
            "auv1.");
}

TEST(Doctor, AClockThatWasSetMovesNoStamps) {
  NetworkFacts network = sound_network();
  for (HeardService& one : network.services) one.status.utc_offset_ns = 3600 * kNsPerSecond;
  const auto found = bad(network, sound_host());
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].level, FindingLevel::notice);
  EXPECT_NE(found[0].text.find("auv1 was set 3600.0 s forward"), std::string::npos) << found[0].text;
}

TEST(Doctor, StampsOfServicesThatStartedUnderDifferentClocks) {
  NetworkFacts network = sound_network();
  network.services[0].status.utc_offset_ns =
      -30 * kNsPerSecond;  // the other one started after the clock was set
  const auto found = bad(network, sound_host());
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[1].level, FindingLevel::problem);
  EXPECT_NE(found[1].text.find("fusion (auv1) and imu_bridge (auv1) are 30.0 s apart"), std::string::npos)
      << found[1].text;
}

TEST(Doctor, ClocksThatDisagree) {
  NetworkFacts network = sound_network();
  network.services[0] = service("imu_bridge", ServiceState::healthy, -3600.2);
  EXPECT_EQ(only(network).text, "The clock of auv1 (imu_bridge) is 3600.2 s ahead of that of this host.");
  HostFacts host = sound_host();
  host.clock_disciplined = false;
  EXPECT_EQ(only(sound_network(), host).text, "Nothing disciplines the clock of this host.");
}

TEST(Doctor, MemoryAndLimits) {
  HostFacts host = sound_host();
  host.shm_leftovers = {{"/dev/shm/fastrtps_1", 1'000'000}, {"/dev/shm/fastrtps_2", 500'000}};
  EXPECT_EQ(only(sound_network(), host).text, "2 files of Fast DDS in /dev/shm belong to nobody (1.5 MB).");
  host = sound_host();
  host.shm_free_bytes = 1'000'000;
  EXPECT_EQ(only(sound_network(), host).level, FindingLevel::problem);
  host = sound_host();
  host.open_files = 256;
  EXPECT_EQ(only(sound_network(), host).text, "A process may open only 256 files.");
  host = sound_host();
  host.receive_buffer_bytes = 65'536;
  EXPECT_EQ(only(sound_network(), host).level, FindingLevel::notice);
}

TEST(DoctorHost, LeftoversAreWhatNobodyHasOpen) {
  std::string pattern = (fs::temp_directory_path() / "fathom-doctor-XXXXXX").string();
  const fs::path folder = mkdtemp(pattern.data());
  for (const char* name : {"fastrtps_dead", "fastrtps_open", "fastrtps_young", "other"}) {
    std::ofstream(folder / name) << "0123456789";
    if (std::string_view(name) != "fastrtps_young") {
      fs::last_write_time(folder / name, fs::file_time_type::clock::now() - std::chrono::hours(1));
    }
  }
  const std::ifstream held(folder / "fastrtps_open");
  // Whatever else runs on this machine: this process is the only one.
  const fs::path processes = folder / "processes";
  fs::create_directory(processes);
  fs::create_directory_symlink("/proc/self", processes / std::to_string(getpid()));
  const auto found = find_leftovers(folder, processes);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].path, (folder / "fastrtps_dead").string());
  EXPECT_EQ(found[0].bytes, 10U);
  EXPECT_TRUE(remove_leftovers(found).empty());
  EXPECT_FALSE(fs::exists(folder / "fastrtps_dead"));
  EXPECT_TRUE(fs::exists(folder / "fastrtps_open"));
  EXPECT_EQ(remove_leftovers(found).size(), 1U) << "it is gone";
  fs::remove_all(folder);
}

TEST(DoctorHost, KnowsItsOwnLoopback) {
  const HostFacts host = look_at_host();
  const auto loopback = std::find_if(host.addresses.begin(), host.addresses.end(),
                                     [](const bus::LocalAddress& one) { return one.address == "127.0.0.1"; });
  ASSERT_NE(loopback, host.addresses.end()) << "a machine without an interface has no vehicle network";
  EXPECT_TRUE(loopback->has_link);
  EXPECT_TRUE(host.open_files);
}

}  // namespace
}  // namespace fathom::cli
