// The service fathom-nmea-out over real DDS, sockets and a pseudo-terminal, read by us and by programs of
// others.

#include <atomic>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <mutex>
#include <numbers>
#include <sstream>
#include <thread>

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <nlohmann/json.hpp>
#include <poll.h>
#include <pty.h>
#include <sys/socket.h>
#include <termios.h>
#include <unistd.h>

#include "base/clock.hpp"
#include "base/iso8601.hpp"
#include "bus/reader.hpp"
#include "bus/writer.hpp"
#include "samples/gps.hpp"
#include "samples/nav_state.hpp"
#include "samples/status/health.hpp"
#include "support/free_port.hpp"
#include "support/presence.hpp"
#include "support/process.hpp"
#include "support/temporary_folder.hpp"

namespace fathom::test {
namespace {

constexpr std::uint32_t kDomain = 223;
constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kSpeed_rad_s = 3e-7;  // 1.9 m/s to the north

/// Goes north at a known speed, and says so a hundred times a second.
class Vehicle {
 public:
  Vehicle() : participant_(presence(kDomain, "fusion")), states_(participant_) {
    thread_ = std::thread([this] {
      auto next = std::chrono::steady_clock::now();
      while (!stop_) {
        if (!quiet_) states_.write(state());
        next += std::chrono::milliseconds(10);
        std::this_thread::sleep_until(next);
      }
    });
  }
  ~Vehicle() {
    stop_ = true;
    thread_.join();
  }
  void be_quiet(bool quiet) { quiet_ = quiet; }
  void rest_on(NavMode mode) { mode_ = mode; }
  [[nodiscard]] static double latitude_rad(TimeNs stamp_ns) {
    constexpr TimeNs kEpoch_ns = 1'700'000'000 * kNsPerSecond;
    return -0.5 + kSpeed_rad_s * std::fmod(to_seconds(stamp_ns - kEpoch_ns), 100'000.0);
  }
  static constexpr double kLongitude_rad = 2.0;

 private:
  NavState state() {
    NavState out;
    const TimeNs now_ns = clock_.utc_ns();
    out.header = {"auv", "fusion", now_ns, now_ns, ++sequence_};
    out.mode = mode_;
    out.alignment = AlignmentPhase::aligned;
    out.latitude_rad = latitude_rad(now_ns);
    out.longitude_rad = kLongitude_rad;
    out.altitude_m = -5.0;
    out.depth_m = 5.0;
    out.altitude_above_bottom_m = 12.0;
    out.velocity_N_m_s = {1.9, 0.0, 0.0};
    out.q_NB = {1.0, 0.0, 0.0, 0.0};
    out.rpy_rad = {0.0, 0.0, 0.0};
    out.angular_rate_B_rad_s = {0.0, 0.0, 0.0};
    out.position_covariance_N_m2 = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};
    out.velocity_covariance_N_m2_s2 = out.position_covariance_N_m2;
    out.rpy_sigma_rad = {0.001, 0.001, 0.01};
    return out;
  }

  SystemClock clock_;
  bus::Participant participant_;
  bus::Writer<NavState> states_;
  std::uint64_t sequence_ = 0;
  std::atomic<bool> stop_ = false;
  std::atomic<bool> quiet_ = false;
  std::atomic<NavMode> mode_ = NavMode::gps_aided;
  std::thread thread_;
};

sockaddr_in here(int port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  return address;
}

/// A descriptor, read as lines.
class Lines {
 public:
  explicit Lines(int descriptor) : descriptor_(descriptor) {}
  ~Lines() { close(descriptor_); }
  Lines(const Lines&) = delete;
  Lines& operator=(const Lines&) = delete;

