#include "console/orders/orders.hpp"

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "console/http/refusal_log.hpp"

namespace fathom::console {
namespace {

const std::string kTokens =
    R"({"tokens": [{"name": "bridge", "role": "operator", "token": "0123456789abcdef"},
                   {"name": "guest", "role": "viewer", "token": "fedcba9876543210xyz"}]})";
const Identity kOperator{"bridge", Role::operator_};

TEST(Tokens, SayWhoSomebodyIs) {
  const TokenBook book = TokenBook::parse(kTokens);
  EXPECT_EQ(book.whois("0123456789abcdef").name, "bridge");
  EXPECT_EQ(book.whois("0123456789abcdef").role, Role::operator_);
  EXPECT_EQ(book.whois("fedcba9876543210xyz").role, Role::viewer);
  for (const char* wrong : {"", "0", "0123456789abcdeF", "0123456789abcdef0", "0123456789abcde"}) {
    EXPECT_EQ(book.whois(wrong).role, Role::nobody) << wrong;
  }
  EXPECT_EQ(book.whois(std::string(100000, 'a')).role, Role::nobody);
  EXPECT_EQ(TokenBook().whois("").role, Role::nobody);
}

TEST(Tokens, AFileThatIsNotExactlyOneIsRefused) {
  for (const char* bad :
       {"", "[]", "{}", R"({"tokens": []})", R"({"tokens": [{}]})", R"({"tokens": [1]})",
        R"({"tokens": [{"name": "a", "role": "captain", "token": "0123456789abcdef"}]})",
        R"({"tokens": [{"name": "a", "role": "viewer", "token": "short"}]})",
        R"({"tokens": [{"name": "", "role": "viewer", "token": "0123456789abcdef"}]})",
        R"({"tokens": [{"name": "a b", "role": "viewer", "token": "0123456789abcdef"}]})",
        R"({"tokens": [{"name": "a", "role": "viewer", "token": "0123456789abcdef", "x": 1}]})",
        R"({"tokens": [], "more": 1})"}) {
    EXPECT_THROW((void)TokenBook::parse(bad), TokenError) << bad;
  }
}

TEST(Tokens, AFileThatOthersMayReadIsRefused) {
  std::string path = (std::filesystem::temp_directory_path() / "fathom-tokens-XXXXXX").string();
  close(mkstemp(path.data()));
  std::ofstream(path) << kTokens;
  chmod(path.c_str(), 0644);
  EXPECT_THROW((void)TokenBook::load(path), TokenError);
  chmod(path.c_str(), 0600);
  EXPECT_EQ(TokenBook::load(path).whois("0123456789abcdef").name, "bridge");
  std::filesystem::remove(path);
  EXPECT_THROW((void)TokenBook::load(path), TokenError);
}

TEST(Orders, EachKindBecomesItsCommand) {
  const auto acknowledge =
      judge_order(R"({"kind": "acknowledge_alarm", "target": "gps_outage"})", kOperator, true);
  ASSERT_TRUE(acknowledge.command);
  EXPECT_EQ(acknowledge.status, 200);
  EXPECT_EQ(acknowledge.command->kind, CommandKind::acknowledge_alarm);
  EXPECT_EQ(acknowledge.command->target, Name("gps_outage"));
  EXPECT_TRUE(judge_order(R"({"kind": "realign"})", kOperator, true).command);
  EXPECT_EQ(judge_order(R"({"kind": "enable_source", "target": "gps"})", kOperator, true).command->kind,
            CommandKind::enable_source);
  EXPECT_EQ(judge_order(R"({"kind": "disable_source", "target": "gps"})", kOperator, true).command->kind,
            CommandKind::disable_source);
  const auto position = judge_order(
      R"({"kind": "set_position", "lat_deg": 36.4, "lon_deg": -127.4, "depth_m": 5, "sigma_m": 10})",
      kOperator, true);
  ASSERT_TRUE(position.command);
  EXPECT_NEAR(position.command->latitude_rad, 36.4 * M_PI / 180, 1e-12);
  EXPECT_NEAR(position.command->longitude_rad, -127.4 * M_PI / 180, 1e-12);
  EXPECT_EQ(position.command->depth_m, 5);
  EXPECT_EQ(describe(*position.command),
            "set_position 36.400000 deg N -127.400000 deg E depth 5.0 m sigma 10.0 m");
  EXPECT_FALSE(position.command->confirmed);
  const auto meant = judge_order(
      R"({"kind": "set_position", "lat_deg": 1, "lon_deg": 2, "depth_m": 5, "sigma_m": 10, "confirmed": true})",
      kOperator, true);
  ASSERT_TRUE(meant.command);
  EXPECT_TRUE(meant.command->confirmed);
}

