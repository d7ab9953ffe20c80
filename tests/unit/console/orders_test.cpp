#include "console/orders/orders.hpp"

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

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
  EXPECT_THROW((void)TokenBook::parse(R"({"tokens": [], "tokens": []})"), TokenError);
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
  ASSERT_EQ(mkfifo(path.c_str(), 0600), 0);
  EXPECT_THROW((void)TokenBook::load(path), TokenError) << "and a pipe is not waited for";
  std::filesystem::remove(path);
}

TEST(Orders, OnlyOperatorsAndOnlyWhereOrdersAreOn) {
  const char* order = R"({"kind": "realign"})";
  EXPECT_EQ(judge_order(order, kOperator, false).status, 403);
  EXPECT_EQ(judge_order(order, {"guest", Role::viewer}, true).status, 403);
  EXPECT_EQ(judge_order(order, {}, true).status, 401);
  EXPECT_EQ(judge_order("{", kOperator, true).status, 400);
  EXPECT_FALSE(judge_order("{", kOperator, true).order);
  const auto given = judge_order(order, kOperator, true);
  EXPECT_EQ(given.status, 200);
  EXPECT_EQ(given.text, "Sent by bridge: realign.");
  ASSERT_TRUE(given.order);
  EXPECT_EQ(std::get<Command>(*given.order).kind, CommandKind::realign);
  EXPECT_FALSE(judge_order(order, {}, true).order);
}

TEST(Orders, AToldPositionIsAnsweredWithWhoToldItAndWhatBecameOfIt) {
  const auto told = judge_order(
      R"({"kind": "fix", "lat_deg": 36, "lon_deg": 127, "sigma_m": 20, "from": "ship"})", kOperator, true);
  EXPECT_EQ(told.status, 200);
  EXPECT_TRUE(told.text.starts_with("Told by bridge: fix of ship ")) << told.text;
  const FixSample fix;
  const auto answer = [&](VerdictKind kind) {
    Verdict verdict;
    verdict.kind = kind;
    return judged(told, fix, verdict);
  };
  EXPECT_EQ(answer(VerdictKind::used).status, 200);
  EXPECT_EQ(answer(VerdictKind::used).verdict, "used");
  EXPECT_NE(answer(VerdictKind::used).text.find("Navigation has taken it"), std::string::npos);
  EXPECT_EQ(answer(VerdictKind::rejected).status, 200);
  EXPECT_NE(answer(VerdictKind::rejected).text.find("Navigation has refused it: rejected"),
            std::string::npos);
  EXPECT_EQ(answer(VerdictKind::source_disabled).status, 409);
  EXPECT_NE(answer(VerdictKind::source_disabled).text.find("no such source"), std::string::npos);
  EXPECT_EQ(judged(told, fix, std::nullopt).status, 202);
  EXPECT_NE(judged(told, fix, std::nullopt).text.find("not judged it yet"), std::string::npos);
}

}  // namespace
}  // namespace fathom::console