  /// A connection to a port of this host; waits until somebody listens there.
  [[nodiscard]] static int connected(int port) {
    const sockaddr_in address = here(port);
    int descriptor = -1;
    (void)wait_until([&] {
      descriptor = socket(AF_INET, SOCK_STREAM, 0);
      if (connect(descriptor, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0) return true;
      close(descriptor);
      descriptor = -1;
      return false;
    });
    return descriptor;
  }
  [[nodiscard]] static int bound(int port) {
    const int descriptor = socket(AF_INET, SOCK_DGRAM, 0);
    const sockaddr_in address = here(port);
    EXPECT_EQ(bind(descriptor, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
    return descriptor;
  }

  /// The next line for which `wanted` is true; empty when there is none within the time.
  template <class Wanted>
  std::string next(Wanted&& wanted, double seconds = 10.0) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
    for (;;) {
      for (std::size_t cut = text_.find('\n'); cut != std::string::npos; cut = text_.find('\n')) {
        const std::string line = text_.substr(0, cut + 1);
        text_.erase(0, cut + 1);
        all_ += line;
        if (wanted(line)) return line;
      }
      const auto left =
          std::chrono::duration_cast<std::chrono::milliseconds>(end - std::chrono::steady_clock::now());
      pollfd one{descriptor_, POLLIN, 0};
      if (left.count() <= 0 || poll(&one, 1, static_cast<int>(left.count())) <= 0) return "";
      std::array<char, 4096> piece{};
      const ssize_t size = read(descriptor_, piece.data(), piece.size());
      if (size <= 0) return "";
      text_.append(piece.data(), static_cast<std::size_t>(size));
    }
  }
  std::string next_with(const std::string& part, double seconds = 10.0) {
    return next([&](const std::string& line) { return line.find(part) != std::string::npos; }, seconds);
  }
  /// Everything that went by.
  [[nodiscard]] const std::string& all() const { return all_; }

 private:
  int descriptor_;
  std::string text_;
  std::string all_;
};

constexpr const char* kEverything =
    R"([{"sentence":"GGA","rate_hz":5},{"sentence":"RMC","rate_hz":5},{"sentence":"VTG"},{"sentence":"GST"},)"
    R"({"sentence":"HDT","rate_hz":10},{"sentence":"ZDA"},{"sentence":"DPT"},{"sentence":"VBW"},{"sentence":"ROT"},)"
    R"({"sentence":"PFTHM"}])";

std::vector<std::string> arguments(const std::string& outputs) {
  return {"--config", std::string(FATHOM_SOURCE_DIR) + "/deploy/config/nmea_out.json",
          "--set",    "bus.domain=" + std::to_string(kDomain),
          "--set",    "clock.anchor_file=",
          "--set",    "outputs=" + outputs};
}

std::string tcp_output(int port) {
  return R"({"type":"tcp_server","address":"127.0.0.1","port":)" + std::to_string(port) + R"(,"sentences":)" +
         kEverything + "}";
}

bool is_installed(const std::string& program) {
  return std::filesystem::exists(program);
}

TEST(NmeaOut, SpeaksByTcpUdpAndSerialLine) {
  const int tcp = free_port(SOCK_STREAM);
  const int udp = free_port(SOCK_DGRAM);
  int line = -1;
  int device = -1;
  std::array<char, 64> path{};
  ASSERT_EQ(openpty(&line, &device, path.data(), nullptr, nullptr), 0);
  termios raw{};
  tcgetattr(device, &raw);
  cfmakeraw(&raw);
  tcsetattr(device, TCSANOW, &raw);
  Lines datagrams(Lines::bound(udp));
  Lines serial(line);
  Vehicle vehicle;
  Process service(
      "fathom-nmea-out",
      arguments("[" + tcp_output(tcp) + R"(,{"type":"udp","port":)" + std::to_string(udp) +
                R"(,"talker":"GP","sentences":[{"sentence":"RMC"}]},{"type":"serial","baud":9600,"path":")" +
                path.data() + R"(","sentences":[{"sentence":"HDT","rate_hz":10}]}])"));
  Lines one(Lines::connected(tcp));
  Lines other(Lines::connected(tcp));
  EXPECT_TRUE(one.next_with("$INGGA,").find(",1,,,-5.00,M,") != std::string::npos)
      << one.all() << service.err();
  EXPECT_FALSE(other.next_with("$PFTHM,").empty());
  EXPECT_TRUE(datagrams.next_with("$GPRMC,").find(",A,") != std::string::npos) << datagrams.all();
  EXPECT_TRUE(serial.next_with("$INHDT,").find("0.00,T") != std::string::npos) << serial.all();

