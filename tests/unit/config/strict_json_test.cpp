// What a configuration file may be at all, before anybody looks for a key in it.

#include "config/json/strict_json.hpp"

#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "config/discovery_config.hpp"
#include "config/service_config.hpp"

namespace fathom::config {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

std::string place(const std::string& name) {
  return ::testing::TempDir() + "strict_json_" +
         ::testing::UnitTest::GetInstance()->current_test_info()->name() + "_" + name;
}

/// The answer of a service to its configuration file.
std::string refusal(const LoadRequest& request) {
  try {
    (void)load_service_config<DiscoveryConfig>(request);
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "accepted";
}

std::string refusal_of_text(const std::string& text) {
  const std::string file = place("file.json");
  std::ofstream(file) << text;
  return refusal({file, {}});
}

std::string nested(int levels, const std::string& key) {
  std::string out;
  for (int i = 0; i < levels; ++i) out += "{\"" + key + "\":";
  out += "1";
  out.append(static_cast<std::size_t>(levels), '}');
  return out;
}

TEST(StrictJson, NestingIsLimitedBeforeAnythingFollowsIt) {
  EXPECT_THAT(refusal_of_text(nested(100'000, "a")),
              AllOf(HasSubstr("file.json"), HasSubstr("a.a.a"), HasSubstr("at most 32 levels")));
  EXPECT_THAT(refusal_of_text(std::string(100'000, '[')), HasSubstr("at most 32 levels"));
  EXPECT_LT(refusal_of_text(nested(100'000, "a")).size(), 600U) << "the words stay readable";
  EXPECT_THAT(refusal_of_text(nested(32, "a")), HasSubstr("no such key"));
}

TEST(StrictJson, NestingOnTheCommandLineIsLimitedAsWell) {
  const std::string file = place("file.json");
  std::ofstream(file) << "{}";
  EXPECT_THAT(refusal({file, {"bus.peers=" + std::string(100'000, '[')}}),
              AllOf(HasSubstr("bus.peers"), HasSubstr("at most 32 levels")));
  std::string path = "a";
  for (int i = 0; i < 100'000; ++i) path += ".a";
  EXPECT_THAT(refusal({file, {path + "=1"}}), HasSubstr("at most 32 levels"));
}

TEST(StrictJson, ANumberThatNoDoubleHoldsIsNamedWithItsKey) {
  EXPECT_THAT(refusal_of_text("{\"bus\":{\n\"domain\":1e400}}"),
              AllOf(HasSubstr("file.json"), HasSubstr("bus.domain: is 1e400"), HasSubstr("1.8e308")));
  EXPECT_THAT(refusal_of_text("{\"bus\":{\"peers\":[1, -1e999]}}"), HasSubstr("bus.peers.1: is -1e999"));
}

TEST(StrictJson, AKeyStandsOnceInItsObject) {
  EXPECT_THAT(refusal_of_text(R"({"bus":{"domain":1,"interfaces":["127.0.0.1"],"domain":2}})"),
              AllOf(HasSubstr("file.json"), HasSubstr("bus.domain"), HasSubstr("twice")));
  EXPECT_THAT(refusal_of_text(R"({"vehicle":"auv","log":{},"vehicle":"auv"})"),
              HasSubstr("vehicle: is given twice"));
  const std::string file = place("file.json");
  std::ofstream(file) << "{}";
  EXPECT_THAT(refusal({file, {R"(bus={"domain":1,"domain":2})"}}), HasSubstr("bus.domain: is given twice"));
  const auto same_key_elsewhere = parse_strict(R"({"a":{"x":1},"b":{"x":1},"c":[{"x":1},{"x":2}]})");
  EXPECT_FALSE(same_key_elsewhere.fault);
}

TEST(StrictJson, AFaultDoesNotBreakTheLineOfTheLog) {
  const std::string words = refusal_of_text("{\"a\\nerror: all is lost\":1}");
  EXPECT_THAT(words, AllOf(HasSubstr("no such key"), Not(HasSubstr("\n"))));
}

TEST(StrictJson, WhatIsNoRegularFileIsRefusedAtOnce) {
  EXPECT_THAT(refusal({"/dev/zero", {}}),
              AllOf(HasSubstr("/dev/zero"), HasSubstr("a device"), HasSubstr("a regular file")));
  EXPECT_THAT(refusal({::testing::TempDir(), {}}), AllOf(HasSubstr("a folder"), HasSubstr("a regular file")));
  const std::string pipe = place("pipe");
  (void)::unlink(pipe.c_str());
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_THAT(refusal({pipe, {}}), AllOf(HasSubstr(pipe), HasSubstr("a pipe"), HasSubstr("a regular file")));
  (void)::unlink(pipe.c_str());
}

TEST(StrictJson, AFileOfAnySizeIsNotReadIntoMemory) {
  const std::string file = place("large.json");
  std::ofstream(file) << "{}";
  ASSERT_EQ(::truncate(file.c_str(), 1LL << 33), 0);  // eight sparse gigabytes
  EXPECT_THAT(refusal({file, {}}), AllOf(HasSubstr("large.json"), HasSubstr("at most 4 MiB")));
  (void)::unlink(file.c_str());
}

TEST(StrictJson, TellsWhatIsWrongAndWhere) {
  const auto broken = parse_strict("{\n\"on\": tru\n}");
  ASSERT_TRUE(broken.fault);
  EXPECT_EQ(broken.fault->kind, JsonFault::Kind::syntax);
  EXPECT_EQ(broken.fault->line, 2);
  EXPECT_EQ(parse_strict("").fault->kind, JsonFault::Kind::syntax);
  EXPECT_EQ(parse_strict("\xff\xfe").fault->kind, JsonFault::Kind::syntax);
  EXPECT_EQ(parse_strict("{} {}").fault->kind, JsonFault::Kind::syntax);
}

}  // namespace
}  // namespace fathom::config
