#include "codec/registry.hpp"

#include <fstream>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "support/paths.hpp"

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

TEST(Registry, EveryProtocolHasAFuzzTarget) {
  // tests/fuzz/CMakeLists.txt writes the names that it finds in registry.cpp.
  std::ifstream in(test::binary_dir() + "/tests/fuzz/protocols");
  std::vector<std::string> found;
  for (std::string name; std::getline(in, name);) found.push_back(name);
  std::vector<std::string> expected;
  for (const Protocol& protocol : protocols()) expected.emplace_back(protocol.name);
  EXPECT_EQ(found, expected) << "each row of registry.cpp begins a line with its name: {\"name\",";
}

}  // namespace
}  // namespace fathom::codec
