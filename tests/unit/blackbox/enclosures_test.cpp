#include "blackbox/enclosures.hpp"

#include <fstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "blackbox/surroundings.hpp"
#include "support/temporary_folder.hpp"

namespace fathom {
namespace {

using blackbox::CommandLine;

TEST(CommandLine, GivesTheLastValueOfAnOptionAndAllOfThem) {
  const CommandLine line{
      "fathom-fusion", "/", {"--config", "a.json", "--set", "x=1", "--set=y=2", "--config=b.json"}};
  EXPECT_EQ(line.value_of("--config"), "b.json");
  EXPECT_EQ(line.values_of("--set"), (std::vector<std::string>{"x=1", "y=2"}));
  EXPECT_EQ(line.value_of("--other"), std::nullopt);
  const auto back = blackbox::command_line_from(blackbox::to_json(line));
  ASSERT_TRUE(back);
  EXPECT_EQ(back->arguments, line.arguments);
  EXPECT_FALSE(blackbox::command_line_from("{\"arguments\": 3}"));
}

TEST(CommandLine, IsOfServicesOnly) {
  EXPECT_FALSE(blackbox::command_line_of(static_cast<std::uint32_t>(getpid()))) << "this test is none";
  EXPECT_FALSE(blackbox::command_line_of(1));
}

TEST(Enclosures, HoldConfigurationAndCheckpoint) {
  const test::TemporaryFolder folder;
  std::ofstream(folder / "fusion.json") << R"({"checkpoint": {"path": "/nowhere"}})";
  std::ofstream(folder / "state") << "bytes";
  const CommandLine line{
      "fathom-fusion", folder.path().string(), {"--config", "fusion.json", "--set", "checkpoint.path=state"}};
  const auto all = blackbox::enclosures_of("fusion", line, 5);
  ASSERT_EQ(all.size(), 3U);
  EXPECT_EQ(all[0].name, "services/fusion/command.json");
  EXPECT_EQ(all[1].name, "services/fusion/config.json");
  EXPECT_EQ(all[2].name, "services/fusion/checkpoint");
  EXPECT_EQ(all[2].path, folder / "state");
  EXPECT_EQ(blackbox::read_enclosed(all[2].path), (record::Bytes{'b', 'y', 't', 'e', 's'}));
  EXPECT_EQ(blackbox::read_enclosed(folder / "absent"), std::nullopt);
  EXPECT_EQ(blackbox::enclosures_of("fusion", {"x", "/", {"--config", "absent"}}, 5).size(), 1U);
}

TEST(Surroundings, TellVersionAndClockOfAProcess) {
  ServiceStatus status;
  status.header.sensor = "gps_bridge";
  status.host = "nose\xff";  // from the network: no UTF-8
  status.pid = 7;
  status.version = "1.2";
  status.config_hash = "ab";
  status.utc_offset_ns = -kNsPerSecond / 4;
  const auto enclosure = blackbox::process_of(status, 5);
  EXPECT_EQ(enclosure.name, "services/gps_bridge/process.json");
  const auto json = nlohmann::json::parse(enclosure.data.begin(), enclosure.data.end());
  EXPECT_EQ(json.at("pid"), 7);
  EXPECT_EQ(json.at("version"), "1.2");
  EXPECT_EQ(json.at("config_hash"), "ab");
  EXPECT_EQ(json.at("utc_offset_s"), -0.25);
  EXPECT_EQ(json.at("started"), "1970-01-01T00:00:00.000Z");
}

}  // namespace
}  // namespace fathom
