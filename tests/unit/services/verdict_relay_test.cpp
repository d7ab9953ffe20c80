#include "fusion/replica/verdict_relay.hpp"

#include <gtest/gtest.h>

namespace fathom::fusion {
namespace {

Verdict verdict(std::uint64_t sequence, std::uint32_t revision, bool is_final,
                VerdictKind kind = VerdictKind::used) {
  Verdict out;
  out.header.sensor = "gps";
  out.header.sequence = sequence;
  out.header.stamp_ns = static_cast<TimeNs>(sequence) * kNsPerSecond;
  out.source = SourceKind::gps;
  out.kind = out.previous = kind;
  out.revision = revision;
  out.is_final = is_final;
  return out;
}

TEST(VerdictRelay, SaysWhatTheOneThatLedHadNoTimeFor) {
  VerdictRelay relay(2 * kNsPerSecond);
  relay.own(verdict(1, 0, false), 10);
  relay.heard(verdict(1, 0, false), 11);
  relay.heard(verdict(2, 0, false), 12);  // the other one was first
  relay.own(verdict(2, 0, false), 13);
  relay.own(verdict(1, 1, true), 20);
  relay.own(verdict(3, 0, false), 21);
  Verdict said;
  ASSERT_TRUE(relay.next_unsaid(said, 30));
  EXPECT_EQ(said.header.sequence, 1U);
  EXPECT_TRUE(said.is_final);
  ASSERT_TRUE(relay.next_unsaid(said, 30));
  EXPECT_EQ(said.header.sequence, 3U);
  EXPECT_FALSE(relay.next_unsaid(said, 30));
}

TEST(VerdictRelay, WhatTheOneThatLedSaidAheadOfThisOneIsNotSaidAgain) {
  VerdictRelay relay(2 * kNsPerSecond);
  relay.heard(verdict(1, 1, true), 10);
  relay.heard(verdict(2, 0, true), 11);
  // It leads now, and gets there itself.
  EXPECT_TRUE(relay.was_heard(verdict(1, 2, true), 20));
  EXPECT_FALSE(relay.was_heard(verdict(1, 2, true), 21));  // a second of that number is another one
  EXPECT_FALSE(relay.was_heard(verdict(3, 0, true), 22));
  EXPECT_FALSE(relay.was_heard(verdict(2, 0, true), 12 + 2 * kNsPerSecond));  // too long ago
}

TEST(VerdictRelay, AFinalVerdictIsTheSameWhateverWasSaidBefore) {
  VerdictRelay relay(2 * kNsPerSecond);
  relay.heard(verdict(1, 2, true), 10);  // after a revision that this one did not need
  relay.own(verdict(1, 1, true), 11);
  Verdict said;
  EXPECT_FALSE(relay.next_unsaid(said, 12));
}

TEST(VerdictRelay, TwoOfOneNumberAreTwo) {
  VerdictRelay relay(2 * kNsPerSecond);
  relay.own(verdict(1, 0, true, VerdictKind::duplicate), 10);
  relay.own(verdict(1, 0, true, VerdictKind::duplicate), 11);
  relay.heard(verdict(1, 0, true, VerdictKind::duplicate), 12);
  Verdict said;
  EXPECT_TRUE(relay.next_unsaid(said, 13));
  EXPECT_FALSE(relay.next_unsaid(said, 13));
}

TEST(VerdictRelay, IsBoundedInTimeAndNumber) {
  VerdictRelay relay(2 * kNsPerSecond);
  relay.own(verdict(1, 0, false), 10);
  Verdict said;
  EXPECT_FALSE(relay.next_unsaid(said, 11 + 2 * kNsPerSecond));
  for (std::uint64_t i = 0; i < 5000; ++i) relay.own(verdict(i, 0, false), 20);
  int count = 0;
  while (relay.next_unsaid(said, 21)) ++count;
  EXPECT_EQ(count, 2048);
  relay.own(verdict(1, 0, false), 30);
  relay.clear();
  EXPECT_FALSE(relay.next_unsaid(said, 31));
}

}  // namespace
}  // namespace fathom::fusion
