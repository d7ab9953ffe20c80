#include "base/nearest.hpp"

#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace fathom {
namespace {

const std::vector<std::string> kWords{"record", "replay", "report", "solve", "simulate", "plot"};

TEST(Nearest, FindsWhatWasMistyped) {
  EXPECT_EQ(nearest("recrod", kWords), "record");  // swapped
  EXPECT_EQ(nearest("repley", kWords), "replay");  // changed
  EXPECT_EQ(nearest("repot", kWords), "report");   // left out
  EXPECT_EQ(nearest("solvee", kWords), "solve");   // added
  EXPECT_EQ(nearest("simulate", kWords), "simulate");
}

TEST(Nearest, SaysNothingWhereNothingIsNear) {
  EXPECT_EQ(nearest("explain", kWords), std::nullopt);
  EXPECT_EQ(nearest("", kWords), std::nullopt);
  EXPECT_EQ(nearest("x", kWords), std::nullopt);
  EXPECT_EQ(nearest(std::string(100'000, 'a'), kWords), std::nullopt);
  EXPECT_EQ(nearest("solve", {}), std::nullopt);
}

TEST(Nearest, TakesTheFirstOfEquals) {
  const std::vector<std::string> words{"gate_a", "gate_b"};
  EXPECT_EQ(nearest("gate_c", words), "gate_a");
}

TEST(Nearest, KnowsANameByItsParts) {
  const std::vector<std::string> models{"ublox_m8", "ublox_zed_f9p", "vectornav_vn100", "vectornav_vn200"};
  EXPECT_EQ(nearest("ublox_f9p", models), "ublox_zed_f9p");  // nearer by letters is ublox_m8
  EXPECT_EQ(nearest("vn100", models), "vectornav_vn100");
  EXPECT_EQ(nearest("vectornav_vn10", models), "vectornav_vn100");
  EXPECT_EQ(nearest("ublox", models), std::nullopt);  // two have it
  EXPECT_EQ(nearest("_", models), std::nullopt);
}

}  // namespace
}  // namespace fathom
