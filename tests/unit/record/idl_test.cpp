#include "record/idl.hpp"

#include <gtest/gtest.h>

#include "bus/topics.hpp"

namespace fathom {
namespace {

TEST(Idl, IsSelfContainedForEveryTopic) {
  for (const bus::TopicInfo& topic : bus::all_topics()) {
    const auto idl = record::self_contained_idl(record::idl_files(), topic.type);
    ASSERT_TRUE(idl) << idl.error().message;
    const std::string name = std::string(topic.type).substr(std::string("fathom::v1::").size());
    EXPECT_NE(idl.value().find("struct " + name + " {"), std::string::npos) << idl.value();
    EXPECT_EQ(idl.value().find("#include"), std::string::npos);
  }
}

TEST(Idl, HoldsWhatATypeIsMadeOfAndNothingElse) {
  const auto idl = record::self_contained_idl(record::idl_files(), "fathom::v1::MonitorStatus");
  ASSERT_TRUE(idl);
  const std::string& text = idl.value();
  for (const char* needed : {"enum NavMode", "enum AlignmentPhase", "enum Severity", "enum Presence",
                             "struct WatchedItem", "struct ReceiverOutage", "@final\nstruct MonitorStatus"}) {
    EXPECT_NE(text.find(needed), std::string::npos) << needed;
  }
  for (const char* other : {"ServiceStatus {", "struct NavState", "VERDICT_", "struct Alarm"}) {
    EXPECT_EQ(text.find(other), std::string::npos) << other;
  }
  EXPECT_LT(text.find("enum Presence"), text.find("struct WatchedItem"));
}

TEST(Idl, NamesATypeThatIsNotDefined) {
  const auto idl = record::self_contained_idl(record::idl_files(), "fathom::v1::Nothing");
  ASSERT_FALSE(idl);
  EXPECT_EQ(idl.error().message, "no IDL file defines fathom::v1::Nothing");
}

}  // namespace
}  // namespace fathom
