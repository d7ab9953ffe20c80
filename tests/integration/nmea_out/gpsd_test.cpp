// A real gpsd reads our sentences, and our bridge reads that gpsd.

#include <array>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <mutex>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/iso8601.hpp"
#include "base/units.hpp"
#include "bus/reader.hpp"
#include "integration/nmea_out/spoken.hpp"
#include "samples/gps.hpp"
#include "support/free_port.hpp"
#include "support/paths.hpp"
#include "support/temporary_folder.hpp"

namespace fathom::test {
namespace {

constexpr const char* kGpsd = "/usr/sbin/gpsd";

/// Of a bridge that reads the gpsd at `port`.
std::vector<std::string> bridge_arguments(int port, const std::string& time_mode) {
  return {"--config",
          source_dir() + "/deploy/config/gps_bridge.json",
          "--set",
          "bus.domain=" + std::to_string(kDomain),
          "--set",
          "clock.anchor_file=",
          "--set",
          R"(sensors=[{"name":"gps","protocol":"gpsd","rate_hz":5,"time":{"mode":")" + time_mode +
              R"("},"source":{"type":"tcp_client","address":"127.0.0.1","port":)" + std::to_string(port) +
              "}}]"};
}

/// The vehicle and the service; gpsd is started by the tests.
class Gpsd : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!is_installed(kGpsd)) GTEST_SKIP() << "gpsd is not installed";
    Lines first(Lines::connected(tcp));
    EXPECT_FALSE(first.next_with("$INGGA,").empty()) << service.err();
  }
  [[nodiscard]] std::vector<std::string> gpsd_arguments() const {
    return {"-N", "-n", "-S", std::to_string(port), "tcp://127.0.0.1:" + std::to_string(tcp)};
  }

  const int tcp = free_port(SOCK_STREAM);
  const int port = free_port(SOCK_STREAM);  // of gpsd
  Vehicle vehicle;
  Process service{"fathom-nmea-out", arguments("[" + tcp_output(tcp) + "]")};
};

// gpsd reads us by TCP and tells its own clients our position, within what a sentence resolves.
TEST_F(Gpsd, TellsOurPosition) {
  Process gpsd(kGpsd, gpsd_arguments());
  const int descriptor = Lines::connected(port);
  ASSERT_GE(descriptor, 0) << gpsd.err();
  Lines client(descriptor);
  const std::string watch = "?WATCH={\"enable\":true,\"json\":true};\n";
  ASSERT_EQ(write(descriptor, watch.data(), watch.size()), static_cast<ssize_t>(watch.size()));
  int seen = 0;
  double worst_m = 0.0;
  for (int i = 0; i < 200 && seen < 20; ++i) {
    const std::string line = client.next_with("\"TPV\"", 15.0);
    ASSERT_FALSE(line.empty()) << client.all() << gpsd.err();
    const auto report = nlohmann::json::parse(line);
    if (!report.contains("lat") || !report.contains("time")) continue;
    const auto time_ns = from_iso8601(report.at("time").get<std::string>());
    ASSERT_TRUE(time_ns.has_value()) << line;
    const double north_m =
        (report.at("lat").get<double>() * kRadPerDeg - Vehicle::latitude_rad(*time_ns)) * 6.36e6;
    const double east_m =
        (report.at("lon").get<double>() * kRadPerDeg - Vehicle::kLongitude_rad) * 6.38e6 * std::cos(0.5);
    worst_m = std::max(worst_m, std::hypot(north_m, east_m));
    EXPECT_NEAR(report.value("speed", 0.0), 1.9, 0.01) << line;
    ++seen;
  }
  EXPECT_EQ(seen, 20);
  // Half of 1e-5 minutes are 9 mm in each direction; a millisecond is 2 mm.
  EXPECT_LT(worst_m, 0.016);
  RecordProperty("worst_mm", static_cast<int>(1000.0 * worst_m));
}

// The whole way round: our sentences, a real gpsd, our bridge.
TEST_F(Gpsd, FeedsTheBridge) {
  std::mutex mutex;
  std::vector<GpsSample> fixes;
  bus::Participant participant(presence(kDomain, "monitor"));
  bus::Reader<GpsSample> reader(participant, [&](const GpsSample& fix, const bus::SampleInfo&) {
    const std::lock_guard lock(mutex);
    if (fix.fix >= GpsFix::fix_3d) fixes.push_back(fix);
  });
  const auto count = [&] {
    const std::lock_guard lock(mutex);
    return fixes.size();
  };
  Process gpsd(kGpsd, gpsd_arguments());
  Process bridge("fathom-gps-bridge", bridge_arguments(port, "device_utc"));
  ASSERT_TRUE(wait_until([&] { return count() >= 20; }, 30.0)) << bridge.err() << gpsd.err();
  // gpsd is started again, as after an update: the bridge asks it anew.
  gpsd.kill(SIGKILL);
  (void)gpsd.wait();
  const std::size_t before = count();
  Process again(kGpsd, gpsd_arguments());
  EXPECT_TRUE(wait_until([&] { return count() >= before + 10; }, 30.0)) << bridge.err() << again.err();
  const std::lock_guard lock(mutex);
  for (const GpsSample& fix : fixes) {
    EXPECT_NEAR((fix.latitude_rad - Vehicle::latitude_rad(fix.header.stamp_ns)) * 6.36e6, 0.0, 0.016);
    EXPECT_NEAR((fix.longitude_rad - Vehicle::kLongitude_rad) * 6.38e6 * std::cos(0.5), 0.0, 0.016);
    EXPECT_NEAR(fix.velocity_N_m_s[0], 1.9, 0.01);
  }
}

