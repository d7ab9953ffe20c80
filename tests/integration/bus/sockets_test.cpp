// What a service leaves open on its host: sockets on the configured interfaces only, and no shared memory.

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

#include <unistd.h>

#include "bus/writer.hpp"
#include "samples/nav_state.hpp"
#include "support.hpp"

namespace fathom::test {
namespace {

namespace fs = std::filesystem;

/// Inodes of this process's sockets.
std::set<std::string> own_sockets() {
  std::set<std::string> inodes;
  for (const auto& entry : fs::directory_iterator("/proc/self/fd")) {
    std::error_code gone;
    const std::string target = fs::read_symlink(entry.path(), gone).string();
    if (target.starts_with("socket:[")) inodes.insert(target.substr(8, target.size() - 9));
  }
  return inodes;
}

/// Local "address:port" (hexadecimal, as the kernel prints them) of this process's sockets in a table of
/// /proc/net.
std::vector<std::string> bound(const std::string& table) {
  const std::set<std::string> own = own_sockets();
  std::vector<std::string> addresses;
  std::ifstream file("/proc/self/net/" + table);
  std::string line;
  std::getline(file, line);
  while (std::getline(file, line)) {
    std::istringstream words(line);
    std::vector<std::string> word;
    for (std::string next; words >> next;) word.push_back(next);
    if (word.size() > 9 && own.contains(word[9])) addresses.push_back(word[1]);
  }
  return addresses;
}

std::set<std::string> shared_memory() {
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator("/dev/shm")) {
    const std::string name = entry.path().filename().string();
    if (name.find("fastrtps") != std::string::npos || name.find("fastdds") != std::string::npos)
      names.insert(name);
  }
  return names;
}

TEST(Sockets, AreBoundToTheConfiguredInterfaceOnly) {
  bus::Participant a(options(120, "a"));
  bus::Participant b(options(120, "b"));
  bus::Writer<NavState> writer(a);
  Inbox<NavState> inbox;
  bus::Reader<NavState> reader(b, inbox.handler());
  ASSERT_TRUE(eventually([&] { return writer.matched_readers() == 1 && reader.matched_writers() == 1; }));
  ASSERT_TRUE(writer.write(NavState{}));
  ASSERT_TRUE(eventually([&] { return inbox.size() == 1; }));

  const std::vector<std::string> udp = bound("udp");
  EXPECT_GE(udp.size(), 4U);  // each participant: discovery and samples
  for (const std::string& address : udp) EXPECT_TRUE(address.starts_with("0100007F:")) << address;
  EXPECT_TRUE(bound("udp6").empty());
  EXPECT_TRUE(bound("tcp").empty());
  EXPECT_TRUE(bound("tcp6").empty());
}

TEST(Sockets, OfADiscoveryServerAndItsClientAreNoOthers) {
  const std::string address = "127.0.0.1:21811";
  bus::ParticipantOptions served = options(122, "a");
  served.discovery_servers = {address};
  bus::ParticipantOptions serving = options(122, "discovery");
  serving.discovery_listen = address;
  const bus::Participant server(serving);
  bus::Participant a(served);
  bus::Participant b(served);
  bus::Writer<NavState> writer(a);
  Inbox<NavState> inbox;
  bus::Reader<NavState> reader(b, inbox.handler());
  ASSERT_TRUE(eventually([&] { return writer.matched_readers() == 1; }, milliseconds(60'000)));

  const std::vector<std::string> udp = bound("udp");
  EXPECT_GE(udp.size(), 6U);
  for (const std::string& one : udp) EXPECT_TRUE(one.starts_with("0100007F:")) << one;
  EXPECT_NE(std::find(udp.begin(), udp.end(), "0100007F:5533"), udp.end()) << "the server's port";
  EXPECT_TRUE(bound("udp6").empty());
  EXPECT_TRUE(bound("tcp").empty());
  EXPECT_TRUE(bound("tcp6").empty());
}

TEST(Sockets, NothingIsPutIntoSharedMemory) {
  const std::set<std::string> before = shared_memory();
  bus::Participant a(options(121, "a"));
  bus::Participant b(options(121, "b"));
  bus::Writer<NavState> writer(a);
  Inbox<NavState> inbox;
  bus::Reader<NavState> reader(b, inbox.handler());
  ASSERT_TRUE(eventually([&] { return writer.matched_readers() == 1 && reader.matched_writers() == 1; }));
  ASSERT_TRUE(writer.write(NavState{}));
  ASSERT_TRUE(eventually([&] { return inbox.size() == 1; }));
  for (const std::string& name : shared_memory()) EXPECT_TRUE(before.contains(name)) << name;
}

}  // namespace
}  // namespace fathom::test
