#include "codec/registry.hpp"

#include <set>
#include <string>

#include <gtest/gtest.h>

namespace fathom::codec {
namespace {

TEST(Registry, EveryProtocolIsFoundByEveryName) {
  for (const Protocol& protocol : protocols()) {
    EXPECT_EQ(find_protocol(protocol.name), &protocol);
    EXPECT_FALSE(protocol.description.empty());
    EXPECT_NE(protocol.make({}), nullptr);
    for (const std::string_view alias : protocol.aliases) EXPECT_EQ(find_protocol(alias), &protocol) << alias;
  }
}

TEST(Registry, NoNameMeansTwoProtocols) {
  std::set<std::string> names;
  for (const Protocol& protocol : protocols()) {
    EXPECT_TRUE(names.insert(std::string(protocol.name)).second) << protocol.name;
    for (const std::string_view alias : protocol.aliases) {
      EXPECT_TRUE(names.insert(std::string(alias)).second) << alias;
    }
  }
}

TEST(Registry, CaseAndDashesDoNotMatter) {
  EXPECT_EQ(find_protocol("U-Blox"), find_protocol("ubx"));
  EXPECT_EQ(find_protocol("NMEA-0183"), find_protocol("nmea0183"));
  EXPECT_EQ(find_protocol("WaterLinked-JSON"), find_protocol("waterlinked"));
  EXPECT_EQ(find_protocol(""), nullptr);
  EXPECT_EQ(find_protocol("pd"), nullptr);
  EXPECT_EQ(find_protocol("pd00"), nullptr);
}

TEST(Registry, EveryInstrumentOfTheVehicleIsThere) {
  for (const char* name :
       {"nmea0183", "ubx", "pd0", "waterlinked", "vectornav", "paroscientific", "ascii_depth", "psimssb"}) {
    EXPECT_NE(find_protocol(name), nullptr) << name;
  }
}

}  // namespace
}  // namespace fathom::codec
