#include <gtest/gtest.h>

#include "demo/report.hpp"

namespace fathom::demo {
namespace {

TEST(StatusLine, SaysADepthAndThatThereIsNone) {
  Observation seen;
  NavState& nav = seen.nav.emplace();
  nav.latitude_rad = 0.6;
  nav.longitude_rad = 2.2;
  nav.rpy_rad = {0.0, 0.0, 0.5};
  nav.position_covariance_N_m2 = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};
  nav.depth_m = 12.34;
  EXPECT_NE(status_line(3.0, seen).find("  depth  12.3 m  yaw  28.6 deg  95%   2.5 m"), std::string::npos)
      << status_line(3.0, seen);
  nav.depth_m = kUnknown;
  EXPECT_NE(status_line(3.0, seen).find("  depth     - m  yaw"), std::string::npos) << status_line(3.0, seen);
}

}  // namespace
}  // namespace fathom::demo