  vehicle.rest_on(NavMode::dead_reckoning);
  EXPECT_FALSE(one.next([](const std::string& text) {
                    return text.starts_with("$INGGA") && text.find(",6,,,") != std::string::npos;
                  })
                   .empty());
  vehicle.be_quiet(true);
  EXPECT_FALSE(one.next([](const std::string& text) {
                    return text.starts_with("$INRMC") && text.find(",V,,,,,") != std::string::npos;
                  })
                   .empty())
      << "the loss itself has to be heard";
  vehicle.be_quiet(false);
  vehicle.rest_on(NavMode::gps_aided);
  EXPECT_FALSE(one.next([](const std::string& text) {
                    return text.starts_with("$INRMC") && text.find(",A,") != std::string::npos;
                  })
                   .empty());
  service.kill(SIGTERM);
  EXPECT_EQ(service.wait(), 0) << service.err();
  close(device);
}

// A client that never reads costs bounded memory and harms nobody; one that goes is forgotten.
TEST(NmeaOut, AStuckClientHarmsNobody) {
  const int tcp = free_port(SOCK_STREAM);
  Vehicle vehicle;
  std::string sentences;
  for (int i = 0; i < 40; ++i)
    sentences += std::string(i == 0 ? "" : ",") + R"({"sentence":"GGA","rate_hz":100})";
  Process service("fathom-nmea-out",
                  arguments(R"([{"type":"tcp_server","address":"127.0.0.1","port":)" + std::to_string(tcp) +
                            R"(,"sentences":[)" + sentences + "]}]"));
  std::atomic<std::uint64_t> dropped = 0;
  std::atomic<std::uint64_t> clients = 99;
  bus::Participant participant(presence(kDomain, "cli"));
  bus::Reader<ServiceStatus> statuses(participant, [&](const ServiceStatus& status, const bus::SampleInfo&) {
    if (status.header.sensor.view() != "nmea_out") return;
    for (const auto& counter : status.counters) {
      if (counter.name.view() == "bytes_dropped") dropped = counter.value;
      if (counter.name.view() == "clients") clients = counter.value;
    }
  });
  {
    const int stuck = Lines::connected(tcp);
    const int small = 4096;
    setsockopt(stuck, SOL_SOCKET, SO_RCVBUF, &small, sizeof small);
    Lines reading(Lines::connected(tcp));
    ASSERT_TRUE(wait_until(
        [&] {
          (void)reading.next_with("$INGGA,", 1.0);
          return dropped.load() > 0;
        },
        60.0))
        << service.err();
    EXPECT_EQ(clients.load(), 2U);
    // What the other one hears is as fresh as ever.
    std::string line;
    (void)wait_until(
        [&] {
          line = reading.next_with("$INGGA,", 1.0);
          const CivilTime now = to_civil(SystemClock().utc_ns());
          return line.substr(7, 6) == [&] {
            std::array<char, 8> text{};
            std::snprintf(text.data(), text.size(), "%02d%02d%02d", now.hour, now.minute, now.second);
            return std::string(text.data());
          }();
        },
        20.0);
    EXPECT_FALSE(line.empty());
    close(stuck);
  }
  EXPECT_TRUE(wait_until([&] { return clients.load() == 0; })) << "both have gone";
}

TEST(NmeaOut, APortThatCannotBeOpenedIsSaidAndTriedAgain) {
  TemporaryFolder folder;
  const std::string path = (folder.path() / "tty").string();
  const int tcp = free_port(SOCK_STREAM);
  Vehicle vehicle;
  Process service("fathom-nmea-out", arguments("[" + tcp_output(tcp) + R"(,{"type":"serial","path":")" +
                                               path + R"(","sentences":[{"sentence":"HDT"}]}])"));
  Lines client(Lines::connected(tcp));
  EXPECT_FALSE(client.next_with("$INGGA,").empty()) << "one bad output does not hold up another";
  ASSERT_TRUE(wait_until([&] { return service.err().find(path + ": ") != std::string::npos; }))
      << service.err();
  int line = -1;
  int device = -1;
  std::array<char, 64> name{};
  ASSERT_EQ(openpty(&line, &device, name.data(), nullptr, nullptr), 0);
  std::filesystem::create_symlink(name.data(), path);
  Lines serial(line);
  EXPECT_FALSE(serial.next_with("$INHDT,").empty()) << service.err();
  close(device);
}

TEST(NmeaOut, PassesTheCheckerOfOthers) {
  if (!is_installed("/usr/lib/python3/dist-packages/pynmea2")) GTEST_SKIP() << "pynmea2 is not installed";
  const int tcp = free_port(SOCK_STREAM);
  Vehicle vehicle;
  Process service("fathom-nmea-out", arguments("[" + tcp_output(tcp) + "]"));
  Lines client(Lines::connected(tcp));
  for (int i = 0; i < 3; ++i) (void)client.next_with("$PFTHM,");
  vehicle.be_quiet(true);
  for (int i = 0; i < 2; ++i) (void)client.next_with(",V,,,,,");
  TemporaryFolder folder;
  const std::string file = (folder.path() / "sentences").string();
  std::ofstream(file) << client.all();
  const std::string script =
      "import pynmea2,sys\n"
      "kinds=set()\n"
      "for line in open(sys.argv[1]):\n"
      "  s=pynmea2.parse(line.strip(),check=True)\n"
      "  kind=getattr(s,'sentence_type','')\n"
      "  kinds.add(kind)\n"
      "  if kind=='GGA' and s.gps_qual: assert s.latitude<0 and s.longitude>0, line\n"
      "print(' '.join(sorted(kinds)))\n";
  std::ofstream(folder.path() / "check.py") << script;
  const std::string command = "/usr/bin/python3 '" + (folder.path() / "check.py").string() + "' '" + file +
                              "' > '" + (folder.path() / "out").string() + "' 2>&1";
  const int code = std::system(command.c_str());  // NOLINT(concurrency-mt-unsafe): a test's own
  std::stringstream said;
  said << std::ifstream(folder.path() / "out").rdbuf();
  EXPECT_EQ(code, 0) << said.str();
  for (const char* kind : {"GGA", "RMC", "VTG", "GST", "HDT", "ZDA", "DPT", "VBW", "ROT"})
    EXPECT_NE(said.str().find(kind), std::string::npos) << kind << " is not among: " << said.str();
}

