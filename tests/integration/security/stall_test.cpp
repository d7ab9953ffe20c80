// A service that stood still for longer than others wait cannot prove its identity to them again: it ends, so
// that its supervisor starts it anew.

#include <algorithm>
#include <csignal>

#include "network.hpp"
#include "support/paths.hpp"
#include "support/process.hpp"

namespace fathom::test {
namespace {

TEST(Stall, AServiceThatWasGivenUpEndsAndIsMetAgainWhenStartedAnew) {
  SecureNetwork network(60);
  setenv("FATHOM_DDS_DIR", (source_dir() + "/deploy/dds").c_str(), 1);
  const std::vector<std::string> arguments{"--config", source_dir() + "/deploy/config/gps_bridge.json",
                                           "--set",    "bus.domain=60",
                                           "--set",    "bus.security.folder=" + network.credentials()};
  const auto met = [&] {
    const auto peers = network.guidance->peers();
    return std::any_of(peers.begin(), peers.end(),
                       [](const bus::Peer& peer) { return peer.name == "gps_bridge"; });
  };
  Process bridge("fathom-gps-bridge", arguments);
  ASSERT_TRUE(eventually(met, kPatience)) << bridge.err();
  bridge.kill(SIGSTOP);
  ASSERT_TRUE(eventually([&] { return !met(); }, 2 * kPatience));
  bridge.kill(SIGCONT);
  ASSERT_TRUE(eventually([&] { return !bridge.running(); }, kPatience)) << bridge.err();
  EXPECT_EQ(bridge.wait(), 4) << bridge.err();
  EXPECT_NE(bridge.err().find("the others have given this service up"), std::string::npos) << bridge.err();
  Process again("fathom-gps-bridge", arguments);
  EXPECT_TRUE(eventually(met, kPatience)) << again.err();
  EXPECT_TRUE(network.goes_on());
}

}  // namespace
}  // namespace fathom::test