TEST(Orders, AToldPositionIsNoCommand) {
  const auto told = judge_order(
      R"({"kind": "fix", "lat_deg": 36.4, "lon_deg": -127.4, "sigma_m": 20, "age_s": 600})", kOperator, true);
  EXPECT_EQ(told.status, 200);
  EXPECT_FALSE(told.command);
  ASSERT_TRUE(told.fix);
  EXPECT_NEAR(told.fix->latitude_rad, 36.4 * M_PI / 180, 1e-12);
  EXPECT_NEAR(told.fix->longitude_rad, -127.4 * M_PI / 180, 1e-12);
  EXPECT_EQ(told.fix->sigma_m, 20.0);
  EXPECT_EQ(told.fix->header.sensor, Name("operator"));
  EXPECT_FALSE(known(told.fix->depth_m));
  EXPECT_EQ(told.age_s, 600.0);
  EXPECT_EQ(describe(*told.fix, told.age_s),
            "fix of operator 36.400000 deg N -127.400000 deg E sigma 20.0 m, 600 s ago");
  const auto deep = judge_order(
      R"({"kind": "fix", "lat_deg": 1, "lon_deg": 2, "sigma_m": 5, "depth_m": 12, "from": "ship"})",
      kOperator, true);
  ASSERT_TRUE(deep.fix);
  EXPECT_EQ(deep.fix->depth_m, 12.0);
  EXPECT_EQ(deep.fix->header.sensor, Name("ship"));
  EXPECT_EQ(deep.age_s, 0.0);
  const char* order = R"({"kind": "fix", "lat_deg": 1, "lon_deg": 2, "sigma_m": 5})";
  EXPECT_FALSE(judge_order(order, {"guest", Role::viewer}, true).fix);
  EXPECT_EQ(judge_order(order, kOperator, false).status, 403);
}

TEST(Orders, OnlyOperatorsAndOnlyWhereOrdersAreOn) {
  const char* order = R"({"kind": "realign"})";
  EXPECT_EQ(judge_order(order, kOperator, false).status, 403);
  EXPECT_EQ(judge_order(order, {"guest", Role::viewer}, true).status, 403);
  EXPECT_EQ(judge_order(order, {}, true).status, 401);
  EXPECT_FALSE(judge_order(order, {}, true).command);
}

TEST(Orders, WhatIsNotExactlyAnOrderIsRefused) {
  for (const char* bad :
       {"",
        "{",
        "[]",
        "null",
        R"({"kind": 5})",
        R"({"kind": "self_destruct"})",
        R"({"kind": "mark_at_rest", "value_s": 5})",
        R"({"kind": "realign", "target": "gps"})",
        R"({"kind": "enable_source"})",
        R"({"kind": "enable_source", "target": ""})",
        R"({"kind": "enable_source", "target": "a name that is far too long for a sensor"})",
        R"({"kind": "enable_source", "target": "two words"})",
        R"({"kind": "set_position", "lat_deg": 91, "lon_deg": 0, "depth_m": 0, "sigma_m": 1})",
        R"({"kind": "set_position", "lat_deg": 1, "lon_deg": 0, "depth_m": 0})",
        R"({"kind": "set_position", "lat_deg": 1, "lon_deg": 0, "depth_m": 0, "sigma_m": 1, "confirmed": 1})",
        R"({"kind": "realign", "confirmed": true})",
        R"({"kind": "fix", "lat_deg": 1, "lon_deg": 2})",
        R"({"kind": "fix", "lat_deg": 1, "lon_deg": 2, "sigma_m": 0})",
        R"({"kind": "fix", "lat_deg": 1, "lon_deg": 2, "sigma_m": 5, "age_s": -1})",
        R"({"kind": "fix", "lat_deg": 1, "lon_deg": 2, "sigma_m": 5, "age_s": 7201})",
        R"({"kind": "fix", "lat_deg": 1, "lon_deg": 2, "sigma_m": 5, "from": "two words"})",
        R"({"kind": "set_position", "lat_deg": "1", "lon_deg": 0, "depth_m": 0, "sigma_m": 1})",
        R"({"kind": "set_position", "lat_deg": 1, "lon_deg": 0, "depth_m": 0, "sigma_m": 0})"}) {
    const auto judgement = judge_order(bad, kOperator, true);
    EXPECT_EQ(judgement.status, 400) << bad;
    EXPECT_FALSE(judgement.command || judgement.fix) << bad;
    EXPECT_NE(judgement.text, "") << bad;
  }
}

TEST(Orders, AKeyThatStandsTwiceIsRefusedByName) {
  const auto judgement = judge_order(
      R"({"kind": "set_position", "lat_deg": 1, "lon_deg": 0, "depth_m": 0, "sigma_m": 5, "lat_deg": 36})",
      kOperator, true);
  EXPECT_EQ(judgement.status, 400);
  EXPECT_EQ(judgement.text, "lat_deg: is given twice, expected each key once.");
  EXPECT_EQ(judge_order(R"({"kind": "realign", "kind": "realign"})", kOperator, true).status, 400);
}

TEST(Orders, TheTextItselfIsJudgedInWords) {
  EXPECT_EQ(judge_order(std::string(100'000, '['), kOperator, true).text.find("0.0.0"), 0U);
  EXPECT_EQ(judge_order(R"({"kind": "set_position", "lat_deg": 1e400})", kOperator, true).text,
            "lat_deg: is 1e400, expected a number between -1.8e308 and 1.8e308.");
  EXPECT_THROW((void)TokenBook::parse(R"({"tokens": [], "tokens": []})"), TokenError);
  EXPECT_NE(judge_order("{\"kind\"", kOperator, true).text.find("syntax error"), std::string::npos);
}

TEST(RefusalLog, OneLineAPeriodAndKind) {
  RefusalLog log(10 * kNsPerSecond, "a request");
  EXPECT_EQ(*log.add({400, "path"}, "10.0.0.1", 0), "refused a request from 10.0.0.1: path (400)");
  for (int i = 0; i < 1000; ++i) EXPECT_FALSE(log.add({400, "path"}, "10.0.0.1", kNsPerSecond));
  EXPECT_TRUE(log.add({401, "wrong_token"}, "10.0.0.1", kNsPerSecond)) << "another kind";
  EXPECT_EQ(*log.add({400, "path"}, "10.0.0.2", 11 * kNsPerSecond),
            "refused a request from 10.0.0.2: path (400), 1001 of them since it was last said");
}

}  // namespace
}  // namespace fathom::console
