// The service fathom-nmea-out over real DDS, sockets and a pseudo-terminal, read by us and by programs of
// others.

#include <array>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <pty.h>
#include <termios.h>

#include "bus/reader.hpp"
#include "integration/nmea_out/spoken.hpp"
#include "samples/status/health.hpp"
#include "support/free_port.hpp"
#include "support/temporary_folder.hpp"

namespace fathom::test {
namespace {

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

TEST(NmeaOut, AClientTooManyIsToldOf) {
  const int tcp = free_port(SOCK_STREAM);
  Vehicle vehicle;
  Process service("fathom-nmea-out",
                  arguments(R"([{"type":"tcp_server","address":"127.0.0.1","most_clients":1,"port":)" +
                            std::to_string(tcp) + R"(,"sentences":[{"sentence":"GGA","rate_hz":10}]}])"));
  Lines first(Lines::connected(tcp));
  ASSERT_FALSE(first.next_with("$INGGA,").empty()) << service.err();
  Lines second(Lines::connected(tcp));
  EXPECT_TRUE(wait_until([&] {
    return service.err().find("a client from 127.0.0.1 was refused: 1 are connected") != std::string::npos;
  })) << service.err();
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

}  // namespace
}  // namespace fathom::test
