#include <cstdio>
#include <cstdlib>

#include <fathom/client.hpp>

int main(int, char** argv) {
  constexpr double kDegree = 0.017453292519943295;
  fathom::Client navigation({.domain = static_cast<std::uint32_t>(std::atoi(argv[1])), .vehicle = "auv"});
  for (int i = 0; i < 50 && !navigation.health().ok; ++i) (void)navigation.wait_next(0.1);
  const auto health = navigation.health();
  if (!health.ok) return std::puts(health.reason.c_str()), 1;
  const auto state = *navigation.latest();
  std::printf("%.6f %.6f %s\n", state.latitude_rad / kDegree, state.longitude_rad / kDegree,
              std::string(to_string(state.mode)).c_str());
}
