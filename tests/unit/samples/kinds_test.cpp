#include "samples/kinds.hpp"

#include <set>

#include <gtest/gtest.h>

namespace fathom {
namespace {

TEST(Kinds, WordsAndRolesAreFoundByTheirKind) {
  std::set<std::string_view> words;
  for_each_kind([&](auto kind) {
    EXPECT_TRUE(words.insert(kind.kWord).second) << kind.kWord;
    EXPECT_EQ(to_string(kind.kSource), kind.kWord);
    EXPECT_EQ(kind_named(kind.kWord), kind.kSource);
    EXPECT_EQ(role_of(kind.kSource), kind.kRole);
    EXPECT_EQ(kind.kTopic, "fathom/v1/" + std::string(kind.kWord));
  });
  EXPECT_EQ(kind_named("gyro"), std::nullopt);
  EXPECT_EQ(role_of(static_cast<SourceKind>(250)), "unknown");
}

TEST(Kinds, WhatOnlyInformsDoesNotAid) {
  EXPECT_TRUE(Informing<AltimeterSample>);
  EXPECT_FALSE(Aiding<AltimeterSample>);
  EXPECT_TRUE(Aiding<RangeSample>);
  EXPECT_TRUE(Aiding<FixSample>);
  for_each_aiding_kind([](auto kind) { EXPECT_EQ(kind.kUse, Use::aiding) << kind.kWord; });
}

TEST(Kinds, EachRoleIsNamedOnceThoughItMayPublishSeveralKinds) {
  const auto roles = bridge_roles();
  const std::set<std::string_view> once(roles.begin(), roles.end());
  EXPECT_EQ(once.size(), roles.size());
  EXPECT_LT(roles.size(), kSourceKinds);  // propulsor and fins speak through one bridge
  for_each_kind([&](auto kind) { EXPECT_EQ(once.count(kind.kRole), 1U) << kind.kRole; });
}

}  // namespace
}  // namespace fathom
