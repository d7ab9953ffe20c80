// fathom keygen as people run it, and services with what it made.

#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/stat.h>

#include "support/paths.hpp"
#include "support/process.hpp"
#include "support/temporary_folder.hpp"

namespace fathom::test {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

struct Answer {
  int code = 0;
  std::string out;
  std::string err;
};

Answer run(const std::string& program, const std::vector<std::string>& arguments) {
  setenv("FATHOM_DDS_DIR", (source_dir() + "/deploy/dds").c_str(), 1);
  Process process(program, arguments);
  Answer answer;
  answer.code = process.wait();
  answer.out = process.out();
  answer.err = process.err();
  return answer;
}

Answer keygen(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "keygen");
  return run("fathom", arguments);
}

/// One line, as every error of a command is.
void expect_refusal(const Answer& answer, const std::string& about) {
  EXPECT_EQ(answer.code, 2) << answer.err;
  EXPECT_THAT(answer.err, HasSubstr(about));
  EXPECT_EQ(std::count(answer.err.begin(), answer.err.end(), '\n'), 1) << answer.err;
}

TEST(KeygenCommand, MakesChecksAndRenews) {
  const TemporaryFolder folder;
  const std::string dir = folder / "credentials";
  EXPECT_EQ(keygen({dir, "--vehicle", "auv7", "--domains", "3", "5"}).code, 0);
  const Answer good = keygen({"--check", dir});
  EXPECT_EQ(good.code, 0) << good.out;
  EXPECT_THAT(good.out, StartsWith("vehicle auv7, domains 3 to 5\n"));

  expect_refusal(keygen({dir}), "identity_ca.pem: exists, expected a new folder");
  expect_refusal(keygen({dir, "--service", "nobody"}),
                 "service 'nobody': nobody has this name, expected one of");

  EXPECT_EQ(keygen({dir, "--service", "fusion", "--days", "20"}).code, 0);
  const Answer ending = keygen({"--check", dir, "--json"});
  EXPECT_EQ(ending.code, 1);
  const auto json = nlohmann::json::parse(ending.out);
  EXPECT_FALSE(json["good"]);
  for (const auto& item : json["items"]) {
    EXPECT_TRUE(item["usable"]);
    EXPECT_EQ(item["fault"] != "", item["name"] == "fusion") << item;
  }
  EXPECT_EQ(keygen({dir, "--rotate"}).code, 0);
  EXPECT_EQ(keygen({"--check", dir}).code, 0);
  EXPECT_EQ(keygen({dir, "--force"}).code, 0);
  EXPECT_THAT(keygen({"--check", dir}).out, StartsWith("vehicle auv, domains 0 to 230\n"));
}

TEST(KeygenCommand, RefusesWhatMakesNoSense) {
  const TemporaryFolder folder;
  const std::string dir = folder / "credentials";
  expect_refusal(keygen({dir, "--domains", "7", "3"}), "--domains");
  expect_refusal(keygen({dir, "--vehicle", "a/b"}), "vehicle 'a/b'");
  expect_refusal(keygen({dir, "--days", "400", "--ca-days", "300"}), "days 400: expected at most the 300");
  expect_refusal(keygen({dir, "--rotate", "--service", "fusion"}), "excludes");
  expect_refusal(keygen({"--check", dir}), "is no folder");
  expect_refusal(keygen({}), "required");
}

TEST(KeygenCommand, AServiceSaysWhatIsWrongWithItsCredentials) {
  const TemporaryFolder folder;
  const std::string dir = folder / "credentials";
  const auto bridge = [&](const std::string& security) {
    return run("fathom-gps-bridge", {"--config", source_dir() + "/deploy/config/gps_bridge.json", "--set",
                                     "bus.domain=58", "--set", "bus.security=" + security});
  };
  expect_refusal(bridge(R"({"folder": ")" + dir + R"("})"), "bus.security: " + dir + ": is no folder");
  ASSERT_EQ(keygen({dir}).code, 0);
  chmod((dir + "/gps_bridge/key.pem").c_str(), 0644);
  expect_refusal(bridge(R"({"folder": ")" + dir + R"("})"),
                 "key.pem: is open to others than its owner (mode 0644)");
  expect_refusal(bridge(R"({"folder": ")" + dir + R"(", "identity": "nobody"})"), "has no identity 'nobody'");
  expect_refusal(bridge(R"({"identity": "fusion"})"), "bus.security.folder");
}

}  // namespace
}  // namespace fathom::test