std::string nmea(const std::string& body) {
  unsigned sum = 0;
  for (const char c : body) sum ^= static_cast<unsigned char>(c);
  std::array<char, 8> end{};
  std::snprintf(end.data(), end.size(), "*%02X\r\n", sum & 0xFFU);
  return "$" + body + end.data();
}

/// What a receiver said that goes north by 1e-3 minutes a second, from now on for `seconds`.
std::string log_of_a_receiver(int seconds) {
  std::string out;
  const std::time_t now = std::time(nullptr);
  for (int i = 0; i < seconds; ++i) {
    const std::time_t at = now + i;
    std::tm utc{};
    gmtime_r(&at, &utc);
    std::array<char, 128> text{};
    std::strftime(text.data(), text.size(), "%H%M%S.00", &utc);
    const std::string time(text.data());
    std::strftime(text.data(), text.size(), "%d%m%y", &utc);
    const std::string date(text.data());
    std::snprintf(text.data(), text.size(), "3330.%05d,N,15115.00000,E", 100 * i);
    const std::string place(text.data());
    out += nmea("GPRMC," + time + ",A," + place + ",3.60,0.0," + date + ",,,A");
    out += nmea("GPGGA," + time + "," + place + ",1,09,0.9,25.0,M,20.0,M,,");
  }
  return out;
}

// A receiver that gpsfake plays to a real gpsd, which our bridge reads.
TEST(Gpsfake, FeedsTheBridge) {
  constexpr const char* kGpsfake = "/usr/bin/gpsfake";
  if (!is_installed(kGpsd) || !is_installed(kGpsfake))
    GTEST_SKIP() << "gpsd or gpsd-clients is not installed";
  const TemporaryFolder folder;
  const std::string log = (folder.path() / "log.nmea").string();
  std::ofstream(log) << log_of_a_receiver(60);
  std::mutex mutex;
  std::vector<GpsSample> fixes;
  bus::Participant participant(presence(kDomain, "monitor"));
  bus::Reader<GpsSample> reader(participant, [&](const GpsSample& fix, const bus::SampleInfo&) {
    const std::lock_guard lock(mutex);
    if (fix.fix >= GpsFix::fix_3d) fixes.push_back(fix);
  });
  const int port = free_port(SOCK_STREAM);
  // It waits for a client. A signal that comes while it asks whether its gpsd lives makes it ask without end:
  // `timeout` ends both of them 5 s after the signal.
  Process gpsfake("/usr/bin/timeout",
                  {"--kill-after=5", "120", kGpsfake, "-1", "-c", "0.05", "-P", std::to_string(port), log});
  Process bridge("fathom-gps-bridge", bridge_arguments(port, "arrival"));
  const bool enough = wait_until(
      [&] {
        const std::lock_guard lock(mutex);
        return fixes.size() >= 20;
      },
      30.0);
  gpsfake.kill(SIGINT);  // it ends its gpsd
  (void)gpsfake.wait();
  ASSERT_TRUE(enough) << bridge.err() << gpsfake.err();
  const std::lock_guard lock(mutex);
  for (const GpsSample& fix : fixes) {
    const double minutes = (fix.latitude_rad / kRadPerDeg - 33.5) * 60.0;
    EXPECT_NEAR(minutes * 1000.0, std::round(minutes * 1000.0), 1e-3) << "one of the places of the log";
    EXPECT_GE(minutes, -1e-6);
    EXPECT_LT(minutes, 0.06);
    EXPECT_NEAR(fix.longitude_rad / kRadPerDeg, 151.25, 1e-9);
    EXPECT_NEAR(fix.altitude_m, 45.0, 0.01)
        << "above the ellipsoid: 25 m above the sea, which is 20 m above it";
    EXPECT_NEAR(fix.velocity_N_m_s[0], 3.6 * 1852.0 / 3600.0, 0.01);
  }
}

}  // namespace
}  // namespace fathom::test