// gpsd reads us by TCP and tells its own clients our position, within what a sentence resolves.
TEST(NmeaOut, GpsdTellsOurPosition) {
  if (!is_installed("/usr/sbin/gpsd")) GTEST_SKIP() << "gpsd is not installed";
  const int tcp = free_port(SOCK_STREAM);
  const int gpsd_port = free_port(SOCK_STREAM);
  Vehicle vehicle;
  Process service("fathom-nmea-out", arguments("[" + tcp_output(tcp) + "]"));
  {
    Lines first(Lines::connected(tcp));
    EXPECT_FALSE(first.next_with("$INGGA,").empty()) << service.err();
  }
  Process gpsd("/usr/sbin/gpsd",
               {"-N", "-n", "-S", std::to_string(gpsd_port), "tcp://127.0.0.1:" + std::to_string(tcp)});
  const int descriptor = Lines::connected(gpsd_port);
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
        (report.at("lat").get<double>() * kDegree - Vehicle::latitude_rad(*time_ns)) * 6.36e6;
    const double east_m =
        (report.at("lon").get<double>() * kDegree - Vehicle::kLongitude_rad) * 6.38e6 * std::cos(0.5);
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
TEST(NmeaOut, GpsdFeedsTheBridge) {
  if (!is_installed("/usr/sbin/gpsd")) GTEST_SKIP() << "gpsd is not installed";
  const int tcp = free_port(SOCK_STREAM);
  const int gpsd_port = free_port(SOCK_STREAM);
  Vehicle vehicle;
  Process service("fathom-nmea-out", arguments("[" + tcp_output(tcp) + "]"));
  {
    Lines first(Lines::connected(tcp));
    EXPECT_FALSE(first.next_with("$INGGA,").empty()) << service.err();
  }
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
  Process gpsd("/usr/sbin/gpsd",
               {"-N", "-n", "-S", std::to_string(gpsd_port), "tcp://127.0.0.1:" + std::to_string(tcp)});
  Process bridge("fathom-gps-bridge",
                 {"--config", std::string(FATHOM_SOURCE_DIR) + "/deploy/config/gps_bridge.json", "--set",
                  "bus.domain=" + std::to_string(kDomain), "--set", "clock.anchor_file=", "--set",
                  R"(sensors=[{"name":"gps","protocol":"gpsd","rate_hz":5,"time":{"mode":"device_utc"},)"
                  R"("source":{"type":"tcp_client","address":"127.0.0.1","port":)" +
                      std::to_string(gpsd_port) + "}}]"});
  ASSERT_TRUE(wait_until([&] { return count() >= 20; }, 30.0)) << bridge.err() << gpsd.err();
  // gpsd is started again, as after an update: the bridge asks it anew.
  gpsd.kill(SIGKILL);
  (void)gpsd.wait();
  const std::size_t before = count();
  Process again("/usr/sbin/gpsd",
                {"-N", "-n", "-S", std::to_string(gpsd_port), "tcp://127.0.0.1:" + std::to_string(tcp)});
  EXPECT_TRUE(wait_until([&] { return count() >= before + 10; }, 30.0)) << bridge.err() << again.err();
  const std::lock_guard lock(mutex);
  for (const GpsSample& fix : fixes) {
    EXPECT_NEAR((fix.latitude_rad - Vehicle::latitude_rad(fix.header.stamp_ns)) * 6.36e6, 0.0, 0.016);
    EXPECT_NEAR((fix.longitude_rad - Vehicle::kLongitude_rad) * 6.38e6 * std::cos(0.5), 0.0, 0.016);
    EXPECT_NEAR(fix.velocity_N_m_s[0], 1.9, 0.01);
  }
}

}  // namespace
}  // namespace fathom::test
