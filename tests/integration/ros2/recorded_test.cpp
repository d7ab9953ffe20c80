// Topics of ROS 2 in a recording of the vehicle: of others, and with a type that the recorder does not know.

#include <csignal>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "bus/ros2/wire.hpp"
#include "integration/ros2/peer.hpp"
#include "record/reader.hpp"
#include "ros2/messages/sensors.hpp"
#include "support/paths.hpp"
#include "support/process.hpp"
#include "support/temporary_folder.hpp"

namespace fathom::test {
namespace {

constexpr std::uint32_t kDomain = 74;

class Ros2Recorded : public ::testing::Test {
 protected:
  Result<record::Reader> recorded(std::vector<std::string> more) {
    std::vector<std::string> arguments{"record",
                                       "--domain",
                                       std::to_string(kDomain),
                                       "--profiles",
                                       source_dir() + "/deploy/dds",
                                       "--duration",
                                       "5",
                                       "--out",
                                       file()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    Process recorder("fathom", arguments);
    (void)recorder.wait();
    said = recorder.out() + recorder.err();
    return record::Reader::open(file());
  }
  [[nodiscard]] std::string file() const { return (folder.path() / "f.mcap").string(); }

  TemporaryFolder folder;
  std::string said;
};

TEST_F(Ros2Recorded, AreKeptAsTheyTravelledWhereTheyAreAskedFor) {
  const Peer imu("write", kDomain, {"imu", "rt/imu/data"});
  const Peer dvl("write", kDomain, {"dvl", "rt/dvl"});
  auto reader = recorded({"--foreign", "rt/imu/*"});
  ASSERT_TRUE(reader) << said;
  int count = 0;
  const auto outcome =
      reader.value().read({}, [&](const record::Channel& channel, const record::Message& message) {
        EXPECT_EQ(channel.topic, "rt/imu/data");
        EXPECT_EQ(channel.message_encoding, "cdr");
        const record::Schema* schema = reader.value().schema_of(channel);
        EXPECT_TRUE(schema != nullptr && schema->name == "sensor_msgs::msg::dds_::Imu_");
        std::vector<char> bytes(message.data.begin(), message.data.end());
        ros2::Imu sample;
        EXPECT_TRUE(bus::ros2::decode(bytes, sample));
        EXPECT_EQ(sample.header.frame_id, "imu_link");
        EXPECT_EQ(sample.linear_acceleration.z, 9.81);
        ++count;
        return true;
      });
  EXPECT_TRUE(outcome.problems.empty());
  EXPECT_GT(count, 50) << "of some 200 in five seconds; " << said;
  EXPECT_TRUE(reader.value().check().problems.empty());
  // Who plays such a recording plays what is the vehicle's: nothing.
  Process replay("fathom", {"replay", file(), "--domain", std::to_string(kDomain), "--profiles",
                            source_dir() + "/deploy/dds", "--speed", "10"});
  EXPECT_NE(replay.wait(), SIGABRT + 128) << replay.err();
}

TEST_F(Ros2Recorded, AreLeftOutOtherwise) {
  const Peer imu("write", kDomain, {"imu", "rt/imu/data"});
  const auto reader = recorded({});
  EXPECT_FALSE(reader) << "nothing of the vehicle's was said";
  EXPECT_NE(said.find("nothing came"), std::string::npos) << said;
}

}  // namespace
}  // namespace fathom::test
