#include "blackbox/enclosures.hpp"

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

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

TEST(Enclosures, HoldTheVehiclesFileAndTheModelsThatItNames) {
  const test::TemporaryFolder folder;
  const std::filesystem::path root(folder.path());
  std::filesystem::create_directories(root / "etc" / "catalogue");
  std::filesystem::create_directories(root / "shipped");
  std::ofstream(root / "etc" / "vehicle.json")
      << R"({"instruments": [{"model": "a"}, {"model": "b"}, {"model": "a"}, {"model": "../secret"}, {"model": 3}, 4],
             "services": {"fusion": {"engine": {"vehicle_model": {"coefficients_file": "hull.json"}}}}})";
  std::ofstream(root / "etc" / "hull.json") << "{}";
  std::ofstream(root / "etc" / "catalogue" / "a.json") << "own";
  std::ofstream(root / "shipped" / "a.json") << "shipped";
  std::ofstream(root / "shipped" / "b.json") << "shipped";
  std::ofstream(root / "secret.json") << "{}";
  const CommandLine line{"/usr/bin/fathom-fusion", root.string(), {"--folder", "etc"}};
  const auto all = blackbox::enclosures_of("fusion", line, 5, (root / "shipped").string());
  std::vector<std::string> names;
  for (const auto& one : all) names.push_back(one.name);
  EXPECT_EQ(names,
            (std::vector<std::string>{"services/fusion/command.json", "services/fusion/vehicle.json",
                                      "services/fusion/catalogue/a.json", "services/fusion/catalogue/b.json",
                                      "services/fusion/files/hull.json", "services/fusion/checkpoint"}));
  EXPECT_EQ(record::text_of(all.at(2).data), "own") << "beside the vehicle's file";
  EXPECT_EQ(all.back().path, "/run/fathom/fusion.checkpoint");
  std::ofstream(root / "etc" / "fusion.json") << R"({"checkpoint": {"path": "/x"}})";
  EXPECT_EQ(blackbox::enclosures_of("fusion", line, 5).at(1).name, "services/fusion/config.json");
  EXPECT_EQ(blackbox::enclosures_of("fusion", line, 5).back().path, "/x");
  for (const char* name : {"vehicle.json", "catalogue/a.json", "files/hull.json"})
    EXPECT_TRUE(blackbox::is_referred(name)) << name;
  for (const char* name :
       {"config.json", "catalogue/../../a", "files/../a", "files//etc/passwd", "checkpoint"})
    EXPECT_FALSE(blackbox::is_referred(name)) << name;
  EXPECT_EQ(blackbox::referred_path("catalogue/a.json"), "catalogue/a.json");
  EXPECT_EQ(blackbox::referred_path("files/hull.json"), "hull.json");
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
