#include "codec/registry.hpp"

#include <fstream>
#include <iterator>
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
       {"nmea0183", "ubx", "pd0", "waterlinked", "vectornav", "paroscientific", "ascii_depth", "psimssb",
        "ascii_air_data", "nmea_air_data", "micromodem", "gpsd", "mavlink"}) {
    EXPECT_NE(find_protocol(name), nullptr) << name;
  }
}

TEST(Registry, EveryProtocolHasAFuzzTarget) {
  std::ifstream in(std::string(FATHOM_SOURCE_DIR) + "/tests/fuzz/CMakeLists.txt");
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  const std::size_t begin = text.find("set(FATHOM_FUZZ_PROTOCOLS ");
  ASSERT_NE(begin, std::string::npos);
  const std::string list = text.substr(begin, text.find(')', begin) - begin) + " ";
  for (const Protocol& protocol : protocols()) {
    EXPECT_NE(list.find(" " + std::string(protocol.name) + " "), std::string::npos) << protocol.name;
  }
}

}  // namespace
}  // namespace fathom::codec
