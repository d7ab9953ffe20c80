// Who has not proved an identity: what is remembered, what is said, and that nobody can make it grow.

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bus/detail/security/stranger_book.hpp"

namespace fathom::bus::detail {
namespace {

GuidPrefix stranger(std::uint8_t last) {
  GuidPrefix out{};
  out[0] = 1;
  out[11] = last;
  return out;
}

TEST(StrangerBook, OneThatIsRefusedStaysUntilItLeaves) {
  StrangerBook book([] { return TimeNs{0}; });
  (void)book.announced(stranger(1), {"evil", "host", 7}, "10.0.0.9", false);
  EXPECT_TRUE(book.present().empty());
  EXPECT_EQ(to_string(book.refused(stranger(1), "failed")),
            "'evil' (GUID 010000000000000000000001, says it is at 10.0.0.9) offers no identity");
  (void)book.announced(stranger(1), {"other", "host", 7}, "10.0.0.9", true);
  ASSERT_EQ(book.present().size(), 1U);
  EXPECT_EQ(book.present()[0].name, "evil");
  EXPECT_TRUE(book.gone(stranger(1)));
  EXPECT_TRUE(book.present().empty());
}

TEST(StrangerBook, OneThatIsRefusedBeforeItAnnouncedItselfIsRememberedForAWhile) {
  TimeNs now = 0;
  StrangerBook book([&now] { return now; });
  EXPECT_EQ(to_string(book.refused(stranger(1), "failed")),
            "one without a name (GUID 010000000000000000000001) failed");
  ASSERT_EQ(book.present().size(), 1U);
  now = StrangerBook::kMemory;
  EXPECT_TRUE(book.overdue().empty());
  EXPECT_TRUE(book.forgotten().empty());
  (void)book.refused(stranger(1), "failed");  // again: it is still there
  now += StrangerBook::kMemory;
  EXPECT_TRUE(book.forgotten().empty());
  ++now;
  ASSERT_EQ(book.forgotten().size(), 1U);
  EXPECT_TRUE(book.present().empty());
  // One that announces itself after all has a name, and stays until it leaves.
  (void)book.refused(stranger(2), "failed");
  (void)book.announced(stranger(2), {"evil", "host", 7}, "10.0.0.9", true);
  now += 2 * StrangerBook::kMemory;
  EXPECT_TRUE(book.forgotten().empty());
  ASSERT_EQ(book.present().size(), 1U);
  EXPECT_EQ(to_string(book.present()[0]),
            "'evil' (GUID 010000000000000000000002, says it is at 10.0.0.9) failed");
  EXPECT_TRUE(book.gone(stranger(2)));
  // Invented ones do not make it grow.
  for (int i = 0; i < 1000; ++i) {
    GuidPrefix invented = stranger(static_cast<std::uint8_t>(i));
    invented[1] = static_cast<std::uint8_t>(i / 256 + 1);
    (void)book.refused(invented, "failed");
  }
  EXPECT_EQ(book.present().size(), StrangerBook::kMost);
}

TEST(StrangerBook, OneThatProvesItsIdentityIsAPeer) {
  TimeNs now = 0;
  StrangerBook book([&now] { return now; });
  (void)book.announced(stranger(1), {"fusion", "host", 7}, "10.0.0.9", true);
  const auto peer = book.admitted(stranger(1));
  ASSERT_TRUE(peer);
  EXPECT_EQ(peer->name, "fusion");
  EXPECT_FALSE(book.announced(stranger(1), {"another name", "host", 7}, "10.0.0.9", true));
  EXPECT_THAT(book.refused(stranger(1), "failed").why,
              testing::HasSubstr("somebody failed to prove the same"));
  now = 2 * StrangerBook::kPatience;
  EXPECT_TRUE(book.overdue().empty());
  EXPECT_TRUE(book.present().empty());
  EXPECT_FALSE(book.gone(stranger(1)));
}

TEST(StrangerBook, OneThatIsAnnouncedAfterItsProofIsAPeer) {
  StrangerBook book([] { return TimeNs{0}; });
  EXPECT_FALSE(book.admitted(stranger(1)));
  const auto peer = book.announced(stranger(1), {"fusion", "host", 7}, "10.0.0.9", true);
  ASSERT_TRUE(peer);
  EXPECT_EQ(peer->name, "fusion");
  EXPECT_FALSE(book.announced(stranger(1), {"another name", "host", 7}, "10.0.0.9", true));
  EXPECT_FALSE(book.admitted(stranger(1)));
  EXPECT_FALSE(book.announced(stranger(1), {"another name", "host", 7}, "10.0.0.9", true));
}

TEST(StrangerBook, OneThatNeverProvesItIsRefusedInTheEnd) {
  TimeNs now = 0;
  StrangerBook book([&now] { return now; });
  (void)book.announced(stranger(1), {"slow", "", 0}, "", true);
  now = StrangerBook::kPatience - 1;
  EXPECT_TRUE(book.overdue().empty());
  now = StrangerBook::kPatience;
  const auto strangers = book.overdue();
  ASSERT_EQ(strangers.size(), 1U);
  EXPECT_EQ(to_string(strangers[0]), "'slow' (GUID 010000000000000000000001) did not prove an identity");
  EXPECT_TRUE(book.overdue().empty());  // said once
  EXPECT_EQ(book.present().size(), 1U);
  EXPECT_TRUE(book.admitted(stranger(1)));  // and still may, later
  EXPECT_TRUE(book.present().empty());
}

TEST(StrangerBook, RemembersOnlySoMany) {
  StrangerBook book([] { return TimeNs{0}; });
  for (int i = 0; i < 250; ++i) {
    (void)book.announced(stranger(static_cast<std::uint8_t>(i)), {"evil", "", 0}, "", false);
    (void)book.refused(stranger(static_cast<std::uint8_t>(i)), "failed");
  }
  EXPECT_EQ(book.present().size(), StrangerBook::kMost);
  // Who has an identity still finds room, and its name.
  (void)book.announced(stranger(250), {"fusion", "auv1", 7}, "", true);
  const auto fusion = book.admitted(stranger(250));
  ASSERT_TRUE(fusion);
  EXPECT_EQ(fusion->name, "fusion");
}

TEST(StrangerBook, WhatStrangersSayOfThemselvesIsCleaned) {
  EXPECT_EQ(cleaned("a\nb\x1b[31m'c\xff"), "a?b?[31m?c?");
  EXPECT_EQ(cleaned(std::string(1000, 'x')).size(), 40U);
}

TEST(Denials, AreReadFromTheLog) {
  const std::string guid = "01.0f.b0.c1.02.03.04.05.06.07.08.ff|0.0.1.3";
  const auto writer =
      parse_denial("Error checking create remote writer " + guid +
                   " (fathom/v1/nav_state topic not found in allow rule. (/build/Permissions.cpp:1247))");
  ASSERT_TRUE(writer);
  EXPECT_TRUE(writer->writes);
  EXPECT_FALSE(writer->whole);
  EXPECT_EQ(writer->topic, "fathom/v1/nav_state");
  EXPECT_EQ(writer->who[0], 0x01);
  EXPECT_EQ(writer->who[11], 0xff);
  const auto reader = parse_denial("Error checking create remote reader " + guid + " (t topic not found)");
  ASSERT_TRUE(reader);
  EXPECT_FALSE(reader->writes);
  EXPECT_EQ(reader->topic, "t");
  const auto whole =
      parse_denial("Error validating remote permissions for " + guid + " (Failed verification).");
  ASSERT_TRUE(whole);
  EXPECT_TRUE(whole->whole);
  EXPECT_FALSE(parse_denial("Error checking create remote writer 01.0f (t topic x)"));
  EXPECT_FALSE(parse_denial("Error checking creation of local writer " + guid));
  EXPECT_FALSE(parse_denial(""));
}

}  // namespace
}  // namespace fathom::bus::detail
