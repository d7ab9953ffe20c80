// A service whose network card has no link yet: Fast DDS would leave the card out for good.

#include <filesystem>
#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/paths.hpp"
#include "support/process.hpp"
#include "support/temporary_folder.hpp"

namespace fathom::test {
namespace {

using ::testing::HasSubstr;

/// A network of its own, in which card `near` has the address 10.9.9.1, and a link as soon as `plugged`
/// exists: then what is at its other end is switched on.
constexpr const char* kNetwork = R"(
ip link set lo up
ip link add near type veth peer name far
ip address add 10.9.9.1/24 dev near
ip link set near up
plugged=$1
shift
timeout --kill-after=5 60 "$@" &
while kill -0 $! 2>/dev/null; do
  [ -e "$plugged" ] && ip link set far up
  sleep 0.1
done
wait $!
)";

class Link : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists("/usr/sbin/ip") && !std::filesystem::exists("/sbin/ip"))
      GTEST_SKIP() << "iproute2 is not installed";
    Process may("/usr/bin/unshare",
                {"--map-root-user", "--net", "/bin/bash", "-c", "ip link add near type veth peer name far"});
    if (may.wait() != 0) GTEST_SKIP() << "may not make a network of its own: " << may.err();
  }
  [[nodiscard]] std::vector<std::string> service(const std::string& interfaces) const {
    return {"--map-root-user", "--net",
            "/bin/bash",       "-c",
            kNetwork,          "network",
            plugged,           binary_dir() + "/bin/fathom-guidance-example",
            "--config",        source_dir() + "/deploy/config/guidance_example.json",
            "--set",           "bus.interfaces=" + interfaces,
            "--set",           "bus.profiles_dir=" + source_dir() + "/deploy/dds"};
  }

  const TemporaryFolder folder;
  const std::string plugged = (folder.path() / "plugged").string();
};

TEST_F(Link, AServiceWithoutAnyEndsInWords) {
  Process waiting("/usr/bin/unshare", service(R"(["10.9.9.1"])"));
  EXPECT_EQ(waiting.wait(), 4) << waiting.err();
  EXPECT_THAT(waiting.err(), HasSubstr("interface '10.9.9.1': its network card near has no link"));
}

TEST_F(Link, AServiceThatHasAnotherStartsWithItAndEndsWhenTheCableIsIn) {
  Process service("/usr/bin/unshare", this->service(R"(["127.0.0.1","10.9.9.1"])"));
  ASSERT_TRUE(wait_until(
      [&] { return service.err().find("network card near (10.9.9.1) has no link") != std::string::npos; },
      30.0))
      << service.err();
  std::ofstream(plugged) << "1";
  EXPECT_EQ(service.wait(), 4) << service.err();
  EXPECT_THAT(service.err(), HasSubstr("network card near (10.9.9.1) has a link now"));
}

}  // namespace
}  // namespace fathom::test
